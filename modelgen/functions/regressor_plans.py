"""The cheapest way to compute the regressor: each link's plan is tried, the best kept.

A function can be had in several equivalent forms, and which takes the fewest operations depends on the
arm. The forms share one graph, so that trying one costs no more than the nodes in which it differs.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from modelgen.graph import Expr
from modelgen.graph.live import Live, cost
from modelgen.model.equations import Equations
from modelgen.model.motion import Rates, base_motion, link_motions
from modelgen.model.regressor import Column, Plan, Regressor, Table


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


@dataclass(frozen=True)
class Choice:
    """A way to compute the regressor: 1/K at the screws or at the entries, and the links' plans."""

    at_screws: bool
    plans: Sequence[Plan]


class LinkColumns:
    """Columns of link parameters, rows in the unit of the input.

    1/K multiplies a row's screw or, where joints on parallel axes share theirs, what is left of it the
    finished entries; both ways are tried.
    """

    def __init__(self, equations: Equations, rates: Rates, needed: Sequence[int]) -> None:
        frames = equations.frames_factored
        self.equations = equations
        self.needed = needed
        self.pairs = [divmod(index, equations.per_link) for index in needed]
        self.motions, self.base = link_motions(frames, rates), base_motion(frames)

    def regressor(self, at_screws: bool) -> tuple[Regressor, list[Expr]]:
        """Rows scaled at the screws or not at all, and what the finished entries are to be scaled by."""
        e = self.equations
        scales, rest = _scaled_first(e) if at_screws else _scaled_last(e)
        return Regressor(e.frames_factored, self.motions, self.base, scales), rest

    def columns(self, choice: Choice) -> dict[int, Column]:
        """{standard index: {coordinate: expression}} computed as chosen."""
        regressor, rest = self.regressor(choice.at_screws)
        return self._columns(regressor.columns(choice.plans), rest)

    def _columns(self, table: Table, rest: Sequence[Expr]) -> dict[int, Column]:
        found = zip(self.needed, self.pairs, strict=True)
        return {k: {n: x * rest[n] for n, x in table[link][place].items()} for k, (link, place) in found}

    def cheapest(self) -> Choice:
        """The choice that takes the fewest operations of those tried."""
        driven = any(drive.inverse_gain.value != 1.0 for drive in self.equations.drives)
        trials = [self._searched(at_screws) for at_screws in ((False, True) if driven else (False,))]
        return min(trials, key=lambda trial: trial[0])[1]

    def _searched(self, at_screws: bool) -> tuple[int, Choice]:
        regressor, rest = self.regressor(at_screws)
        links = {link for link, _ in self.pairs}
        near = [Plan()] * len(self.motions)
        far = [Plan(*regressor.plans(i)[-1]) if i in links else Plan() for i in range(len(near))]
        searches = [PlanSearch(regressor, self.pairs, plans) for plans in (near, far)]
        best = min(searches, key=PlanSearch.run)
        columns = self._columns(best.table, rest)
        operations = cost(regressor.graph, (x for column in columns.values() for x in column.values()))
        return operations, Choice(at_screws, best.plans)


Scales = tuple[list[Expr], list[Expr]]  # of the screws, of the finished entries


def _scaled_first(e: Equations) -> Scales:
    """1/K at the screws; joints on parallel axes take the first one's."""
    first = list(range(e.n))
    number = {index: n for n, index in enumerate(e.arm.coordinates)}
    for n, index in enumerate(e.arm.coordinates):
        joint = e.arm.joints[index]
        before = joint.antecedent
        if before is None or before not in number:
            continue
        turning = joint.type == e.arm.joints[before].type == "revolute"
        if turning and joint.alpha == 0 and joint.gamma == 0:
            first[n] = first[number[before]]
    scales = [e.drives[k].inverse_gain for k in first]
    rest = [_ratio(e, n, k) for n, k in enumerate(first)]
    return scales, rest


def _ratio(e: Equations, n: int, k: int) -> Expr:
    """K_k / K_n."""
    if n == k:
        return e.graph.one
    drive = e.drives[k]
    return e.drives[n].inverse_gain * (drive.k1 * drive.transmission.torque_constant)


def _scaled_last(e: Equations) -> Scales:
    """1/K at the finished entries."""
    return [e.graph.one] * e.n, [drive.inverse_gain for drive in e.drives]
