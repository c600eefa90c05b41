"""Names, units, meanings and bounds of the inputs of the emitted functions."""

from __future__ import annotations

from collections.abc import Sequence

from modelgen.description.objects import Arm
from modelgen.functions.objects import Argument
from modelgen.model.equations import Equations

LARGEST_GAIN = 1e5  # norm of the observer's gains [1/s]


def joint_units(arm: Arm, per: str = "") -> str:
    """rad and m joint by joint: "rad" where all are revolute."""
    units = arm.coordinate_units
    return _together([unit + per for unit in units])


def effort_units(arm: Arm) -> str:
    """N m and N joint by joint."""
    return _together(["N" if arm.joints[i].type == "prismatic" else "N m" for i in arm.coordinates])


def momentum_units(arm: Arm) -> str:
    """kg m^2/s and kg m/s joint by joint."""
    return _together(["kg m/s" if arm.joints[i].type == "prismatic" else "kg m^2/s" for i in arm.coordinates])


def input_units(equations: Equations) -> str:
    """A for a driven joint, N m or N for an undriven one."""
    units = []
    for drive, i in zip(equations.drives, equations.arm.coordinates, strict=True):
        effort = "N" if equations.arm.joints[i].type == "prismatic" else "N m"
        units.append("A" if drive.transmission.driven else effort)
    return _together(units)


def motor_units(equations: Equations, per: str = "") -> str:
    """Units of the motor coordinates."""
    units = []
    for drive, i in zip(equations.drives, equations.arm.coordinates, strict=True):
        joint = equations.arm.joints[i].unit
        units.append((drive.transmission.unit if drive.transmission.driven else joint) + per)
    return _together(units)


def per(over: str, under: str) -> str:
    """A unit over another one, in words: "m per rad"; several, or one with a stroke, in brackets."""

    def clear(unit: str) -> str:
        return f"({unit})" if "," in unit or "/" in unit else unit

    return f"{clear(over)} per {clear(under)}"


def _together(units: Sequence[str]) -> str:
    return units[0] if len(set(units)) == 1 else ", ".join(units)


def arguments(equations: Equations, parameters: Sequence[tuple[str, int, str]]) -> dict[str, Argument]:
    """Every input that a function may have, by name.

    parameters: (name of the vector, its size, its meaning). Bounds are far beyond any arm, and such
    that no product of bounded inputs overflows single precision.
    """
    arm, n = equations.arm, equations.n
    angle, speed, second = joint_units(arm), joint_units(arm, "/s"), joint_units(arm, "/s^2")
    listed = [
        Argument("q", n, angle, "joint coordinates", 1e4),
        Argument("dq", n, speed, "joint velocities", 1e5),
        Argument("ddq", n, second, "joint accelerations", 1e8),
        Argument("dq_r", n, speed, "reference velocities", 1e5),
        Argument("ddq_r", n, second, "reference accelerations", 1e8),
        Argument("input", n, input_units(equations), "inputs: motor currents, efforts where undriven", 1e9),
        Argument("q_m", n, motor_units(equations), "motor coordinates", 1e9),
        Argument("dq_m", n, motor_units(equations, "/s"), "motor velocities", 1e9),
        Argument("ddq_m", n, motor_units(equations, "/s^2"), "motor accelerations", 1e9),
        Argument("sin_q", n, "1", "sines of the joint angles", 10.0),
        Argument("cos_q", n, "1", "cosines of the joint angles", 10.0),
        Argument("dt", 1, "s", "time step", 1e4),
        Argument(
            "state", len(equations.state_names()), "see the list of states", "states of the effects", 1e9
        ),
        Argument("time", 1, "s", "time since the start of the motion", 1e6),
        Argument(
            "load", n, "force at the motor coordinate", "loads of the drives, from the function load", 1e9
        ),
        Argument("forgetting", 1, "1", "forgetting factor: 1 - time step / memory", 1.0),
        Argument("gain", n, "1/s", "gains of the observer, gain dt below 1", LARGEST_GAIN),
        Argument(
            "observer_state",
            n,
            momentum_units(arm),
            "state of the observer: the momentum that the model expects",
            1e9,
            length="N_OBSERVER_STATES",
        ),
        Argument("geometry", len(arm.symbols), "m, rad", "geometry, in the order of the list", 1e6),
    ]
    listed += [
        Argument(name, size, "see the list of parameters", text, 1e9) for name, size, text in parameters
    ]
    return {argument.name: argument for argument in listed}
