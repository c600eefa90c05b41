"""Effects that the arm may have besides: where, with which values to search for, and their columns."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import product

import numpy as np

from modelgen.dataset import drives_of, parse
from modelgen.diagnosis.equations.rows import COUPLING, Rows, turning
from modelgen.effects import CATALOGUE, Parameter
from modelgen.evaluation import Evaluator, places

Values = Mapping[str, float]
Place = tuple[str, int | None]  # effect and joint
# The step over which slopes are taken, by parameter.
STEPS: Mapping[str, Mapping[str, float]] = {
    "encoder_offset": {"offset": 1e-4},
    "base_tilt": {"x": 1e-4, "y": 1e-4, "z": 1e-4},
    "lever_geometry": {"l1": 1e-6, "l2": 1e-6, "length": 1e-6},
    "drive_gain_error": {"error": 1e-4},
    "torque_constant_saturation": {"coefficient": 1e-8},
    "time_delay": {"delay": 1e-4},
}
# Elastic joints and play move in proportion to nothing that they have: all of it is searched for,
# stiffness in its scale, relaxation (damping over stiffness) in s, play in the range of the motion.
SEARCHES: Mapping[str, Mapping[str, tuple[float, ...]]] = {
    "joint_flexibility": {
        "stiffness": (3.0, 8.0, 20.0, 50.0, 120.0, 300.0, 800.0, 3000.0),
        "relaxation": (0.02,),
    },
    "backlash": {
        "play": (3e-4, 8e-4, 2e-3, 4e-3, 1e-2, 3e-2),
        "stiffness": (200.0,),
        "relaxation": (0.02,),
    },
}
# Behind a link's own position: the drive rings within less; a gap's own width shows at its edges alone.
LINK_SEARCHES: Mapping[str, Mapping[str, tuple[float, ...]]] = {
    "joint_flexibility": {**SEARCHES["joint_flexibility"], "relaxation": (0.005,)},
    "backlash": {"play": (3e-4, 1e-3, 3e-3, 6e-3, 1.2e-2)},
}
# Of several parameters some are often as they were: asked for by fewer, at the price of fewer.
PARTS: Mapping[str, tuple[tuple[str, ...], ...]] = {
    "actuator_mass": (("inertia", "moment_x"), ("moment_x",)),
    "lever_geometry": (("l1",), ("l2",), ("length",)),
    "payload_change": (("mass", "moment_x"),),  # held along the last link
    "friction_warm_up": (("dry",), ("viscous",)),
}
# At one joint, and shown by others: what is wrong with it goes into the parameters that they share.
SPREADING = ("drive_gain_error", "encoder_offset", "lever_geometry")
COMPLIANT = ELASTIC, GAP = "joint_flexibility", "backlash"
PERIODIC = "torque_ripple"
# About what the drives are given, or what working warms: of no meaning in a free motion.
WARMING = "friction_warm_up"
DRIVEN = ("drive_gain_error", "torque_constant_saturation", "time_delay", WARMING, *COMPLIANT)
STRIBECK = (1.0, 2.0)  # exponents: Bo and Pavelescu 1982; Armstrong-Helouvry 1991
LATER = "payload_change"
POWER = "nonlinear_viscous_friction"
LOADED, RISE = "load_dependent_friction", 2e-3  # s: long before what a band of some ten Hz shows
CURVED = (*STEPS, LATER)  # columns are taken about values
BEGUN = 1.0  # s, begin of a part of a log that counts as its beginning
WEIGHING = "actuator_mass"  # shows by its weight alone where its inertia is lost in noise


@dataclass(frozen=True)
class Candidate:
    """An effect at a place. fixed: values that are not searched for; searched: nonlinear parameters that are;
    part: of the parameters that are estimated, those that are asked for, empty for all; forms: how many
    candidates there are for the effect at the place; places: how many places the effect is asked for at.

    joint counts coordinates from 1, None for the whole arm.
    """

    effect: str
    joint: int | None
    fixed: Values = field(default_factory=dict)
    searched: tuple[Parameter, ...] = ()
    part: tuple[str, ...] = ()
    forms: int = 1
    places: int = 1

    @property
    def place(self) -> Place:
        """Effect and joint."""
        return self.effect, self.joint

    @property
    def names(self) -> tuple[str, ...]:
        """Parameters that the columns belong to."""
        return self.part or self.every

    @property
    def every(self) -> tuple[str, ...]:
        """Parameters that are estimated where all are asked for."""
        if self.effect in STEPS:
            return tuple(STEPS[self.effect])
        if self.effect == LATER:
            return ("mass", "moment_x", "moment_y", "moment_z")
        if self.effect in COMPLIANT:
            return ("share",)
        return tuple(p.name for p in CATALOGUE[self.effect].linear)

    @property
    def positive(self) -> tuple[bool, ...]:
        """Of each column, whether its parameter may not be negative."""
        bounds = {p.name: p.bounds for p in CATALOGUE[self.effect].accepted()}
        return tuple(name in bounds and bounds[name][0] >= 0.0 for name in self.names)

    @property
    def passing(self) -> bool:
        """Whether what it does does not repeat with the periods."""
        return self.effect == WARMING

    def joints(self, n: int) -> list[int]:
        """Coordinates (from 0) that it is judged by."""
        if self.joint is None or self.effect in SPREADING:
            return list(range(n))
        others = [int(self.fixed["other"]) - 1] if "other" in self.fixed else []
        return [self.joint - 1, *others]


def candidates(evaluator: Evaluator, rows: Sequence[Rows]) -> list[Candidate]:
    """Everything of the catalogue that can stand somewhere on the arm and is not there yet."""
    found: list[Candidate] = []
    free = all(r.prepared.input is None for r in rows)
    for name, effect in CATALOGUE.items():
        if name == LATER and len(rows) < 2:
            continue
        if free and name in DRIVEN:
            continue
        if name == WARMING and not cold(rows):
            continue
        there = [
            joint
            for joint in places(evaluator.arm, name)
            if name not in COMPLIANT or at_motor(joint, rows) or at_links(joint, rows)
        ]
        for joint in there:
            for fixed, part in (forms := _forms(name, joint, rows, evaluator)):
                open_to = () if name in STEPS else (p for p in effect.nonlinear if p.grid)
                searched = tuple(p for p in open_to if p.name not in fixed)
                found.append(Candidate(name, joint, fixed, searched, part, len(forms), len(there)))
    return found


def _forms(
    name: str, joint: int | None, rows: Sequence[Rows], evaluator: Evaluator
) -> list[tuple[Values, tuple[str, ...]]]:
    """Fixed values and parts that the effect is tried with at a place."""
    parts = ((), *PARTS.get(name, ()))
    if name == WEIGHING and carried(joint, evaluator):
        parts = PARTS[name]  # where its base is says also where its weight points
    return list(product(_fixed(name, joint, rows, evaluator), parts))


def carried(joint: int | None, evaluator: Evaluator) -> bool:
    """Whether other joints move the link before this one."""
    if joint is None:
        return False
    arm = evaluator.arm
    before = arm.joints[arm.coordinates[joint - 1]].antecedent
    while before is not None and before not in arm.coordinates:
        before = arm.joints[before].antecedent
    return before is not None


def cold(rows: Sequence[Rows]) -> bool:
    """Whether all records begin where their logs do, and not with a part of one that was warmed before."""
    return all(parse(r.prepared.record.name).begin < BEGUN for r in rows)


def at_motor(joint: int | None, rows: Sequence[Rows]) -> bool:
    """Whether the joint's position was measured at its motor in all records."""
    return joint is not None and all(r.motion.motor_side[joint - 1] for r in rows)


