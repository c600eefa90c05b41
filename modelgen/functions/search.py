"""The cheapest way to compute the regressor: each link's plan is tried, the best kept.

A function can be had in several equivalent forms, and which takes the fewest operations depends on the
arm. The forms share one graph, so that trying one costs no more than the nodes in which it differs.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from modelgen.graph import Expr
from modelgen.graph.live import Live
from modelgen.model.equations import Equations
from modelgen.model.motion import Rates, base_motion, link_motions
from modelgen.model.regressor import Column, Plan, Regressor


class PlanSearch:
    """Descent over the links' plans, from the last link to the first."""

    def __init__(
        self, regressor: Regressor, needed: Sequence[tuple[int, int]], plans: Sequence[Plan]
    ) -> None:
        self.regressor = regressor
        self.plans = list(plans)
        self.needed: dict[int, list[int]] = {}  # link -> parameters
        for link, k in needed:
            self.needed.setdefault(link, []).append(k)
        self.table = regressor.columns(self.plans)
        self.live = Live(regressor.graph)
        for link in self.needed:
            self.live.add(self.roots(self.table, link))

    def roots(self, table: Sequence[Sequence[Column]], link: int) -> list[Expr]:
        """The needed columns of one link."""
        return [e for k in self.needed.get(link, ()) for e in table[link][k].values()]

    def run(self) -> int:
        """Improve the plans; returns the operations left."""
        for i in reversed(self.regressor.frames.order):
            if i not in self.needed:
                continue
            for slid, back in self.regressor.plans(i):
                self._try(i, replace(self.plans[i], slid=slid, back=back))
            for k in self.regressor.derivable(i):
                if k in self.needed[i]:
                    self._try(i, replace(self.plans[i], derived=self.plans[i].derived ^ {k}))
        return self.live.operations

    def _try(self, i: int, plan: Plan) -> None:
        """Take the plan for link i where it saves operations."""
        if plan == self.plans[i]:
            return
        before = self.live.operations
        plans = [*self.plans[:i], plan, *self.plans[i + 1 :]]
        table, changed = self.regressor.changed(self.table, plans, i)
        for link in changed:
            self.live.add(self.roots(table, link))
            self.live.remove(self.roots(self.table, link))
        if self.live.operations < before:
            self.plans, self.table = plans, table
            return
        for link in changed:
            self.live.add(self.roots(self.table, link))
            self.live.remove(self.roots(table, link))


def link_columns(equations: Equations, rates: Rates, needed: Sequence[int]) -> dict[int, Column]:
    """Columns of the link parameters `needed` (standard indices), efforts by coordinate, cheaply."""
    frames = equations.frames_factored
    regressor = Regressor(frames, link_motions(frames, rates), base_motion(frames))
    pairs = [divmod(index, equations.per_link) for index in needed]
    links = {link for link, _ in pairs}
    near = [Plan()] * len(frames.frames)
    far = [Plan(*regressor.plans(i)[-1]) if i in links else Plan() for i in range(len(near))]
    searches = [PlanSearch(regressor, pairs, plans) for plans in (near, far)]
    best = min(searches, key=PlanSearch.run)
    return {index: best.table[link][k] for index, (link, k) in zip(needed, pairs, strict=True)}
