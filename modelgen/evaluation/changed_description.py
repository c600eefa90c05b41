"""Inputs of an arm whose description has other figures, all from one program."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import sympy as sp

from modelgen.backends.numpy import NumpyFunction
from modelgen.base_parameters import Grouping
from modelgen.base_parameters.rules import slid
from modelgen.description.objects import Arm, Joint, Scalar, geometry_symbol
from modelgen.effects import described
from modelgen.effects.placement import with_effect
from modelgen.evaluation.cache import Recent
from modelgen.evaluation.programs import inputs_of
from modelgen.model.equations import Equations
from modelgen.numeric import Array

REMEMBERED = 40  # changes


@dataclass(frozen=True)
class Changed:
    """An arm as its effects on the description make it. key: of what was changed, with its values; geometry:
    of `Variations`, None where that is not all that it takes.
    """

    key: object
    arm: Arm
    geometry: Array | None


class Variations:
    """One arm with the places of its joints, its levers and its gravity as run-time values.

    arm: as its effects on the description make it. base: the grouping whose parameters are given.
    """

    def __init__(self, arm: Arm, base: Grouping) -> None:
        varied, _ = _with_symbols(arm)
        self._alike = _form(varied)
        # inputs, of `geometry` besides what the arm's own take
        self.call = NumpyFunction(inputs_of(Equations(slid(varied), runtime=True, lazy=True), base))

    def values(self, other: Arm) -> Array | None:
        """`geometry` for another description of the arm; None where more than these values differs."""
        varied, values = _with_symbols(other)
        return np.array(values) if _form(varied) == self._alike else None


class Changes:
    """One arm with an effect besides, as it is described then; the last ones are remembered.

    varied: of that arm, None where its own effects have states.
    """

    def __init__(self, arm: Arm, varied: Variations | None) -> None:
        self._arm, self._varied = arm, varied
        self._recent: Recent[Changed] = Recent(REMEMBERED)

    def __call__(self, effect: str, joint: int | None, values: Mapping[str, float]) -> Changed:
        """The arm with the effect at coordinate `joint`. Raises InputError where it refuses values."""
        key = effect, joint, tuple(sorted(values.items()))
        return self._recent(key, lambda: self._made(key, effect, joint, values))

    def _made(self, key: object, effect: str, joint: int | None, values: Mapping[str, float]) -> Changed:
        arm = described(with_effect(self._arm, effect, joint, values))
        return Changed(key, arm, None if self._varied is None else self._varied.values(arm))


def _form(arm: Arm) -> Arm:
    return replace(arm, symbols={})


def _with_symbols(arm: Arm) -> tuple[Arm, list[float]]:
    """The arm with symbols for what effects on the description change, and the values of all its symbols."""
    symbols = dict(arm.symbols)
    known = {geometry_symbol(name): value for name, value in symbols.items()}

    def named(name: str, value: Scalar) -> sp.Symbol:
        while name in symbols:
            name += "_"
        symbols[name] = float(value.subs(known)) if isinstance(value, sp.Expr) else float(value)
        return geometry_symbol(name)

    def of_joint(number: int, joint: Joint) -> Joint:
        if not joint.moving:
            return joint
        place = "r" if joint.type == "prismatic" else "theta"
        changes: dict[str, Any] = {place: named(f"{place}_{number}", getattr(joint, place))}
        changes["drive"] = joint.drive.with_runtime(lambda name, x: named(f"{name}_{number}", x))
        return replace(joint, **changes)

    joints = tuple(of_joint(number, joint) for number, joint in enumerate(arm.joints, 1))
    # the frames take gravity as they take lengths
    gravity: Any = tuple(named(f"gravity_{a}", g) for a, g in zip("xyz", arm.gravity, strict=True))
    return replace(arm, joints=joints, gravity=gravity, symbols=symbols), list(symbols.values())
