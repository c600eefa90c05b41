"""Which nodes a set of outputs needs, kept up to date while outputs come and go."""

from __future__ import annotations

from collections.abc import Iterable

from modelgen.graph.graph import ADD, DIV, MUL, Expr, Graph

_ARITHMETIC = frozenset({ADD, MUL, DIV})


class Live:
    """The number of additions, multiplications and divisions behind the outputs added so far.

    Every node counts who needs it, so that adding or removing an output touches no more than what
    becomes needed or ceases to be.
    """

    def __init__(self, graph: Graph) -> None:
        self.graph = graph
        self.operations = 0
        self._users: dict[int, int] = {}

    def add(self, outputs: Iterable[Expr]) -> None:
        """Outputs that are needed from now on."""
        users, args, op = self._users, self.graph.args, self.graph.op
        stack = [e.key >> 1 for e in outputs]
        while stack:
            node = stack.pop()
            count = users.get(node, 0)
            users[node] = count + 1
            if count == 0:
                self.operations += op[node] in _ARITHMETIC
                for key in args[node]:
                    stack.append(key >> 1)

    def remove(self, outputs: Iterable[Expr]) -> None:
        """Outputs, added before, that are no longer needed."""
        users, args, op = self._users, self.graph.args, self.graph.op
        stack = [e.key >> 1 for e in outputs]
        while stack:
            node = stack.pop()
            users[node] -= 1
            if users[node] == 0:
                self.operations -= op[node] in _ARITHMETIC
                for key in args[node]:
                    stack.append(key >> 1)


def cost(graph: Graph, outputs: Iterable[Expr]) -> int:
    """Additions, multiplications and divisions that the outputs need together."""
    live = Live(graph)
    live.add(outputs)
    return live.operations
