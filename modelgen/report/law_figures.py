"""The law of a cause drawn over the data that it was found in."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from modelgen.charts import Chart, Curve
from modelgen.diagnosis.result import Diagnosis
from modelgen.effects import CATALOGUE
from modelgen.numeric import Array
from modelgen.report.diagnosis_figures import HELD, against, binned, bins_of, measured_efforts, units_of

_SAMPLES = 500  # of the residuals that are drawn
_GROUPS = 80  # of samples, through whose means a law is drawn
_NEAR = 0.9  # of the best abscissa's share that the usual one needs
_OVER = {"velocity": "speed", "position": "position", "acceleration": "acceleration"}


@dataclass(frozen=True)
class _Abscissa:
    """x: (M,) at the rows that move. side: (M,) ones, or the direction of the motion."""

    name: str
    unit: str
    x: Array
    side: Array


def judged_joint(d: Diagnosis, k: int) -> int:
    """Coordinate (from 0) at which cause k shows: its own, or the one that gains most."""
    joint = d.causes[k].joint
    return int(np.argmax(np.nan_to_num(d.errors.gain))) if joint is None else joint - 1


def law_size(d: Diagnosis, k: int) -> tuple[float, float, str] | None:
    """RMS of what cause k alone adds to the effort of its joint, that of the effort, and their unit."""
    if not d.laws[k].size:
        return None
    j = judged_joint(d, k)
    m = d.test.moving[:, j]
    if not m.any():
        return None
    size, whole = (float(np.sqrt(np.mean(x[m, j] ** 2))) for x in (d.laws[k], measured_efforts(d.test)))
    return size, whole, units_of(d)[j]


def law_charts(d: Diagnosis, k: int) -> list[Chart]:
    """Of cause k: its law with what the rest of the model leaves, and the residuals before and after.

    The first has as points the law and the residual together (a component-plus-residual plot, Ezekiel 1924;
    Cook and Weisberg 1982). The abscissa is the one over which the law is most nearly a curve; what turns its
    sign with the motion is drawn against the motion.
    """
    law = d.laws[k]
    j = judged_joint(d, k)
    m = d.test.moving[:, j]
    if not law.size or not m.any():
        return []
    best = _abscissa(d, k, j)
    name, unit = d.arm.coordinate_names[j], units_of(d)[j]
    against_motion = "" if (best.side > 0).all() else " against the motion"
    x_label, bins = f"{best.name} [{best.unit}]", bins_of(best.name)
    turned = best.side if np.mean(law[m, j] * best.side) >= 0.0 or not against_motion else -best.side
    old, new, own = (x[m, j] * turned for x in (*d.residuals, law))
    some = np.linspace(0, len(own) - 1, min(_SAMPLES, len(own))).astype(int)
    effect, over = d.causes[k].effect, best.name
    found = Chart(
        f"{name}: the law found",
        x_label,
        f"effort{against_motion} [{unit}]",
        [
            Curve(best.x[some], (own + new)[some], "measured", "effort without the rest of the model", True),
            Curve(*_curve(best.x, own), "law", "law of the cause"),
        ],
        f"The law of {effect} over {over}, with what the rest of the model leaves of the effort of {name}.",
    )
    left = Chart(
        f"{name}: residual without and with it",
        x_label,
        f"residual{against_motion} [{unit}]",
        [
            Curve(*binned(best.x, old, bins), "before", "mean residual without the cause", True),
            Curve(*binned(best.x, new, bins), "after", "mean residual with the cause", True),
        ],
        f"Mean residual of {name} over {over}, without and with {effect}.",
    )
    return [found, left]


def _abscissa(d: Diagnosis, k: int, j: int) -> _Abscissa:
    """Over what the law is most nearly a curve; what the catalogue says, where that is as good."""
    m = d.test.moving[:, j]
    y = d.laws[k][m, j]
    tried = list(_tried(d, j))
    shares = [_share(a, y * a.side) for a in tried]
    best = max(shares)
    usual = _OVER.get(CATALOGUE[d.causes[k].effect].seen_over, "")
    near = [a for a, s in zip(tried, shares, strict=True) if s >= _NEAR * best]
    first = [a for a in near if a.name == usual and (a.side > 0).all()]
    return first[0] if first else tried[int(np.argmax(shares))]


def _tried(d: Diagnosis, j: int) -> Iterator[_Abscissa]:
    p, m = d.test.prepared, d.test.moving[:, j]
    direction = np.sign(p.picked(p.dq)[m, j])
    for name, (x, units) in against(d).items():
        for side in (np.ones(len(direction)), direction):
            yield _Abscissa(name, units[j], x[m, j], side)
    time = p.t[m] - p.t[0]
    yield _Abscissa("time", "s", time, np.ones(len(time)))


def _curve(x: Array, y: Array) -> tuple[Array, Array]:
    """Means over groups of neighbours, equally many in each."""
    groups = np.array_split(np.argsort(x, kind="stable"), max(1, min(_GROUPS, len(x) // HELD)))
    return np.array([x[g].mean() for g in groups]), np.array([y[g].mean() for g in groups])


def _share(a: _Abscissa, y: Array) -> float:
    """Share of the mean square that the means over bins have."""
    x, means = _curve(a.x, y)
    total = float(np.mean(y**2))
    if not len(x) or total <= 0.0:
        return 0.0
    return 1.0 - float(np.mean((y - np.interp(a.x, x, means)) ** 2)) / total
