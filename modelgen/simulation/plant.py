"""An arm with values for its parameters, ready to move."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from modelgen.description.objects import Arm
from modelgen.errors import InputError
from modelgen.functions import Model, grouped, nominal_standard
from modelgen.functions.nominal import payload_standard
from modelgen.functions.parameters_file import base_vector
from modelgen.numeric import Array
from modelgen.simulation.friction_set import Slip, elastic, slip
from modelgen.transmission import STROKE_MARGIN, of_joint


@dataclass(frozen=True)
class Plant:
    """slip: the functions. parameters: what they take (p,). base: base parameters; in the model's order."""

    slip: Slip
    parameters: Array
    base: Array

    @property
    def model(self) -> Model:
        """The arm's functions, without smoothing of dry friction."""
        return self.slip.model

    @property
    def arm(self) -> Arm:
        """The arm as described."""
        return self.model.arm

    @property
    def n(self) -> int:
        """Number of coordinates."""
        return len(self.arm.coordinates)

    @property
    def names(self) -> list[str]:
        """Names of the joints that move."""
        return self.arm.coordinate_names

    @cached_property
    def strokes(self) -> tuple[Array, Array]:
        """Lowest and highest q (n,) at which the levers exist; infinite for other drives."""
        low, high = np.full(self.n, -np.inf), np.full(self.n, np.inf)
        for k, i in enumerate(self.arm.coordinates):
            span = of_joint(self.arm, self.arm.joints[i]).joint_range()
            if span is not None:
                low[k], high[k] = span[0] - STROKE_MARGIN, span[1] + STROKE_MARGIN
        return low, high

    @cached_property
    def limits(self) -> tuple[Array, Array]:
        """Lowest and highest q (n,) of the description's limits; infinite where it gives none."""
        low, high = np.full(self.n, -np.inf), np.full(self.n, np.inf)
        for k, i in enumerate(self.arm.coordinates):
            span = self.arm.joints[i].limits.position
            if span is not None:
                low[k], high[k] = span
        return low, high

    @cached_property
    def own(self) -> list[int]:
        """For every contact the coordinate whose speed it is, -1 where it is of several."""
        rows = self.slip.contacts
        return [int(np.flatnonzero(r)[0]) if np.count_nonzero(r) == 1 else -1 for r in rows]


def plant(
    arm: Arm,
    parameters: Mapping[str, float] | None = None,
    *,
    lock: Mapping[str, float] | None = None,
    payload: Sequence[float] = (),
) -> Plant:
    """The plant of `arm`.

    parameters: base parameters by name, as `modelgen identify` gives them; by default the description's
    nominal values. lock: joints held at a coordinate [rad, m] by name. payload: mass [kg] and, if wanted,
    place x, y, z [m] in the frame of the last link, of a point that the arm carries in addition. Raises
    InputError for unknown joints, missing nominal values, and parameters that are not the arm's.
    """
    for name in lock or {}:
        if name not in [j.name for j in arm.joints]:
            raise InputError(f"--lock {name}: found no such joint, expected one of {_names(arm)}")
    joints = tuple(replace(j, locked=dict(lock or {}).get(j.name, j.locked)) for j in arm.joints)
    changed = replace(arm, joints=joints)
    if parameters is None:
        made = slip(changed, standard=elastic(changed))
        standard = np.array(list(_nominal(made.model).values()))
        standard += payload_standard(made.model, payload)
        base = _grouped(made.model, standard)
        return Plant(made, standard if made.standard else base, base)
    if lock:
        raise InputError("--lock with --parameters: identify the arm with the joint locked instead")
    made = slip(changed)
    base = base_vector(made.model, parameters)
    base += _grouped(made.model, payload_standard(made.model, payload))
    return Plant(made, base, base)


def _nominal(model: Model) -> dict[str, float]:
    try:
        return nominal_standard(model)
    except InputError as error:
        raise InputError(
            f"{error.message}; expected it there, --parameters of modelgen identify, or --without effects",
            error.where,
        ) from None


def _grouped(model: Model, standard: Array) -> Array:
    return np.array(list(grouped(model, standard.tolist()).values()))


def _names(arm: Arm) -> str:
    return ", ".join(joint.name for joint in arm.joints)
