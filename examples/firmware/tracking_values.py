"""The numbers of the example: parameters of controller and plant, gains, limits, reference."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, pi, sin

import numpy as np
from firmware.states import base_of
from numpy.typing import NDArray

from modelgen.backends import NumpyFunction
from modelgen.description import load
from modelgen.effects import known_effects
from modelgen.functions import Model, build_model, nominal_standard
from modelgen.resources import shipped_arms

Array = NDArray[np.float64]

ARM = "ariane4"
STEP = 1e-3  # s, of the controller
BANDWIDTH = 12.0  # rad/s of the feedback, critically damped
CURRENT_LIMIT = 1.9  # A
STROKE_RESERVE = np.radians(1.0)  # between the reference and a stroke's end
# What the plant has and the controller does not know: factors of the nominal values.
LINKS = (1.10, 0.92, 1.12, 1.10)
OF_EFFECTS = {"FV": 1.2, "FC": 1.15, "IA": 0.95}
# Reference of each joint: centre [deg], amplitude [deg], period [s]. The first asks for more than its stroke.
MOTION = ((-20.0, 55.0, 15.0), (50.0, 14.0, 11.0), (177.0, 40.0, 13.0))


@dataclass(frozen=True)
class Values:
    """Numbers of controller and plant, SI units, currents in A."""

    low: Array
    high: Array
    parameters: Array  # of the controller
    plant_parameters: Array
    current_per_acceleration: Array  # A s^2, for the feedback without a model, at the centre of the motion


def model() -> Model:
    """The model of the arm."""
    return build_model(load(shipped_arms(), known_effects())[ARM])


def values(made: Model) -> Values:
    """Everything that depends on the model."""
    functions = {f.name: NumpyFunction(f) for f in made.functions}
    (ranges,) = (f.ranges for f in made.functions if f.name == "gravity")
    nominal = np.array(list(nominal_standard(made).values()))
    parameters = base_of(made, nominal)
    centre = np.radians([c for c, _, _ in MOTION])
    inertia = np.diag(functions["mass_matrix"](centre, parameters))
    return Values(
        np.array([r.low for r in ranges]) + STROKE_RESERVE,
        np.array([r.high for r in ranges]) - STROKE_RESERVE,
        parameters,
        base_of(made, nominal * _factors(made)),
        inertia / functions["drive_gain"](centre),
    )


def reference(t: float) -> tuple[Array, Array, Array]:
    """Angle [rad], speed and acceleration asked for at the time t [s]; at rest at t = 0."""
    angle, speed, acceleration = [], [], []
    for centre, amplitude, period in MOTION:
        w, a = 2 * pi / period, np.radians(amplitude)
        angle.append(np.radians(centre) - a * cos(w * t))
        speed.append(a * w * sin(w * t))
        acceleration.append(a * w * w * cos(w * t))
    return np.array(angle), np.array(speed), np.array(acceleration)


def header(v: Values) -> str:
    """values.h of the controller."""
    rows = {
        "low": v.low,
        "high": v.high,
        "parameters": v.parameters,
        "current_per_acceleration": v.current_per_acceleration,
    }
    lines = ["/* Written by tracking_board.py. */"]
    for name, row in rows.items():
        listed = ", ".join(f"{x:.9e}f" for x in row)
        lines.append(f"static const float values_{name}[{len(row)}] = {{{listed}}};")
    scalars = {"kp": BANDWIDTH**2, "kd": 2 * BANDWIDTH, "current_limit": CURRENT_LIMIT}
    lines += [f"static const float values_{name} = {x:.9e}f;" for name, x in scalars.items()]
    return "\n".join(lines) + "\n"


def _factors(made: Model) -> Array:
    factors = []
    for p in made.standard:
        number = int("".join(c for c in p.name if c.isdigit()))
        factors.append(OF_EFFECTS.get(p.name[:2], LINKS[number - 1]))
    return np.array(factors)
