"""Variables of a unit, in the order of their value references."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from modelgen.dataset import drives_of
from modelgen.numeric import Array
from modelgen.simulation.plant import Plant


@dataclass(frozen=True)
class Variable:
    """One real variable. causality: "input", "output", "parameter", "local" or "independent".

    start: None where computed. rate_of: number from 0 of the variable whose time derivative it is. jumps: a
    state that an event changes. indicates: its sign tells of an event.
    """

    name: str
    unit: str
    text: str
    causality: str
    variability: str
    start: float | None = None
    rate_of: int | None = None
    jumps: bool = False
    indicates: bool = False


def variables(
    plant: Plant, names: Sequence[str], units: Sequence[str], q: Array, step: float
) -> list[Variable]:
    """All of them. names, units: of the parameters; q: where the joints begin; step: the longest [s]."""
    arm = plant.arm
    joints = [arm.joints[i] for i in arm.coordinates]
    drives = drives_of(arm)
    own = arm.coordinate_units
    efforts = ["N" if joint.type == "prismatic" else "N m" for joint in joints]
    found = [
        Variable(
            f"{joint.name}.input",
            "A" if drive.driven else effort,
            "current of the drive" if drive.driven else "effort at the joint",
            "input",
            "continuous",
            0.0,
        )
        for joint, drive, effort in zip(joints, drives, efforts, strict=True)
    ]
    outputs = (
        ("q", "coordinate of the joint", "", own),
        ("dq", "its rate", "/s", own),
        ("motor", "coordinate of the motor", "", [drive.unit for drive in drives]),
        ("motor_rate", "its rate", "/s", [drive.unit for drive in drives]),
    )
    for name, text, per, kinds in outputs:
        found += [
            Variable(f"{joint.name}.{name}", f"{unit}{per}", text, "output", "continuous", jumps=name == "dq")
            for joint, unit in zip(joints, kinds, strict=True)
        ]
    found += [
        Variable(f"state.{name}", "", "state of an effect", "output", "continuous")
        for name in plant.model.states
    ]
    n = len(joints)
    states = [*range(n, 3 * n), *range(5 * n, len(found))]
    found += [_rate(found[k], k) for k in states]
    text = "above zero while a contact goes on to slide or to stick"
    found += [
        Variable(f"contact{c}", "", text, "local", "continuous", indicates=True)
        for c in range(1, len(plant.slip.contacts) + 1)
    ]
    for name, text, per, starts in (
        ("q_start", "coordinate at the beginning", "", q.tolist()),
        ("dq_start", "rate at the beginning", "/s", [0.0] * len(joints)),
    ):
        found += [
            Variable(f"{joint.name}.{name}", f"{unit}{per}", text, "parameter", "fixed", start)
            for joint, unit, start in zip(joints, own, starts, strict=True)
        ]
    found.append(Variable("step", "s", "longest step of the integrator", "parameter", "fixed", step))
    found += [
        Variable(f"parameter.{name}", unit, "parameter of the model", "parameter", "tunable", float(value))
        for name, unit, value in zip(names, units, plant.parameters, strict=True)
    ]
    return [*found, Variable("time", "s", "time", "independent", "continuous")]


def _rate(v: Variable, number: int) -> Variable:
    """The time derivative of a state."""
    unit = f"{v.unit.removesuffix('/s')}/s^2" if v.unit.endswith("/s") else f"{v.unit}/s" if v.unit else ""
    return Variable(f"der({v.name})", unit, "its rate", "local", "continuous", rate_of=number)
