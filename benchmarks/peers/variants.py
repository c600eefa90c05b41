"""Other ways to compute the same functions, each a change of the generator or of the compilation."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext
from dataclasses import dataclass
from typing import Any
from unittest import mock

from modelgen.functions import dynamics
from modelgen.functions.dynamics import Dynamics
from modelgen.functions.regressor_plans import Choice, LinkColumns, PlanSearch
from modelgen.graph import Expr, lowering
from modelgen.graph.graph import CONST, INPUT, Graph
from modelgen.graph.live import cost
from modelgen.model.composite import solve
from modelgen.model.regressor import Plan

Change = Callable[[], AbstractContextManager[Any]]


@dataclass(frozen=True)
class Variant:
    """`change` is in force while the arm is generated; `flags` are added when its C is compiled."""

    group: str
    text: str
    change: Change = nullcontext
    flags: Sequence[str] = ()
    kind: str = ""  # or "calls": forward dynamics by calls; "inlined": one translation unit; "library": libm


def _patched(target: object, name: str, value: object) -> Change:
    return lambda: mock.patch.object(target, name, value)


# -- forms of a function ----------------------------------------------------------------------------------


def _only(factored: bool) -> Change:
    def cheapest(self: Dynamics, form: Callable[[Any], list[Expr]]) -> list[Expr]:
        e = self.equations
        return form(e.frames_factored if factored else e.frames)

    return _patched(Dynamics, "cheapest", cheapest)


def _unsearched(self: LinkColumns) -> Choice:
    return Choice(False, [Plan()] * len(self.motions))


def _swept(self: PlanSearch) -> int:
    """Links in turn over every place with every set of derived columns, until nothing improves."""
    while True:
        before = self.live.operations
        for i in reversed(self.regressor.frames.order):
            if i not in self.needed:
                continue
            free = [k for k in self.regressor.derivable(i) if k in self.needed[i]]
            for slid, back in self.regressor.plans(i):
                for bits in range(2 ** len(free)):
                    derived = frozenset(k for b, k in enumerate(free) if bits >> b & 1)
                    self._try(i, Plan(slid, back, derived))
        if self.live.operations == before:
            return before


# -- solving M ddq = right --------------------------------------------------------------------------------


def _first_to_last(matrix: Sequence[Sequence[Expr]], right: Sequence[Expr]) -> tuple[list[Expr], list[Expr]]:
    """L D L' from the first row to the last."""
    n = len(matrix)
    flipped = [[matrix[n - 1 - i][n - 1 - j] for j in range(n)] for i in range(n)]
    x, pivots = solve(flipped, list(reversed(right)))
    return x[::-1], pivots[::-1]


def _divided(matrix: Sequence[Sequence[Expr]], right: Sequence[Expr]) -> tuple[list[Expr], list[Expr]]:
    """L' D L with a division for every entry."""
    n = len(matrix)
    lower = [[matrix[i][j] for j in range(i + 1)] for i in range(n)]
    x = list(right)
    for k in reversed(range(n)):
        for i in reversed(range(k)):
            a = lower[k][i] / lower[k][k]
            for j in range(i + 1):
                lower[i][j] = lower[i][j] - a * lower[k][j]
            x[i] = x[i] - a * x[k]
            lower[k][i] = a
        x[k] = x[k] / lower[k][k]
    for k in range(n):
        for i in range(k):
            x[k] = x[k] - lower[k][i] * x[i]
    return x, [lower[k][k] for k in range(n)]


# -- order of statements ----------------------------------------------------------------------------------


def _unordered(graph: Graph, nodes: Sequence[int]) -> dict[int, int]:
    """Operands as written, whatever the registers they take."""
    return dict.fromkeys(nodes, 1)


def _fewest_first(graph: Graph, nodes: Sequence[int]) -> dict[int, int]:
    return {node: -count for node, count in _REGISTERS(graph, nodes).items()}


_REGISTERS = lowering._registers


def _deep(graph: Graph, nodes: Sequence[int]) -> dict[int, int]:
    """The operand behind which more is computed last."""
    depth: dict[int, int] = {}
    for node in nodes:
        leaf = graph.op[node] in (CONST, INPUT)
        depth[node] = 0 if leaf else 1 + max(depth[key >> 1] for key in graph.args[node])
    return depth


