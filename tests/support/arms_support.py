"""The arms that ship and those of the benchmarks, their models, and inputs for their functions."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from math import pi
from pathlib import Path

import numpy as np
import pytest
import sympy as sp
from c_support import shared_library, write
from firmware.states import monitor_state
from peers.arms import described

from modelgen.description import LeveredDrive, Scalar, load
from modelgen.effects import known_effects
from modelgen.evaluation import with_effect
from modelgen.functions import Function, Model, Options, build_model
from modelgen.generation import GeneratedArm
from modelgen.generation.arm import print_model, shown_options
from modelgen.resources import shipped_arms
from modelgen.transmission import of_joint

ARMS = described()
SHIPPED = list(load(shipped_arms(), known_effects()))
# One worker deals with an arm, so that its model is built once.
EVERY_ARM = [pytest.param(name, marks=pytest.mark.xdist_group(name)) for name in ARMS]


KEPT = 20  # models whose factors are known
VARIANTS = {
    "default": Options(),
    "row_wise": Options(gains="row_wise"),
    "runtime_geometry": Options(runtime_geometry=True),
    "sincos": Options(sincos=True),
    "links": Options(without=frozenset({"drives", "effects"})),
    "effects": Options(),
}
# Of every kind that the catalogue has; (effect, coordinate or the arm, values).
EFFECTS: tuple[tuple[str, int | None, dict[str, float]], ...] = (
    ("load_dependent_friction", 1, {}),
    ("presliding", 1, {"distance": 1.0}),
    ("joint_flexibility", 1, {"stiffness": 50.0, "damping": 2.0}),
    ("stribeck_friction", 2, {"velocity": 0.5, "exponent": 0.7}),
    ("load_dependent_friction", 2, {"rise": 0.004}),
    # Float holds a motor's position of 1e5 increments to 6e-3 of one: few waves over the stroke, so that
    # 1e-4 can be asked of a ripple.
    ("torque_ripple", 2, {"harmonic": 2.0, "revolution": 20000.0}),
    ("transmission_coupling", 2, {"other": 1.0}),
    ("encoder_offset", 2, {"offset": 1e-4}),
    ("friction_warm_up", 3, {"time": 5.0, "speed": 1e4}),
    ("position_dependent_friction", 3, {}),
    ("nonlinear_viscous_friction", 3, {"exponent": 0.6}),
    ("backlash", 3, {"play": 0.0001, "stiffness": 50.0}),
    ("torque_constant_saturation", 3, {"coefficient": 1e-3}),
    ("fluid_drag", None, {}),
    ("added_mass", None, {}),
    ("payload_change", None, {"mass": 0.4, "z": 0.1}),
    ("base_tilt", None, {"x": 0.05}),
    ("time_delay", None, {"delay": 0.002}),
)


@cache
def model(name: str, variant: str = "default") -> Model:
    arm = ARMS[name]
    for effect, joint, values in EFFECTS if variant == "effects" else ():
        arm = with_effect(arm, effect, joint, values)
    return build_model(arm, VARIANTS[variant])


@cache
def generated(name: str, variant: str = "default") -> GeneratedArm:
    """What `generate_arm` gives with these options, printed from the model that other tests have."""
    assert variant != "effects", "not an arm of a description"
    return print_model(model(name, variant), ARMS[name], shown_options(VARIANTS[variant]))


def c_text(name: str) -> dict[str, str]:
    """Headers and sources of the arm generated without options, by path."""
    return {p: text for p, text in generated(name).files.items() if p.startswith(("include/", "src/"))}


_libraries: dict[tuple[str, str], Path] = {}


def library(name: str, real: str, folders: pytest.TempPathFactory) -> Path:
    """The arm generated without options as a library, compiled once for the tests of an arm."""
    if (name, real) not in _libraries:
        folder = folders.mktemp(f"{name}-{real}")
        write(c_text(name), folder)
        _libraries[name, real] = shared_library(folder, name, real)
    return _libraries[name, real]


def standard_vector(made: Model, rng: np.random.Generator) -> np.ndarray:
    """Standard parameters of bodies that could exist, with positive frictions and drive inertias."""
    values: dict[str, float] = {}
    for i, joint in enumerate(made.arm.joints):
        mass, com = rng.uniform(1, 5), rng.uniform(-0.2, 0.2, 3)
        spread = rng.uniform(-0.3, 0.3, (8, 3))
        cloud = mass * (np.cov(spread.T) + np.outer(com, com))
        tensor = np.trace(cloud) * np.eye(3) - cloud
        symbols = ("XX", "XY", "XZ", "YY", "YZ", "ZZ")
        values |= {f"{s}{i + 1}": v for s, v in zip(symbols, tensor[np.triu_indices(3)], strict=True)}
        values |= {f"M{a}{i + 1}": mass * c for a, c in zip("XYZ", com, strict=True)}
        values[f"M{i + 1}"] = mass
        # A motor coordinate in increments or in radians before the gear.
        scale = 1e-8 if isinstance(joint.drive, LeveredDrive) else 1e-4
        values[f"IA{i + 1}"] = rng.uniform(1, 2) * scale
    return np.array([values.get(p.name, rng.uniform(0.01, 0.02)) for p in made.standard])


def number(factor: Scalar, values: Mapping[str, float]) -> float:
    """The value of a number or of an expression in named symbols."""
    if isinstance(factor, sp.Expr):
        factor = factor.subs({symbol: values[symbol.name] for symbol in factor.free_symbols})
    return float(factor)


_factors: dict[int, tuple[Model, list[list[tuple[int, float]]]]] = {}


def _terms(made: Model) -> list[list[tuple[int, float]]]:
    """Of every base parameter the standard ones and their factors, as numbers."""
    if id(made) not in _factors:  # a model that is kept has its place to itself
        if len(_factors) > KEPT:
            _factors.clear()
        symbols = made.arm.symbols
        _factors[id(made)] = (
            made,
            [[(i, number(f, symbols)) for i, f in parameter.terms] for parameter in made.grouping.base],
        )
    return _factors[id(made)][1]


def base_vector(made: Model, standard: np.ndarray) -> np.ndarray:
    """Base parameters by the factors of their grouping."""
    return np.array([sum(standard[i] * factor for i, factor in terms) for terms in _terms(made)])


def inputs(made: Model, function: Function, rng: np.random.Generator) -> list[np.ndarray]:
    """One sample of every input, inside its range."""
    standard = standard_vector(made, rng)
    result = []
    q = rng.uniform(-pi, pi, len(made.arm.coordinates))
    for n, i in enumerate(made.arm.coordinates):
        stroke = of_joint(made.arm, made.arm.joints[i]).joint_range()
        if stroke:
            q[n] = stroke[0] + (stroke[1] - stroke[0]) * rng.uniform(0.02, 0.98)
    for a in function.arguments:
        value = rng.uniform(-1, 1, a.size)
        if a.name == "q":
            value = q
        elif a.name == "sin_q":
            value = np.sin(q)
        elif a.name == "cos_q":
            value = np.cos(q)
        elif a.name == "gain":
            value = rng.uniform(5, 50, a.size)
        elif a.name == "forgetting":
            value = np.array([0.99])
        elif a.length == "N_MONITOR_STATES":
            value = monitor_state(a.size, rng)
        elif a.name.endswith("state"):  # a lag of a millimetre, not of metres
            value = 0.0005 * value
        elif a.name == "dt":
            value = np.array([0.001])
        elif a.name == "geometry":
            value = np.array([made.arm.symbols[name] for name in made.geometry])
        elif a.name == "parameters":
            value = standard if function.name.endswith("_standard") else base_vector(made, standard)
        elif a.name == "q_m":
            for r in function.ranges:
                value[r.index] = r.low + (r.high - r.low) * rng.uniform(0.02, 0.98)
        result.append(value)
    return result
