"""The law of a cause drawn over the data that it was found in."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from modelgen.backends.numpy import NumpyFunction
from modelgen.charts import Chart, Curve, number, over_time
from modelgen.dataset.drives import drives_of
from modelgen.diagnosis.equations.checks import columns_of_effects
from modelgen.diagnosis.result import Diagnosis
from modelgen.effects import CATALOGUE, Definition, InputEffect
from modelgen.functions import Model
from modelgen.numeric import Array
from modelgen.report.diagnosis_figures import BINS, HELD, against, binned, bins_of, measured_efforts, units_of

_SAMPLES = 500  # of the residuals that are drawn
_GROUPS = 80  # of samples, through whose means a law is drawn
_WAVES = 3  # groups for a bin
_FINE = 12  # groups for a wave of a law that repeats: their means keep 99 % of its amplitude
_DOTS = 6  # bins for a wave
_SEEN = 40  # waves that are told from each other in a chart
_NEAR = 0.9  # of the best abscissa's share that the usual one needs
_CURVED = 0.7  # share of a law that the means over its abscissa have; with less it is no curve over that
_STRETCH = 150  # samples of a stretch of the record: as many as are told from each other in a chart
_WEIGHT, _CARRIED = "load by the weight of the links", "load by all that moves the links"
# By what the catalogue says that shows a law best.
_OVER = {
    "velocity": ("speed",),
    "position": ("position",),
    "acceleration": ("acceleration",),
    "load": (_WEIGHT, _CARRIED),
    "time": ("time",),
}
_FLAT = 0.02  # of its mean, by which the line of a law varies that is called flat
_FEW = 0.005  # of the samples, that lie far out at either end: impacts
_FAR = 2.0  # times the span of the others, by which they are left out


@dataclass(frozen=True)
class _Abscissa:
    """x: (M,) at the rows that move. side: (M,) ones, or the sign of an effort that drives the motion."""

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
    sign with the motion is drawn against the motion. A law that remembers, or joins the motions of several
    joints, is a curve over none: it is drawn over the stretch of time in which most is explained.
    """
    law = d.laws[k]
    j = judged_joint(d, k)
    m = d.test.moving[:, j]
    if not law.size or not m.any():
        return []
    best, share = _abscissa(d, k, j)
    joins = any(p.joint for p in CATALOGUE[d.causes[k].effect].accepted())
    if joins or (share < _CURVED and best.name not in ("time", "motor position")):
        return _over_a_stretch(d, k, j)
    name, unit = d.arm.coordinate_names[j], units_of(d)[j]
    against_motion = "" if (best.side > 0).all() else " against the motion"
    x_label = f"{best.name} [{best.unit}]"
    effect, over = d.causes[k].effect, best.name
    wave = _wave(d, k)
    kept = _inner(best.x)
    waves = float(np.ptp(best.x[kept])) / wave
    shown = ""
    if waves > _SEEN:
        kept = np.logical_and(kept, _amid(best.x, _SEEN * wave))
        shown, waves = f", {_SEEN} of its {waves:z.0f} waves", _SEEN
    x = best.x[kept]
    old, new, own = ((r[m, j] * best.side)[kept] for r in (*d.residuals, law))
    some = np.linspace(0, len(own) - 1, min(_SAMPLES, len(own))).astype(int)
    bins = max(_bins(effect, over), int(_DOTS * waves))
    groups = max(_groups(effect, over), int(_FINE * waves))
    # the law has no noise: where there are too few samples for means, each is drawn
    drawn = _curve(x, own, groups) if groups <= len(x) // HELD else _curve(x, own, len(x), 1)
    found = Chart(
        f"{name}: the law found{shown}",
        x_label,
        f"effort{against_motion} [{unit}]",
        [
            Curve(x[some], (own + new)[some], "measured", "effort without the rest of the model", True),
            # fewer samples than make a wave a curve are points
            Curve(*drawn, "law", "law of the cause", len(x) < _FINE * waves),
        ],
        f"The law of {effect} over {over}, with what the rest of the model leaves of the effort of {name}.",
    )
    it, what = _added(d)
    left = Chart(
        f"{name}: residual without and with {it}",
        x_label,
        f"residual{against_motion} [{unit}]",
        [
            Curve(*binned(x, old, bins), "before", f"mean residual without {what}", True),
            Curve(*binned(x, new, bins), "after", f"mean residual with {what}", True),
        ],
        f"Mean residual of {name} over {over}, without and with {_named(d, k)}.",
    )
    return [found, left]


