"""The catalogue of effects as a page, each with a picture of what it adds to the input."""

from __future__ import annotations

import numpy as np

from modelgen.description import Arm, DirectDrive, Inertial, Joint, LeveredDrive
from modelgen.effects import CATALOGUE, Definition, Parameter
from modelgen.evaluation import Evaluator, Motion, places
from modelgen.figures import COLOURS, figure, svg
from modelgen.functions import EVALUATED, build_model
from modelgen.functions.nominal import nominal_base

_LINK = Inertial(6.0, (0.25, 0.0, 0.0), (0.01, 0.0, 0.0, 0.12, 0.0, 0.12))
_LEVER = LeveredDrive(0.32, 0.07, (0.26, 0.38), (0.0, 24.0 * 6.2832), 1, -1.6, 0.05)
ARM = Arm(
    "signatures",
    (
        Joint("j1", "revolute", drive=DirectDrive(100.0, 0.1), effects=()),
        Joint("j2", "revolute", d=0.5, antecedent=0, drive=_LEVER, effects=()),
    ),
    (_LINK, _LINK),
    (0.0, -9.81, 0.0),
)


def motion() -> Motion:
    """Two periods of ten seconds, two harmonics a joint."""
    t = np.arange(0.0, 20.0, 0.004)
    w = 2 * np.pi * 0.1 * t[:, None]
    first, second = np.array([0.9, 0.35]), np.array([0.25, 0.18])
    shift = np.array([0.0, 1.1])
    q = np.array([0.2, 0.0]) + first * np.sin(w + shift) + second * np.sin(3 * w)
    rate = 2 * np.pi * 0.1
    dq = rate * (first * np.cos(w + shift) + 3 * second * np.cos(3 * w))
    ddq = -(rate**2) * (first * np.sin(w + shift) + 9 * second * np.sin(3 * w))
    return Motion(t, q, dq, ddq)


def parameters(arm: Arm) -> np.ndarray:
    """Base parameters of the arm from its nominal links and no friction."""
    return np.array(list(nominal_base(build_model(arm, EVALUATED)).values()))


def picture(name: str, evaluator: Evaluator, along: Motion, base: np.ndarray) -> str:
    """SVG of what the effect adds to the inputs, over time and over what shows it best."""
    joint = places(ARM, name)[-1]
    added = evaluator.contribution(name, joint, along, CATALOGUE[name].shown, base)
    rows = range(evaluator.n) if joint is None else [joint - 1]
    made, axes = figure(1, 2, (7.2, 2.2))
    over = CATALOGUE[name].seen_over
    for n in rows:
        x = {"velocity": along.dq[:, n], "position": along.q[:, n], "acceleration": along.ddq[:, n]}
        colour, label = COLOURS[n], f"joint {n + 1}"
        shown = slice(len(along.t) // 2, -50) if over != "time" else slice(None)
        axes[0, 0].plot(along.t[shown], added[shown, n], color=colour, label=label)
        if over == "time":
            axes[0, 1].plot(along.dq[:, n], added[:, n], color=colour, linewidth=0.6)
        else:
            axes[0, 1].plot(x[over][shown], added[shown, n], color=colour)
    axes[0, 0].set_xlabel("time [s]")
    axes[0, 0].set_ylabel("added input [A]")
    units = {"velocity": "rad/s", "position": "rad", "acceleration": "rad/s^2"}
    shown_over = "velocity" if over == "time" else over
    axes[0, 1].set_xlabel(f"joint {shown_over} [{units[shown_over]}]")
    if len(list(rows)) > 1:
        axes[0, 0].legend(loc="upper right")
    return svg(made)


def pages() -> dict[str, str]:
    """effects.md and the pictures that it shows, by path."""
    evaluator, along, base = Evaluator(ARM), motion(), parameters(ARM)
    files = {f"effects/{name}.svg": picture(name, evaluator, along, base) for name in CATALOGUE}
    text = [_HEAD, *(_section(effect) for effect in CATALOGUE.values())]
    return {"effects.md": "\n".join(text), **files}


_HEAD = """# Effects

What `effects` in arms.yaml may name, and what `modelgen diagnose` looks for. x is the coordinate of the
motor or of the joint, as said with each; F the force or torque that does work on it. Linear parameters have
a column of the regressor each, the others are fixed by the description. The pictures show what the effect
adds to the inputs of a planar arm with a geared motor at joint 1 and a linear actuator on a lever at joint
2, moved by two harmonics.
"""


def _section(effect: type[Definition]) -> str:
    lines = [f"## {effect.name}", "", f"{_sentence(effect.text)}. {_law(effect)}", ""]
    lines += [f"![what {effect.name} adds to the input](effects/{effect.name}.svg)", ""]
    lines += ["| parameter | unit | | bounds | meaning |", "|---|---|---|---|---|"]
    linear = {p.name for p in effect.linear}
    lines += [_row(p, p.name in linear) for p in effect.accepted()]
    where = {"joint": "a joint", "arm": "the whole arm", "either": "a joint's link or the whole arm"}
    lines += ["", f"- Stands at {where[effect.scope]}; coordinate of the {effect.side}."]
    if effect.states:
        lines.append(
            f"- States: {', '.join(effect.states)}{'' if effect.held({}) else ', not with the defaults'}."
        )
    lines.append(f"- Confused with: {', '.join(effect.confused_with)}.")
    lines += [f"- Separated by: {effect.experiment}.", f"- {effect.reference}.", ""]
    return "\n".join(lines)


def _sentence(text: str) -> str:
    return text[0].upper() + text[1:]


def _law(effect: type[Definition]) -> str:
    """The first line of the docstring of the law, force, change or required input."""
    for name in ("law", "force", "changed", "effective"):
        method = effect.__dict__.get(name) or getattr(effect, name, None)
        text = getattr(method, "__doc__", None)
        if text:
            first = text.strip().splitlines()[0]
            return f"Law: {first}" if first.endswith(".") else f"Law: {first}."
    return ""


def _row(p: Parameter, linear: bool) -> str:
    low, high = p.bounds
    bounds = "any" if np.isinf([low, high]).all() else f"{low:g} to {high:g}"
    bounds = f"at least {low:g}" if np.isinf(high) and np.isfinite(low) else bounds
    kind = "linear" if linear else ("" if p.default is None else f"default {p.default:.6g}")
    return f"| `{p.name}` | {p.unit.format(f='F', x='x')} | {kind} | {bounds} | {p.text} |"
