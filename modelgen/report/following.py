"""What to do after a diagnosis: a sentence, a command, an experiment."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from modelgen.diagnosis.result import Diagnosis
from modelgen.effects import CATALOGUE
from modelgen.effects.placement import titled
from modelgen.report.call import WHERE, Call
from modelgen.report.experiment import followed
from modelgen.report.words import listed, place_of

_BETTER_LOGS = "Record a motion that moves every joint over its range, several periods in a row."


@dataclass(frozen=True)
class Step:
    """What to do; command: empty where none does it."""

    text: str
    command: str = ""


def following(d: Diagnosis, folder: Path) -> list[Step]:
    """Steps, the first one first. folder: of the report, as modelgen was given it."""
    name, call = d.arm.name, Call(d.arm, folder=folder)
    description = call.beside(f"{name}_extended.yaml")
    values = "--parameters", call.beside(f"{name}_parameters.yaml")
    code = call.command("generate", *values, description=description)
    steps = []
    if d.verdict == "named":
        steps.append(Step(f"Generate the code of the extended model, {WHERE}:", code))
    elif d.verdict == "nothing_missing":
        text = f"Use the model as described, with its parameters from these records; its code, {WHERE}:"
        steps.append(Step(text, code))
    elif d.verdict == "cannot_tell":
        steps.append(_other_motion(d, call, _BETTER_LOGS))
    elif d.verdict == "outside_catalogue":
        text = "Look at the residuals below: over what they bend, and at which joint. Another motion helps."
        steps.append(_other_motion(d, call, text))
    if d.next_experiment is not None:
        steps.append(Step(f"To separate the cause from its rivals: {followed(d.next_experiment)}."))
    else:
        places: dict[str, list[int | None]] = {}
        for c in (*d.causes, *d.suspects):
            places.setdefault(c.effect, []).append(c.joint)
        steps += [
            Step(f"To see {_wherever(d, effect, joints)} by itself: {CATALOGUE[effect].experiment}.")
            for effect, joints in places.items()
            if CATALOGUE[effect].experiment
        ]
    return steps


def _wherever(d: Diagnosis, effect: str, joints: Sequence[int | None]) -> str:
    """An effect at every place where it acts."""
    if len(joints) == 1:
        return titled(d.arm, effect, joints[0])
    return f"{effect} at {listed(place_of(d.arm, joint) for joint in joints)}"


def _other_motion(d: Diagnosis, call: Call, text: str) -> Step:
    """A motion to be recorded next, with the speeds of the test record where the arm has no limits."""
    p = d.test.prepared
    speeds = np.abs(p.picked(p.dq)).max(axis=0).tolist()
    description = call.beside(f"{d.arm.name}_extended.yaml")
    excite = call.exciting(call.beside("trajectory.csv"), speeds, description)
    return Step(f"{text} This computes one, {WHERE}:" if excite else text, excite)
