"""The law of an effect as a curve, asked of its class with the values that it is shown with."""

from __future__ import annotations

from functools import cache

import numpy as np
import sympy as sp

from modelgen.charts import Chart, Curve
from modelgen.dataset.drives import drives_of
from modelgen.description import Arm, DirectDrive, Inertial, Joint, LeveredDrive
from modelgen.effects import CATALOGUE, Definition, InputEffect
from modelgen.effects.base import Characteristic
from modelgen.effects.variables import InputVariables, state_symbols
from modelgen.evaluation import Evaluator, Motion, places
from modelgen.functions import EVALUATED, build_model
from modelgen.functions.nominal import nominal_base
from modelgen.numeric import Array

_LINK = Inertial(6.0, (0.25, 0.0, 0.0), (0.01, 0.0, 0.0, 0.12, 0.0, 0.12))
_LEVER = LeveredDrive(0.32, 0.07, (0.26, 0.38), (0.0, 24.0 * 6.2832), 1, -1.6, 0.05)
ARM = Arm(
    "sketched",
    (
        Joint("j1", "revolute", drive=DirectDrive(100.0, 0.1), effects=()),
        Joint("j2", "revolute", d=0.5, antecedent=0, drive=_LEVER, effects=()),
    ),
    (_LINK, _LINK),
    (0.0, -9.81, 0.0),
)
_SWING = (0.9, 0.35)  # rad, of either joint
_MIDDLE = (0.2, 0.0)  # rad
_STEP, _PERIOD, _PERIODS = 0.01, 10.0, 2  # s
_DRAWN = 500  # points of a curve
_ROOM = 0.05  # of the range of an ordinate, above and below
_INPUT, _WAVE, _SAMPLES = 10.0, 1.0, 2000  # amplitude [A], frequency [Hz] and samples in a period of an input
_SETTLED = 2  # periods of the input, of which the last is drawn


