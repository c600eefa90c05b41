"""The catalogue of effects as a page, each with a sketch of its law."""

from __future__ import annotations

import numpy as np

from modelgen.charts import sheet
from modelgen.effects import CATALOGUE, Definition, Parameter
from modelgen.report.law_sketch import sketch
from modelgen.report.words import law, sentence

SIZE = (350, 210)  # pixel


def pages() -> dict[str, str]:
    """effects.md and the pictures that it shows, by path."""
    sketches = {name: sketch(name) for name in CATALOGUE}
    files = {f"effects/{name}.svg": sheet([chart], 1, SIZE) for name, chart in sketches.items()}
    text = [_HEAD, *(_section(CATALOGUE[name], chart.text) for name, chart in sketches.items())]
    return {"effects.md": "\n".join(text), **files}


_HEAD = """# Effects

What `effects` in arms.yaml may name, and what `modelgen diagnose` looks for. x is the coordinate of the
motor or of the joint, as said with each; q that of the joint; F the force or torque that does work on x.
Linear parameters have a column of the regressor each, the others are fixed by the description. The
pictures are of an example: the torque while one joint of a planar arm swings slowly, a geared one where
the effect needs no lever; of what bends a drive's input, what comes of a sinusoidal one. [The
gallery](gallery.md) shows what each does to a log.
"""


def _section(effect: type[Definition], shown: str) -> str:
    stated = law(effect.name)
    lines = [f"## {effect.name}", "", f"{sentence(effect.text)}{f' Law: {stated}' if stated else ''}", ""]
    lines += [f"![{shown}](effects/{effect.name}.svg)", ""]
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
    lines += [f"- Separated by: {effect.experiment}.", f"- {effect.reference}."]
    lines += [f"- [What it does to a log](gallery.md#{effect.name}).", ""]
    return "\n".join(lines)


def _row(p: Parameter, linear: bool) -> str:
    low, high = p.bounds
    bounds = "any" if np.isinf([low, high]).all() else f"{low:g} to {high:g}"
    bounds = f"at least {low:g}" if np.isinf(high) and np.isfinite(low) else bounds
    kind = "linear" if linear else ("" if p.default is None else f"default {p.default:z.6g}")
    return f"| `{p.name}` | {p.unit.format(f='F', x='x', q='q')} | {kind} | {bounds} | {p.text} |"