def at_links(joint: int | None, rows: Sequence[Rows]) -> bool:
    """Whether the joint has a drive, and its position was measured at the link in all records."""
    if joint is None or any(r.motion.motor_side[joint - 1] for r in rows):
        return False
    arm = rows[0].prepared.record.arm
    return arm is None or drives_of(arm)[joint - 1].driven


def search_of(candidate: Candidate, rows: Sequence[Rows]) -> Mapping[str, tuple[float, ...]]:
    """Values over which an elastic joint or play is searched for."""
    behind = at_links(candidate.joint, rows)
    return (LINK_SEARCHES if behind else SEARCHES)[candidate.effect]


def gap_instead(candidate: Candidate, rows: Sequence[Rows], evaluator: Evaluator) -> Candidate | None:
    """Play for an elastic joint, behind a link's own position."""
    if candidate.effect != ELASTIC or not at_links(candidate.joint, rows):
        return None
    (fixed,) = _fixed("backlash", candidate.joint, rows, evaluator)
    return Candidate("backlash", candidate.joint, fixed, places=candidate.places)


def _fixed(
    name: str, joint: int | None, rows: Sequence[Rows], evaluator: Evaluator
) -> list[dict[str, float]]:
    if name == WEIGHING and not carried(joint, evaluator):
        return [{"base_angle": 0.0}]
    if name == "transmission_coupling":
        assert joint is not None
        return [{"other": float(k), "ratio": r} for k in range(1, joint) for r in (1.0, -1.0)]
    if name == "stribeck_friction":
        return [{"exponent": exponent} for exponent in STRIBECK]
    if name == LOADED:
        return [{}, {"rise": RISE}]
    if name == POWER:
        return [{"scale": grid_unit("speed", name, joint, rows, evaluator)}]
    if name == WARMING:
        return [{"speed": grid_unit("speed", name, joint, rows, evaluator)}]
    if name == "backlash" and at_links(joint, rows):
        (hardest,), (relaxation,) = (SEARCHES[name][p] for p in ("stiffness", "relaxation"))
        return [
            {
                "stiffness": hardest * grid_unit("stiffness", name, joint, rows, evaluator),
                "relaxation": relaxation,
            }
        ]
    if name == PERIODIC:
        assert joint is not None
        unit = drives_of(evaluator.arm)[joint - 1].unit
        return [{"revolution": 2 * np.pi if unit in ("rad", "unit rad") else 1.0}]
    return [{}]