def seen(charts: Sequence[Chart]) -> str:
    """What the charts of a law show, in a sentence; empty where there are none."""
    if not charts:
        return ""
    law = charts[0].curves[1]
    name, _, unit = charts[0].y_label.rstrip("]").rpartition(" [")
    known = law.y[np.isfinite(law.y)]
    middle, dots = float(np.mean(known)), f"the {name} that the rest of the model leaves"
    if float(np.ptp(known)) <= _FLAT * abs(middle):
        flat = f"{number(abs(middle), 2)} {unit} {'above' if middle > 0.0 else 'below'} zero"
        return (
            f"The law is the same everywhere, so its line is flat, {flat}: the dots, {dots}, lie about it "
            "and not about zero."
        )
    where = "points" if law.dots else "line"
    return f"The dots are {dots}; where the law is right they lie about its {where}."


def _over_a_stretch(d: Diagnosis, k: int, j: int) -> list[Chart]:
    """The two charts over time, where the sum of squares falls most. At rest there is no residual."""
    p, m, unit = d.test.prepared, d.test.moving[:, j], units_of(d)[j]
    t, start = p.t, p.t[0]
    old, new, own = (np.where(m, r[:, j], np.nan) for r in (*d.residuals, d.laws[k]))
    explained = np.concatenate([[0.0], np.cumsum(np.nan_to_num(old**2 - new**2))])
    length = min(_STRETCH, len(t))
    begin = int(np.argmax(explained[length:] - explained[:-length]))
    t, old, new, own = (v[begin : begin + length] for v in (t, old, new, own))
    effect, name = d.causes[k].effect, d.arm.coordinate_names[j]
    span = f"{np.ptp(t):z.2g} s"
    it, what = _added(d)
    found = over_time(
        f"{name}: the law found, {span} of the record",
        f"effort [{unit}]",
        [
            Curve(t, own + new, "measured", "effort without the rest of the model", True),
            Curve(t, own, "law", "law of the cause"),
        ],
        f"The law of {effect} over {span} of the record, with what the rest of the model leaves of the "
        f"effort of {name}.",
        start,
    )
    left = over_time(
        f"{name}: residual without and with {it}",
        f"residual [{unit}]",
        [
            Curve(t, old, "before", f"residual without {what}"),
            Curve(t, new, "after", f"residual with {what}"),
        ],
        f"Residual of {name} over {span} of the record, without and with {_named(d, k)}.",
        start,
    )
    return [found, left]


def _added(d: Diagnosis) -> tuple[str, str]:
    """What the residuals are drawn without and with, for a title and for a legend: all causes together."""
    return ("it", "the cause") if len(d.causes) == 1 else ("all causes", "all causes")


def _named(d: Diagnosis, k: int) -> str:
    return d.causes[k].effect if len(d.causes) == 1 else "all causes"


def _inner(x: Array) -> Array:
    """Flags of all samples but few that lie far out."""
    low, high = np.quantile(x, [_FEW, 1.0 - _FEW])
    if np.ptp(x) <= _FAR * (high - low):
        return np.ones(len(x), dtype=bool)
    return np.asarray((x >= low) & (x <= high))


def _wave(d: Diagnosis, k: int) -> float:
    """Length of a wave of a law that repeats, over the motor's position; infinite of any other."""
    values = d.causes[k].parameters
    if not CATALOGUE[d.causes[k].effect].periodic:
        return np.inf
    return (values["revolution"].value / values["harmonic"].value) or np.inf


def _amid(x: Array, length: float) -> Array:
    """Flags of the samples within that length about the median."""
    return np.asarray(np.abs(x - np.median(x)) <= length / 2)


