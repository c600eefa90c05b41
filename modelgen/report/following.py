"""What to do after a diagnosis: a sentence, a command, an experiment."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from modelgen.diagnosis.result import Diagnosis
from modelgen.effects import CATALOGUE
from modelgen.report.experiment import followed
from modelgen.report.words import at, listed, place_of

_BETTER_LOGS = (
    "Record a motion that moves every joint over its range, several periods in a row. This computes one; "
    "it needs a speed limit of each joint, in the description or by --velocity:"
)


@dataclass(frozen=True)
class Step:
    """What to do; command: in the folder of the report, empty where none does it."""

    text: str
    command: str = ""


def following(d: Diagnosis) -> list[Step]:
    """Steps, the first one first. Commands name files that lie beside the report."""
    name = d.arm.name
    description, values = f"{name}_extended.yaml", f"{name}_parameters.yaml"
    code = f"modelgen generate {description} --arm {name} --parameters {values}"
    excite = f"modelgen excite {description} --arm {name} --out trajectory.csv"
    steps = []
    if d.verdict == "named":
        steps.append(Step("Generate the code of the extended model, in the folder of this report:", code))
    elif d.verdict == "nothing_missing":
        steps.append(Step("Use the model as described, with its parameters from these records:", code))
    elif d.verdict == "cannot_tell":
        steps.append(Step(_BETTER_LOGS, excite))
    elif d.verdict == "outside_catalogue":
        steps.append(
            Step(
                "Look at the residuals below: over what they bend, and at which joint. Another motion helps:",
                excite,
            )
        )
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
        return at(d.arm, effect, joints[0])
    return f"{effect} at {listed(place_of(d.arm, joint) for joint in joints)}"
