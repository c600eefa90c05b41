"""Models that leave out the drives, or parts of them, identify the same records, for comparison.

Leborne, Creuze, Chemori and Brignone (2018), Table IV, compare the error of the current with and without the
dynamics of the drives.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from modelgen.dataset import Chosen, Record, prepare
from modelgen.description import DEFAULT_EFFECTS, Arm, DirectDrive
from modelgen.description.objects import EffectUse, geometry_symbol
from modelgen.effects import CATALOGUE
from modelgen.errors import InputError
from modelgen.functions import Options
from modelgen.identification.identify import identify
from modelgen.identification.objects import Identification, Validation
from modelgen.transmission import of_joint

LINKS_ALONE = "links alone"
CONSTANT_RATIO = "levers as gears of constant ratio"


@dataclass(frozen=True)
class Alternative:
    """name: LINKS_ALONE (no effects: no friction, no drive inertia, the drives' ratios as they are) or
    CONSTANT_RATIO (levers replaced by gears that turn as far over the whole stroke, viscous and Coulomb
    friction at the joints: what is usual where motors turn joints). test: on the same records.
    """

    name: str
    test: Validation


def without_drives(
    train: Sequence[Record],
    test: Sequence[Record],
    arm: Arm,
    chosen: Chosen,
    found: Identification,
    payloads: Mapping[int, Sequence[float]] | None = None,
) -> tuple[Alternative, ...]:
    """Predictions of the test records by models without the drives' dynamics, by the method of `found`.

    payloads: as for `identify`.

    Raises InputError where they cannot be identified from these records.
    """
    method = "wls" if found.method == "iv" else found.method

    def identified(other: Arm, options: Options, side: bool) -> Validation:
        parts = [
            [prepare(r if side else replace(r, arm=other, motor_side=()), chosen) for r in part]
            for part in (train, test)
        ]
        validation = identify(parts[0], other, options, test=parts[1], method=method, payloads=payloads).test
        assert validation is not None
        return validation

    result = [Alternative(LINKS_ALONE, identified(arm, Options(without=frozenset({"effects"})), True))]
    if any(of_joint(arm, arm.joints[i]).varies for i in arm.coordinates):
        result.append(Alternative(CONSTANT_RATIO, identified(geared(arm), Options(), False)))
    return tuple(result)


def geared(arm: Arm) -> Arm:
    """The arm with gears in place of its levers, and friction of the joints in place of the drives' effects.

    A gear's ratio is that of the whole stroke: motor range over joint range. Raises InputError where a stroke
    has no length.
    """
    joints = list(arm.joints)
    for i in arm.coordinates:
        joint = arm.joints[i]
        transmission = of_joint(arm, joint)
        if not transmission.varies:
            continue
        span, stroke = transmission.joint_range(), transmission.motor_range()
        if span is None or stroke is None or not span[1] > span[0]:
            raise InputError(f"{arm.name}: the stroke of joint {joint.name} has no length")
        known = {geometry_symbol(name): value for name, value in arm.symbols.items()}
        middle = 0.5 * (span[0] + span[1])
        falling = float(transmission.k1().subs(transmission.q, middle).subs(known)) < 0
        ratio = (stroke[1] - stroke[0]) / (span[1] - span[0])
        friction = tuple(EffectUse(name) for name in DEFAULT_EFFECTS if not CATALOGUE[name].of_rotor)
        joints[i] = replace(
            joint,
            drive=DirectDrive(math.copysign(ratio, -1.0 if falling else 1.0), joint.drive.torque_constant),
            effects=friction,
        )
    return replace(arm, joints=tuple(joints))