def grid_unit(kind: str, name: str, joint: int | None, rows: Sequence[Rows], evaluator: Evaluator) -> float:
    """What a grid is in units of, over all records."""
    if kind == "1":
        return 1.0
    if kind == "time":
        return max(float(r.prepared.time[-1] - r.prepared.time[0]) for r in rows)
    assert joint is not None
    j = joint - 1
    side = CATALOGUE[name].side
    position = [(r.prepared.motor if side == "motor" else r.prepared.q)[:, j] for r in rows]
    speed = [(r.prepared.dmotor if side == "motor" else r.prepared.dq)[:, j] for r in rows]
    span = max(float(np.ptp(x)) for x in position)
    if kind == "span":
        return span
    if kind == "speed":
        return float(np.quantile(np.abs(np.concatenate(speed)), 0.95))
    drive = drives_of(evaluator.arm)[j]
    efforts = [
        np.abs(drive.gain(r.prepared.q[:, j]) * (0 if r.prepared.input is None else r.prepared.input[:, j]))
        for r in rows
    ]
    return float(np.quantile(np.concatenate(efforts), 0.95)) / max(span, 1e-12)


def without_rests(rows: Sequence[Rows], candidate: Candidate) -> Sequence[Rows]:
    """The rows at which a cause that was taken moves; all where it has no rest of its own."""
    if candidate.effect != COUPLING or candidate.joint is None:
        return rows
    where = [turning(r.prepared, candidate.joint, candidate.fixed) for r in rows]
    return [replace(r, moving=r.moving & flags) for r, flags in zip(rows, where, strict=True)]
