"""Which values a program computes negated, so that hardly any negation is left.

A product's sign follows from its factors', a sum's from its terms where these agree. A difference
may be had with either sign, and so may a product with a constant: these are the choices. What then
remains wrong at an output, or at an argument of a function that is neither odd nor even, costs one
negation.
"""

from __future__ import annotations

from collections.abc import Sequence

from modelgen.graph.graph import ADD, CALL, CONST, DIV, EVEN, INPUT, MUL, ODD, Graph

_SHARES = {ADD: 0.5, MUL: 0.25, DIV: 0.25}  # of a node's vote, for each of its operands
_ODD_OR_EVEN = ODD | EVEN
_SEARCH = 24  # choices tried for one negation
_EFFORT = 16  # changes of sign tried for each node, all choices together: arms of 20 joints take 11 at most


class _Polarity:
    def __init__(self, graph: Graph, nodes: Sequence[int], roots: Sequence[int]) -> None:
        self.graph = graph
        self.sign = dict.fromkeys(nodes, 0)
        self.left = _EFFORT * len(nodes)  # of the effort
        self.users: dict[int, list[int]] = {node: [] for node in nodes}
        self.demands: dict[int, list[int]] = {}  # node -> signs that outputs and functions want
        users, ops, args = self.users, graph.op, graph.args
        for node in nodes:
            if ops[node] == CALL and graph.name[node] not in _ODD_OR_EVEN:
                for key in args[node]:
                    self.demands.setdefault(key >> 1, []).append(key & 1)
            else:
                for key in args[node]:
                    users[key >> 1].append(node)
        for key in roots:
            if graph.op[key >> 1] != CONST:
                self.demands.setdefault(key >> 1, []).append(key & 1)
        votes = self.votes(nodes)
        for node in nodes:
            forced = self.forced(node)
            self.sign[node] = int(votes[node] > 0) if forced is None else forced

    def votes(self, nodes: Sequence[int]) -> dict[int, float]:
        """How much the users of each node would like its negative, from the outputs down."""
        graph = self.graph
        votes = dict.fromkeys(nodes, 0.0)
        for node in reversed(nodes):
            for want in self.demands.get(node, ()):
                votes[node] += 4.0 if want else -4.0
            weight = (votes[node] > 0) - (votes[node] < 0)
            op = graph.op[node]
            share = _SHARES.get(op, 0.0) * weight
            if not share:
                continue
            for key in graph.args[node]:
                votes[key >> 1] += -share if op == ADD and key & 1 else share
        return votes

    def forced(self, node: int) -> int | None:
        """The sign that follows from the operands, None where it is a choice."""
        graph, sign = self.graph, self.sign
        op = graph.op[node]
        if op in (CONST, INPUT):
            return 0
        args = graph.args[node]
        if op == CALL:
            return sign[args[0] >> 1] if graph.name[node] in ODD else 0
        x, y = args
        constant = graph.op[x >> 1] == CONST
        if op == ADD:
            second = (y & 1) ^ sign[y >> 1]
            return second if constant or second == (x & 1) ^ sign[x >> 1] else None
        return None if constant else sign[x >> 1] ^ sign[y >> 1]

    def cost(self, node: int) -> int:
        """Negations at the uses of `node` that demand a sign."""
        wants = self.demands.get(node)
        return len(wants) - wants.count(self.sign[node]) if wants else 0

    def flip(self, choice: int) -> tuple[int, list[int]]:
        """Take the choice the other way; returns the change in cost and the nodes changed.

        A node that several ways lead to may change several times, in a large tree without end in sight: where
        the effort is used up all is left as it was.
        """
        changed, gain = [choice], -self.cost(choice)
        self.sign[choice] ^= 1
        gain += self.cost(choice)
        queue = list(self.users[choice])
        while queue:
            node = queue.pop()
            sign = self.forced(node)
            if sign is None:  # now a choice: take the sign that its own uses want
                wants = self.demands.get(node, ())
                sign = wants[0] if wants and all(w == wants[0] for w in wants) else self.sign[node]
            if sign == self.sign[node]:
                continue
            gain -= self.cost(node)
            self.sign[node] = sign
            gain += self.cost(node)
            changed.append(node)
            if len(changed) > self.left:
                self.flip_back(changed)
                gain, changed = 0, []
                self.left = 0
                break
            queue.extend(self.users[node])
        self.left -= len(changed)
        return gain, changed

    def choices_below(self, node: int) -> list[int]:
        """The nearest choices that decide the sign of `node`."""
        found: list[int] = []
        seen = {node}
        queue = [node]
        for current in queue:
            if self.graph.op[current] in (CONST, INPUT):
                continue
            if self.forced(current) is None:
                found.append(current)
                if len(found) == _SEARCH:
                    break
                continue
            for key in self.graph.args[current]:
                if key >> 1 not in seen:
                    seen.add(key >> 1)
                    queue.append(key >> 1)
        return found

    def improve(self) -> None:
        """Flip choices as long as one saves negations and the effort lasts."""
        for _ in range(4):
            better = False
            for node in self.demands:
                if self.cost(node) == 0:
                    continue
                for choice in self.choices_below(node):
                    if self.left <= 0:
                        return
                    gain, changed = self.flip(choice)
                    if gain < 0:
                        better = True
                        break
                    self.flip_back(changed)
            if not better:
                return

    def flip_back(self, changed: Sequence[int]) -> None:
        """Undo a flip."""
        for node in changed:
            self.sign[node] ^= 1


def choose_polarity(graph: Graph, nodes: Sequence[int], roots: Sequence[int]) -> dict[int, int]:
    """For every node (operands before results), 1 where its negative is what gets computed."""
    polarity = _Polarity(graph, nodes, roots)
    polarity.improve()
    return polarity.sign