def _abscissa(d: Diagnosis, k: int, j: int) -> tuple[_Abscissa, float]:
    """Over what the law is most nearly a curve, and how nearly, see _share; what the catalogue says, where
    that is as good. Over time any motion makes a curve of a law: that is for what the catalogue shows so.
    """
    m = d.test.moving[:, j]
    y = d.laws[k][m, j]
    definition = CATALOGUE[d.causes[k].effect]
    usual = ("motor position",) if definition.periodic else _OVER.get(definition.seen_over, ())
    effect, over_time = definition.name, "time" in usual
    tried = [a for a in _tried(d, j, definition) if over_time or a.name != "time"]
    found = [(a, _share(a, y * a.side, _groups(effect, a.name))) for a in tried]
    best = max(found, key=lambda pair: pair[1])
    near = [pair for pair in found if pair[1] >= _NEAR * best[1] and pair[0].name in usual]
    # over time the motion itself is seen, unless it is taken out, and over a load the friction's two signs
    turned = over_time or definition.seen_over == "load"
    plain = [pair for pair in near if (pair[0].side > 0).all() != turned]
    return max(plain, key=lambda pair: pair[1]) if plain else best


def _tried(d: Diagnosis, j: int, definition: type[Definition]) -> Iterator[_Abscissa]:
    p, m = d.test.prepared, d.test.moving[:, j]
    direction = np.sign(_driving(d)[m, j])
    abscissae = against(d)
    # what is a curve over the motor's position is one over the joint's, but for what repeats with the motor
    motor = abscissae.pop("motor position")
    if definition.periodic:
        abscissae = {"motor position": motor}
    if definition.seen_over == "load":
        abscissae |= {name: (x, units_of(d)) for name, x in _loads(d).items()}
    if issubclass(definition, InputEffect):
        abscissae["effort"] = (measured_efforts(d.test), units_of(d))
    for name, (x, units) in abscissae.items():
        for side in (np.ones(len(direction)), direction):
            yield _Abscissa(name, units[j], x[m, j], side)
    time = p.t[m] - p.t[0]
    for side in (np.ones(len(time)), direction):
        yield _Abscissa("time", "s", time, side)


def _driving(d: Diagnosis) -> Array:
    """Speeds (M, n) of the motors, signed as the efforts of the log are that drive them: a lever may turn its
    joint the other way, and so may the constant of a motor or of a transducer.
    """
    p = d.test.prepared
    constants = np.array([x.torque_constant for x in drives_of(d.arm)])
    return np.asarray(p.picked(p.dmotor) * constants * d.test.gain)


def _loads(d: Diagnosis) -> dict[str, Array]:
    """What the links ask of their drives, in size, in the unit of the log (M, n): friction is not in it."""
    test, model = d.test, d.after.model
    function = model.function("gravity")
    given = {"q": test.prepared.picked(test.prepared.q)}
    given["parameters"] = np.where(_of_links(model), d.after.theta, 0.0)
    given |= {a.name: np.zeros(a.size) for a in function.arguments if a.name not in given}
    weight = np.asarray(NumpyFunction(function)(**given), dtype=float).reshape(test.moving.shape)
    own = _of_links(d.before.model)
    carried = test.columns[:, :, own] @ d.before.theta[own]
    return {_WEIGHT: np.abs(weight * test.gain), _CARRIED: np.abs(carried * test.gain)}


def _of_links(model: Model) -> np.ndarray:
    """Flags (p,) of the base parameters in which a link has a part."""
    return ~np.isin(np.arange(len(model.grouping.base)), columns_of_effects(model))


def _bins(effect: str, over: str) -> int:
    """Number of bins over an abscissa: what repeats with it asks for many."""
    return bins_of(over) if CATALOGUE[effect].periodic else BINS


def _groups(effect: str, over: str) -> int:
    """Number of groups over an abscissa, likewise."""
    return max(_GROUPS, _WAVES * _bins(effect, over))


def _curve(x: Array, y: Array, groups: int, held: int = HELD) -> tuple[Array, Array]:
    """Means over groups of neighbours, equally many in each, `held` at least."""
    parts = np.array_split(np.argsort(x, kind="stable"), max(1, min(groups, len(x) // held)))
    return np.array([x[g].mean() for g in parts]), np.array([y[g].mean() for g in parts])


def _share(a: _Abscissa, y: Array, groups: int) -> float:
    """Share of the mean square that the means over bins have."""
    x, means = _curve(a.x, y, groups)
    total = float(np.mean(y**2))
    if not len(x) or total <= 0.0:
        return 0.0
    return 1.0 - float(np.mean((y - np.interp(a.x, x, means)) ** 2)) / total
