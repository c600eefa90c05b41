"""The report of an identification: pictures, and one HTML file with them inside."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup
from numpy.typing import NDArray

from modelgen.figures import COLOURS, figure, svg
from modelgen.identification import Identification, Validation
from modelgen.identification.without_drives import Alternative
from modelgen.numeric import Array
from modelgen.report.arm_drawing import arm_drawing
from modelgen.report.page import inline
from modelgen.resources import templates_folder

AS_DESCRIBED = "the arm as described"


def predictions(found: Validation, others: Sequence[Alternative] = ()) -> str:
    """Measured and predicted effort of every joint over time, and what is left, as SVG.

    others: models beside it. Test records follow each other on the time axis.
    """
    n = found.measured.shape[1]
    t, breaks = _elapsed(found.t)
    made, axes = figure(n, 2, (10.0, 1.8 * n + 0.5))
    for j in range(n):
        left, right = axes[j]
        left.plot(t, _cut(found.measured[:, j], breaks), color="#999999", label="measured")
        for k, c in reversed(list(enumerate(others))):
            style = {"color": COLOURS[1 + k], "linewidth": 0.8, "label": c.name}
            left.plot(t, _cut(c.test.predicted[:, j], breaks), **style)
            right.plot(t, _cut(c.test.measured[:, j] - c.test.predicted[:, j], breaks), **style)
        style = {"color": COLOURS[0], "linewidth": 0.8, "label": AS_DESCRIBED if others else "predicted"}
        left.plot(t, _cut(found.predicted[:, j], breaks), **style)
        right.plot(t, _cut(found.measured[:, j] - found.predicted[:, j], breaks), **style)
        left.set_ylabel(f"joint {j + 1} [{found.unit[j]}]")
        right.set_ylabel("left over")
    handles, labels = axes[0, 0].get_legend_handles_labels()
    made.legend(handles, labels, loc="outside upper center", ncols=len(labels), fontsize=8)
    for axis in axes[-1]:
        axis.set_xlabel("time [s]")
    return svg(made)


def page(
    found: Identification,
    others: Sequence[Alternative],
    words: str,
    processing: Sequence[str],
    spectra: str,
) -> str:
    """HTML that needs nothing beside it. words: the verdict."""
    environment = Environment(
        loader=FileSystemLoader(templates_folder()),
        undefined=StrictUndefined,
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    test = found.test
    text: str = environment.get_template("report/identification.html.j2").render(
        arm=found.arm.name,
        arm_drawing=arm_drawing(found.arm),
        verdict=words,
        method=found.method,
        condition=f"{found.solution.condition:.4g}",
        models=models(test, others) if test is not None else [],
        compared=bool(others),
        joints=[f"joint {j} [{unit}]" for j, unit in enumerate(test.unit, 1)] if test is not None else [],
        gains=[(g.joint, f"{g.described:.6g}", f"{g.value:.6g}", f"{g.std:.2g}") for g in found.gains],
        parameters=[_parameter(e) for e in found.estimates],
        picture=inline(predictions(test, others)) if test is not None else Markup(""),
        spectra=inline(spectra),
        processing=processing,
    )
    return "\n".join(line.rstrip() for line in text.splitlines()) + "\n"


def table(test: Validation) -> list[tuple[str, str]]:
    """RMSE and NRMSE in %, joint by joint."""
    return [(f"{a:.4g}", f"{b:.1f}") for a, b in zip(test.rmse, test.nrmse_percent, strict=True)]


def models(test: Validation, others: Sequence[Alternative]) -> list[tuple[str, list[str]]]:
    """RMSE and NRMSE in % by model, and by how much the arm as described is below it in %, joint by joint."""
    rows = [(AS_DESCRIBED, [f"{a} ({b})" for a, b in table(test)])]
    for other in others:
        change = 100.0 * (test.rmse / np.maximum(other.test.rmse, 1e-300) - 1.0)
        cells = [f"{a} ({b}) {c:+.0f} %" for (a, b), c in zip(table(other.test), change, strict=True)]
        rows.append((other.name, cells))
    return rows


def _parameter(e: Any) -> tuple[str, ...]:
    std = "left out" if e.dropped else "not determined" if e.std is None else f"{e.std:.2g}"
    share = "" if e.relative is None else f"{e.relative:.1f}"
    return e.name, f"{e.value:.5g}", std, share, e.unit, "yes" if e.essential else "no"


def _elapsed(t: Array) -> tuple[Array, NDArray[np.intp]]:
    """Time axis (M + breaks,) on which records follow each other, and where each one ends."""
    step = float(np.median(np.diff(t)))
    breaks = np.flatnonzero(np.abs(np.diff(t) - step) > 0.5 * step) + 1
    if not len(breaks):
        return t, breaks
    parts = np.split(t, breaks)
    axis, end = [], 0.0
    for part in parts:
        axis.append(part - part[0] + end)
        end = float(axis[-1][-1]) + step
    return _cut(np.concatenate(axis), breaks), breaks


def _cut(values: Array, breaks: NDArray[np.intp]) -> Array:
    """Put nan where a record ends, so that no line joins it with the next."""
    return np.insert(values, breaks, np.nan)
