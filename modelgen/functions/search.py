"""The cheapest way to compute the regressor: each link's plan is tried, the best kept.

A function can be had in several equivalent forms, and which takes the fewest operations depends on the
arm. Making one takes milliseconds, so the forms are made and counted.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from modelgen.graph import Expr, Graph
from modelgen.graph.graph import ADD, DIV, MUL
from modelgen.graph.lowering import reachable
from modelgen.model.equations import Equations
from modelgen.model.motion import Rates, base_motion, link_motions
from modelgen.model.regressor import Plan, Regressor

Rows = list[dict[int, Expr]]  # [column] -> {coordinate: expression}


def cost(graph: Graph, expressions: Sequence[Expr]) -> int:
    """Additions, multiplications and divisions that the expressions need together."""
    arithmetic = (ADD, MUL, DIV)
    return sum(graph.op[node] in arithmetic for node in reachable(graph, [e.key for e in expressions]))


@dataclass
class PlanSearch:
    """Coordinate descent over the links' plans, from the last link to the first."""

    regressor: Regressor
    needed: Sequence[tuple[int, int]]  # (link, parameter)

    def outputs(self, plans: Sequence[Plan]) -> list[Expr]:
        """The needed columns' expressions under `plans`."""
        table = self.regressor.columns(plans)
        return [e for link, k in self.needed for e in table[link][k].values()]

    def evaluate(self, plans: Sequence[Plan]) -> int:
        """Operations under `plans`."""
        return cost(self.regressor.graph, self.outputs(plans))

    def run(self) -> list[Plan]:
        """The best plans found."""
        needed = set(self.needed)
        links = [i for i in reversed(self.regressor.frames.order) if any(link == i for link, _ in needed)]
        starts = [self._start(0, links), self._start(1, links)]
        results = [self._descend(plans, links, needed) for plans in starts]
        return min(results, key=lambda result: result[0])[1]

    def _start(self, deep: int, links: Sequence[int]) -> list[Plan]:
        """All links at their origins, or each as far back as its plans go."""
        plans = [Plan()] * len(self.regressor.frames.frames)
        for i in links if deep else ():
            slid, back = self.regressor.plans(i)[-1]
            plans[i] = Plan(slid, back)
        return plans

    def _descend(
        self, plans: list[Plan], links: Sequence[int], needed: set[tuple[int, int]]
    ) -> tuple[int, list[Plan]]:
        best = self.evaluate(plans)
        for i in links:
            trials = [replace(plans[i], slid=slid, back=back) for slid, back in self.regressor.plans(i)]
            for trial in trials:
                best, plans = self._better(best, plans, i, trial)
            for k in self.regressor.derivable(i):
                if (i, k) in needed:
                    best, plans = self._better(best, plans, i, replace(plans[i], derived=plans[i].derived ^ {k}))
        return best, plans

    def _better(self, best: int, plans: list[Plan], i: int, trial: Plan) -> tuple[int, list[Plan]]:
        if trial == plans[i]:
            return best, plans
        changed = [*plans[:i], trial, *plans[i + 1 :]]
        value = self.evaluate(changed)
        return (value, changed) if value < best else (best, plans)


def link_columns(equations: Equations, rates: Rates, needed: Sequence[int]) -> dict[int, dict[int, Expr]]:
    """Columns of the link parameters `needed` (standard indices), efforts by coordinate, cheaply."""
    frames = equations.frames_factored
    regressor = Regressor(frames, link_motions(frames, rates), base_motion(frames))
    k = equations.per_link
    pairs = [divmod(index, k) for index in needed]
    table = regressor.columns(PlanSearch(regressor, pairs).run())
    return {index: table[link][place] for index, (link, place) in zip(needed, pairs, strict=True)}