def sketch(effect: str) -> Chart:
    """The law over what shows it best: a force along a slow sinusoid of one joint, the others at rest; of a
    drive that bends its input, what it makes of a sinusoidal one.
    """
    definition = CATALOGUE[effect]
    if issubclass(definition, InputEffect):
        return _of_input(definition)
    own = definition().characteristic(_all_values(definition))
    if own is not None:
        return _of_variable(effect, own)
    joint, moved = _shown(definition)
    along = _motion(moved)
    evaluator, base = _bench()
    current = evaluator.contribution(effect, joint, along, definition.shown, base)[:, moved]
    drive = drives_of(ARM)[moved]
    at_motor = definition.side == "motor"
    force = current * (drive.torque_constant if at_motor else drive.gain(along.q[:, moved]))
    over, x = _abscissa(definition, along, moved)
    last = along.t >= (_PERIODS - 1) * _PERIOD
    shown = np.ones(len(x), dtype=bool) if definition.seen_over == "time" else last
    x, force = (v[shown][:: max(1, int(shown.sum()) // _DRAWN)] for v in (x, force))
    if definition.seen_over != "time":
        x, force = np.append(x, x[0]), np.append(force, force[0])
    where = "motor" if at_motor else "joint"
    low, high = min(0.0, float(force.min())), max(0.0, float(force.max()))
    room = _ROOM * (high - low)
    text = f"The law of {effect}: torque at the {where} over {over.partition(' [')[0]}."
    return Chart(
        "the law",
        over,
        f"torque at the {where} [N m]",
        [Curve(x, force, "law")],
        text,
        y_range=(low - room, high + room),
    )


def _shown(definition: type[Definition]) -> tuple[int | None, int]:
    """The first place at which it acts with these values on a joint that moves alone, its own first; and that
    joint, from 0.
    """
    pair = definition.coupled(definition.shown)
    there = [n for n in places(ARM, definition.name) if pair is None or n != pair[0]]
    evaluator, base = _bench()
    own = [(n, n - 1) for n in there if n is not None]
    others = [(n, m) for n in there for m in range(len(_SWING))]
    tried = [*own[:1], *others]
    for joint, moved in tried:
        added = evaluator.contribution(definition.name, joint, _motion(moved), definition.shown, base)
        if np.abs(added[:, moved]).max() > 0.0:
            return joint, moved
    return tried[0]


def _motion(moved: int) -> Motion:
    t = np.arange(0.0, _PERIOD * _PERIODS, _STEP)
    rate = 2 * np.pi / _PERIOD
    q, dq, ddq = np.tile(_MIDDLE, (len(t), 1)), np.zeros((len(t), 2)), np.zeros((len(t), 2))
    size = _SWING[moved]
    q[:, moved] += size * np.sin(rate * t)
    dq[:, moved] = size * rate * np.cos(rate * t)
    ddq[:, moved] = -size * rate**2 * np.sin(rate * t)
    return Motion(t, q, dq, ddq)


@cache
def _bench() -> tuple[Evaluator, Array]:
    """The arm, and its base parameters from its nominal links, without friction."""
    return Evaluator(ARM), np.array(list(nominal_base(build_model(ARM, EVALUATED)).values()))


def _abscissa(definition: type[Definition], along: Motion, moved: int) -> tuple[str, Array]:
    """Label and values of what shows it best; of a force of the motor its own coordinate, but for the
    position, in which the joint's is what laws name, unless it repeats with the motor's.
    """
    drive, q, dq, ddq = drives_of(ARM)[moved], *(v[:, moved] for v in (along.q, along.dq, along.ddq))
    if definition.seen_over == "time":
        return "time [s]", along.t
    if definition.seen_over == "load":
        return "size of the load, signed by the motion [N m]", np.abs(_weight(along, moved)) * np.sign(dq)
    if definition.seen_over == "position":
        if definition.periodic:
            return "position of the motor [rad]", np.asarray(drive.motor(q))
        return "position [rad]", q
    ratio = drive.gain(q) / drive.torque_constant if definition.side == "motor" else 1.0
    word = " of the motor" if definition.side == "motor" else ""
    if definition.seen_over == "acceleration":
        return f"acceleration{word} [rad/s^2]", np.asarray(ratio * ddq)
    return f"speed{word} [rad/s]", np.asarray(ratio * dq)


def _weight(along: Motion, moved: int) -> Array:
    """Torque at the motor that the links' weight takes (N,)."""
    evaluator, base = _bench()
    rest = np.zeros_like(along.q)
    current = evaluator.inputs(Motion(along.t, along.q, rest, rest), base)[:, moved]
    return np.asarray(current * drives_of(ARM)[moved].torque_constant)


def _of_variable(effect: str, own: Characteristic) -> Chart:
    x = np.linspace(-own.reach, own.reach, _DRAWN)
    force = sp.lambdify(own.variable, own.force, "numpy")(x)
    text = f"The law of {effect}: torque at the joint over the {own.name}."
    label = f"{own.name} [{own.unit.format(f='N m', x='rad', q='rad')}]"
    return Chart("the law", label, "torque at the joint [N m]", [Curve(x, force, "law")], text)


def _of_input(definition: type[InputEffect]) -> Chart:
    """What an ideal drive would need for the same effort, over the input."""
    effect, values = definition(), _all_values(definition)
    symbols = state_symbols("1", definition.name, definition.states)
    x = InputVariables(sp.Symbol("input", real=True), symbols)
    step = sp.Symbol("dt", positive=True)
    after = effect.step(x, values, step)
    arguments = [x.input, *symbols.values()]
    found = sp.lambdify(arguments, effect.effective(x, values), "numpy")
    stepped = sp.lambdify([*arguments, step], [after.get(name, symbols[name]) for name in symbols], "numpy")
    t = np.arange(_SETTLED * _SAMPLES) / (_SAMPLES * _WAVE)
    given = _INPUT * np.sin(2 * np.pi * _WAVE * t)
    states, made = [0.0] * len(symbols), np.zeros(len(t))
    for k, value in enumerate(given):
        made[k] = found(value, *states)
        states = list(stepped(value, *states, float(t[1])))
    last = slice((_SETTLED - 1) * _SAMPLES, None, _SAMPLES // _DRAWN)
    given, made = (np.append(v[last], v[last][0]) for v in (given, made))
    # what has no states makes the same of every frequency
    of, name = (f" of {_WAVE:g} Hz", f"at {_WAVE:g} Hz") if symbols else ("", definition.name)
    text = f"What {definition.name} and an ideal drive make of a sinusoidal input{of}."
    ends = np.array([-_INPUT, _INPUT])
    curves = [Curve(ends, ends, "before", "an ideal drive"), Curve(given, made, "law", name)]
    return Chart("the law", "input [A]", "effort as that of [A]", curves, text)


def _all_values(definition: type[Definition]) -> dict[str, float]:
    defaults = {p.name: p.default for p in definition.accepted() if p.default is not None}
    return {**defaults, **definition.shown}