@contextmanager
def _by_rows() -> Iterator[None]:
    """Outputs in the order of their elements."""
    real = lowering.lower

    def lower(outputs: Any, guards: Any = (), order: Any = None) -> Any:
        return real(outputs, guards, None)

    with mock.patch("modelgen.functions.assembly.lower", lower):
        yield


@contextmanager
def _backwards() -> Iterator[None]:
    """Outputs from the last to the first."""
    real = lowering.lower

    def lower(outputs: Any, guards: Any = (), order: Any = None) -> Any:
        places = order or [(name, i) for name, vector in outputs.items() for i in range(len(vector))]
        return real(outputs, guards, places[::-1])

    with mock.patch("modelgen.functions.assembly.lower", lower):
        yield


@contextmanager
def _pivots_late() -> Iterator[None]:
    """Pivots are computed and tested where the outputs come to need them."""

    class Late(lowering._Lowering):
        def __init__(self, graph: Graph, roots: Sequence[int], guards: Any) -> None:
            super().__init__(graph, roots, guards)
            self.waiting = len(guards)  # `lower` visits the guards first

        def visit(self, root: int) -> None:
            if self.waiting:
                self.waiting -= 1
            else:
                super().visit(root)

    with mock.patch.object(lowering, "_Lowering", Late):
        yield


# -- mass matrix ------------------------------------------------------------------------------------------


def _cheapest_matrix(self: Dynamics, dq: Sequence[Expr] | None = None) -> list[list[Expr]]:
    """Plain or factored frames for the composite bodies, whichever takes fewer operations."""
    e = self.equations
    kept, made = e.frames, []
    for frames in (e.frames, e.frames_factored):
        e.frames = frames
        made.append(_MASS(self, dq))
    e.frames = kept
    return min(made, key=lambda m: cost(e.graph, (x for row in m for x in row)))


_MASS = Dynamics.mass_matrix

SHIPPED = Variant("", "as shipped")
VARIANTS = (
    Variant("forms", "plain frames only, no common factors factored out", _only(False)),
    Variant("forms", "factored frames only (sums of parallel axes' angles by identity)", _only(True)),
    Variant(
        "forms",
        "mass matrix: cheaper of plain and factored frames",
        _patched(Dynamics, "mass_matrix", _cheapest_matrix),
    ),
    Variant(
        "forms",
        "regressor: no search, every link at its own frame",
        _patched(LinkColumns, "cheapest", _unsearched),
    ),
    Variant(
        "forms", "regressor: exhaustive sweeps over every link's plans", _patched(PlanSearch, "run", _swept)
    ),
    Variant("solution", "L D L' from the first joint", _patched(dynamics, "solve", _first_to_last)),
    Variant("solution", "a division for every entry, no reciprocals", _patched(dynamics, "solve", _divided)),
    Variant("order", "operands as written", _patched(lowering, "_registers", _unordered)),
    Variant(
        "order",
        "the operand that takes fewer registers first",
        _patched(lowering, "_registers", _fewest_first),
    ),
    Variant("order", "the deeper operand first", _patched(lowering, "_registers", _deep)),
    Variant("order", "outputs from the last to the first", _backwards),
    Variant("order", "outputs row by row", _by_rows),
    Variant("order", "pivots tested where the outputs need them", _pivots_late),
    Variant("order", "no statement longer than one operation", _patched(lowering, "INLINE_SIZE", 1)),
    Variant("sharing", "sine and cosine of the C library", kind="library"),
    Variant("sharing", "sine and cosine inlined", kind="inlined"),
    Variant("sharing", "forward dynamics calls mass_matrix and bias, solves in loops", kind="calls"),
    Variant("compiler", "-O2", flags=("-O2",)),
    Variant("compiler", "no fused multiply-add", flags=("-ffp-contract=off",)),
    Variant("compiler", "no vectorisation of neighbouring statements", flags=("-fno-tree-slp-vectorize",)),
    Variant("compiler", "-ffast-math", flags=("-ffast-math",)),
    Variant("compiler", "scheduled before registers are allocated", flags=("-fschedule-insns",)),
)
