"""An experiment for several causes that explain the records: a trajectory, or a test on the bench."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from modelgen.diagnosis.candidates import Place
from modelgen.diagnosis.evidence import System
from modelgen.diagnosis.experiment.bench_tests import Test, least, readings, tests
from modelgen.diagnosis.experiment.discrimination import Discriminator, Hypothesis, hypothesis
from modelgen.diagnosis.experiment.motions import Setup
from modelgen.diagnosis.experiment.trajectory import Progress, Proposal, propose
from modelgen.diagnosis.options.thresholds import Thresholds
from modelgen.diagnosis.selection import Cause
from modelgen.effects import CATALOGUE, Presence
from modelgen.jobs import HERE, Where
from modelgen.numeric import Array

if TYPE_CHECKING:
    from modelgen.diagnosis.extended import NamedCause

STEM = "next_experiment"


@dataclass(frozen=True)
class Experiment:
    """For one ambiguity set. separates: its members, the named cause first; proposal: the trajectory, for
    `members`; tests: on the bench, most evidence first; assumed: limits that come from the records.
    thresholds: by which it was chosen.
    """

    separates: tuple[tuple[str, int | None], ...]
    members: tuple[Hypothesis, ...]
    proposal: Proposal | None
    tests: tuple[Test, ...]
    assumed: tuple[str, ...]
    thresholds: Thresholds
    judge: Discriminator | None = None

    @property
    def evidence(self) -> float | None:
        """Expected delta BIC of the trajectory at least, over all pairs."""
        return None if self.proposal is None else least(self.proposal.evidence)

    @property
    def run(self) -> int:
        """Periods of the trajectory that its evidence is of."""
        return self.thresholds.experiment.periods

    @property
    def periods(self) -> int:
        """Number of the trajectory's periods that tell the causes apart: evidence grows with them."""
        evidence, run = self.evidence or 0.0, self.run
        asked = self.thresholds.selection.rival_margin_bic
        return run if not 0.0 < evidence < asked else math.ceil(run * asked / evidence)

    @property
    def best(self) -> str:
        """The test that promises most evidence, the trajectory where no test has more."""
        first = self.tests[0] if self.tests else None
        if self.proposal is None or (first and (first.evidence or 0.0) > (self.evidence or 0.0)):
            return first.text if first else ""
        return f"run {STEM}_set_points.csv {self.periods} times over and add its log to the training records"


def next_experiment(
    causes: Sequence[NamedCause],
    found: Sequence[Cause],
    stage: Setup | None,
    system: System,
    period: int | None,
    progress: Progress | None = None,
    where: Where = HERE,
) -> Experiment | None:
    """Plan for the first cause that others could stand for; None where no cause has rivals.

    stage: None for free motions, whose trajectory nothing can command. found: the causes as they were
    selected, in the order of `causes`.
    """
    limits = system.equations.thresholds
    for named, cause in zip(causes, found, strict=True):
        rivals = [(effect, joint) for effect, joint, _ in named.ambiguous_with]
        if not rivals and not named.aliases:
            continue
        separates = ((named.effect, named.joint), *rivals, *named.aliases)
        if stage is None:
            return Experiment(separates, (), None, _said(separates), (), limits)
        trials = [cause.trial] + [t for t, _ in cause.rivals if t.candidate.place in rivals]
        claims = [(*t.candidate.place, t.parameters) for t in trials]
        before = [hypothesis(c.trial, limits.experiment) for c in found if c is not cause]
        judge = Discriminator(system, stage.equations, stage.base, before)
        # what comes or fades shows between records, not within a motion
        suited = [t for t in trials if t.candidate.definition.presence is Presence.ALWAYS]
        suited = suited[: limits.experiment.max_members]
        members = tuple(hypothesis(t, limits.experiment) for t in suited) if len(suited) > 1 else ()
        proposal = propose(stage, judge, members, period, progress, where) if members else None
        bench = readings(stage, judge, claims)
        if members:
            bench += tests(stage, judge, members, proposal)
        if proposal is not None and (least(proposal.evidence) or 0.0) <= 0:
            proposal = None
        ranked = sorted(bench, key=lambda t: -(t.evidence or 0.0))
        every = *ranked, *_said(separates)
        return Experiment(separates, members, proposal, every, stage.assumed, limits, judge)
    return None


def _said(separates: Sequence[tuple[str, int | None]]) -> tuple[Test, ...]:
    """Tests that the catalogue names for each, once."""
    texts = dict.fromkeys(CATALOGUE[effect].experiment for effect, _ in separates)
    return tuple(Test(text, None) for text in texts)


def to_json(e: Experiment | None) -> dict[str, Any] | None:
    """`next_experiment` of diagnosis.json."""
    if e is None:
        return None
    return {
        "separates": [{"effect": effect, "joint": joint} for effect, joint in e.separates],
        "do": e.best,
        "trajectory": None if e.proposal is None else _trajectory(e, e.proposal),
        "tests": [{"test": t.text, "expected_delta_bic": _rounded(t.evidence)} for t in e.tests],
    }


def _trajectory(e: Experiment, p: Proposal) -> dict[str, Any]:
    s = p.excitation.problem.settings
    pairs = [
        {
            "true": _named(e.members[i]),
            "against": _named(e.members[j]),
            "expected_delta_bic": _rounded(p.evidence[i, j]),
        }
        for i in range(len(e.members))
        for j in range(len(e.members))
        if np.isfinite(p.evidence[i, j])
    ]
    return {
        "file": f"{STEM}.csv",
        "set_points": f"{STEM}_set_points.csv",
        "period_s": float(f"{s.period:.9g}"),
        "periods": e.run,
        "periods_to_tell_apart": e.periods,
        "expected_delta_bic": _rounded(e.evidence),
        "pairs": pairs,
        "limits_used": {name: round(x, 4) for name, x in p.excitation.usage.items()},
        "limits_from_records": list(e.assumed),
    }


def _named(h: Hypothesis) -> dict[str, Any]:
    return {"effect": h.candidate.effect, "joint": h.candidate.joint}


def _rounded(value: float | None) -> float | None:
    return None if value is None or not np.isfinite(value) else float(f"{value:.4g}")


def differences(e: Experiment, p: Proposal) -> list[tuple[Place, Place, int, Array, float]]:
    """By ordered pair: the true and the wrong one, joint from 0, what the wrong one would leave there (M,)
    over all periods, and the noise's standard deviation.
    """
    assert e.judge is not None
    result = []
    for i, true in enumerate(e.members):
        for j, other in enumerate(e.members):
            if i != j and np.isfinite(p.evidence[i, j]):
                left, sizes = e.judge.left_over(true, other, p.rows)
                k = int(np.argmax(np.nan_to_num(left**2).mean(axis=0) / sizes**2))
                pair = true.candidate.place, other.candidate.place
                result.append((*pair, k, left[:, k], float(sizes[k])))
    return result
