"""The arms that are measured: rigid links alone, with the same numbers for everyone."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from modelgen.description import load
from modelgen.description.objects import Arm, Inertial
from modelgen.effects import known_effects
from modelgen.functions import Model, Options, build_model, nominal_base
from modelgen.resources import shipped_arms
from peers.bodies import Body, bodies

Array = NDArray[np.float64]

OWN = Path(__file__).resolve().parents[1] / "arms.yaml"
# Bench arms with nominal bodies of their own; a link without inertials gets the same body everywhere.
BENCH = ("yaw3pitch", "ur10e_bench", "iiwa14_bench")
_BODY = Inertial(mass=2.0, com=(0.1, 0.05, -0.05), inertia=(0.1, 0.002, -0.001, 0.12, 0.003, 0.09))
LINKS_ALONE = Options(without=frozenset({"drives", "effects"}))


@dataclass(frozen=True)
class Subject:
    """An arm with inertials, its moving bodies, and states: samples x 3 n of q [rad or m], dq, then ddq or an
    effort."""

    arm: Arm
    bodies: Sequence[Body]
    states: Array

    @property
    def joints(self) -> int:
        """Number of coordinates."""
        return len(self.bodies)


def described() -> dict[str, Arm]:
    """The arms that ship, then those of benchmarks/arms.yaml, by name."""
    effects = known_effects()
    return {**load(shipped_arms(), effects), **load(OWN, effects)}


def names() -> list[str]:
    """The bench arms, then the others."""
    return [*BENCH, *(name for name in described() if name not in BENCH)]


def subject(name: str, samples: int = 200) -> Subject:
    """An arm by its name."""
    return subject_of(described()[name], samples)


def subject_of(arm: Arm, samples: int = 200) -> Subject:
    """An arm, in air, with random states."""
    arm = replace(arm, links=tuple(link or _BODY for link in arm.links), fluid_density=0.0)
    rng = np.random.default_rng(7)
    moving = bodies(arm)
    spread = np.repeat([np.pi, 2.0, 3.0], len(moving))
    return Subject(arm, moving, rng.uniform(-1.0, 1.0, (samples, len(spread))) * spread)


def links_alone(arm: Arm) -> Model:
    """The model without drives and effects, parameters at run time and folded in."""
    model = build_model(arm, LINKS_ALONE)
    return build_model(arm, replace(LINKS_ALONE, identified=nominal_base(model)))


def model_text(case: Subject) -> str:
    """The arm as pinocchio_model.hpp reads it."""
    lines = [_line([case.joints, *case.arm.gravity])]
    for body in case.bodies:
        parent = 0 if body.parent is None else body.parent + 1
        place = body.place[:3].ravel()
        lines.append(_line([parent, int(body.prismatic), *place, body.mass, *body.com, *body.inertia]))
    return "\n".join(lines) + "\n"


def _line(numbers: list[float]) -> str:
    return " ".join(f"{number:.17g}" for number in numbers)
