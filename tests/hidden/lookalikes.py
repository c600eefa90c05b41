"""An effect of the catalogue in simulated records: the arm that has it, what a diagnosis that asks for it
finds, and how well the effects that resemble it do in its place.
"""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from hidden import arms
from hidden.cases import TRAIN, Case, Hidden, make
from hidden.effects import EFFECTS, joints_for
from hidden.native import PlantError
from hidden.tallies import measured
from modelgen.description import Arm, load
from modelgen.diagnosis.candidates import Search, candidates
from modelgen.diagnosis.decision import Decision
from modelgen.diagnosis.equations import study_of
from modelgen.diagnosis.evidence import System
from modelgen.diagnosis.experiment import setup
from modelgen.diagnosis.experiment.bench_tests import Test, readings, tests
from modelgen.diagnosis.experiment.discrimination import Discriminator, hypothesis
from modelgen.diagnosis.extended import Extension, extend
from modelgen.diagnosis.options import Options
from modelgen.diagnosis.options.thresholds import USUAL
from modelgen.diagnosis.pipeline import decided, records
from modelgen.diagnosis.result import Diagnosis, reported
from modelgen.effects import known_effects
from modelgen.errors import InputError

ARMS = ("direct2", "levered2")
SEED = 1
STRONG = 1.0  # magnitude: a strong effect, see hidden.effects.Put
SHOWN = 10.0  # percent less error at its joint, by which a picture shows it
STRENGTH = 1.3  # of a case of the blind run


@dataclass(frozen=True)
class Lookalike:
    """Another effect in the place of the one that is there.

    share: what it has of that one's evidence, as well as it can be fitted. test: what tells the two apart on
    the bench best, with the delta BIC to be expected; None where nothing simple does.
    """

    effect: str
    share: float
    test: Test | None


@dataclass(frozen=True)
class Found:
    """What was found in the records of a case of the plant. joint: from 1, where the effect is."""

    case: Case
    joint: int
    diagnosis: Diagnosis
    lookalikes: tuple[Lookalike, ...]


def found(effect: str) -> Found:
    """The first case whose records show the effect. Raises PlantError where none does."""
    refused = []
    for case, joint in cases(effect):
        with tempfile.TemporaryDirectory() as folder:
            try:
                make(case, Path(folder))
                return _diagnosed(effect, joint, case, Path(folder))
            except (PlantError, InputError) as error:
                refused.append(f"{case.arm}, joint {joint}, encoder {case.encoder}: {error}")
    raise PlantError("\n".join([f"{effect} shows in no case", *refused]))


def cases(effect: str) -> Iterator[tuple[Case, int]]:
    """Cases in which it is hidden, each with its joint from 1.

    First strong effects on small arms; then those of the last blind run in which it was found, the smallest
    arms first. With a strong spring in its drive no arm moves as it is asked to.
    """
    for name in () if EFFECTS[effect].fine else ARMS:
        for j in joints_for(effect, arms.draw(name, np.random.default_rng(0))):
            yield Case(name, SEED, (Hidden(effect, j + 1, STRENGTH, STRONG),)), j + 1
    alone = [line for line in measured() if line["effects"] == [effect] and line["group"] == "single"]
    shown = [line for line in alone if line["result"] == "found" and line["strength"] == STRENGTH]
    for line in sorted(shown, key=lambda line: (len(arms.DESIGNS[line["case"]["arm"]]), line["number"])):
        hidden = Hidden(**line["case"]["hidden"][0])
        yield Case(**{**line["case"], "hidden": (hidden,), "train": TRAIN}), hidden.joint


def _diagnosed(effect: str, joint: int, case: Case, folder: Path) -> Found:
    """Raises PlantError where the effect is not named, or is worth too little to be seen."""
    arm = load(folder / "arms.yaml", known_effects())[case.name]
    if EFFECTS[effect].described:
        arm = lacking(arm, effect, joint)
    train = [str(path) for path in sorted(folder.glob("train_?.csv"))]
    logs = records(arm, train, [str(folder / "test.csv")], None, USUAL.dataset)
    options = Options(effects=((effect, None),), experiment=False)
    study = study_of(arm, logs, options)
    decision = decided(study, options)
    extension = extend(arm, decision.selection, decision.band.equations)
    d = reported(study, decision, extension, options)
    gain = float(np.nanmax(d.errors.gain))
    if [(c.effect, c.joint in (joint, None)) for c in d.causes] != [(effect, True)] or gain < SHOWN:
        raise PlantError(f"{d.verdict}, {gain:.1f} % less error")
    return Found(case, joint, d, tuple(_lookalikes(decision, extension, d)))


def lacking(arm: Arm, effect: str, joint: int) -> Arm:
    """The arm whose description has not that effect at a joint, from 1."""
    place = arm.coordinates[joint - 1]
    kept = tuple(use for use in arm.joints[place].effects if use.name != effect)
    changed = replace(arm.joints[place], effects=kept)
    return replace(arm, joints=tuple(changed if k == place else j for k, j in enumerate(arm.joints)))


def _lookalikes(decision: Decision, extension: Extension, d: Diagnosis) -> Iterator[Lookalike]:
    """Those that the effect's class names, at the place of the cause; anywhere where that is the arm."""
    equations, own = decision.band.equations, decision.selection.causes[0].trial
    search, joint = Search(System(equations)), own.candidate.joint
    stage = setup(d.arm, extension.equations, extension.base)
    judge = Discriminator(decision.selection.system, stage.equations, stage.base)
    for name in own.candidate.definition.confused_with:
        there = [c for c in candidates(equations) if c.effect == name]
        near = [c for c in there if joint is None or c.joint in (joint, None)]
        trials = [t for t in (search.trial(c) for c in near) if t is not None]
        best = max(trials, key=lambda t: t.gain.delta_bic, default=None)
        if best is None or best.gain.delta_bic <= 0.0:
            continue
        pair = (own, best)
        members = [hypothesis(t, equations.thresholds.experiment) for t in pair]
        bench = [
            *readings(stage, judge, [(*t.candidate.place, t.parameters) for t in pair]),
            *tests(stage, judge, members, None),
        ]
        known = [t for t in bench if t.evidence is not None and t.evidence > 0.0]
        first = max(known, key=lambda t: t.evidence or 0.0, default=None)
        yield Lookalike(name, best.gain.delta_bic / own.gain.delta_bic, first)
