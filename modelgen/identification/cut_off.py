"""Efforts that are cut off, as the model shows it: coarse readings alone do not.

At its highest reading a coarse effort stands often enough, and one that is cut off may have few other levels.
That reading says that the effort was so much at least, whether it is cut off or not, and the model is fitted
so (censored regression: Tobin 1958; with the size of the noise given the likelihood has one maximum, Olsen
1978). Where clipping what it asks for explains all samples far better than fits that take each reading as it
stands, or as that of a step, the effort is cut off. What is left out then follows from the model's effort,
not from the reading: of samples near the limit those with noise of one sign would stay (truncated regression:
Amemiya 1973).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from modelgen.dataset import Chosen, Prepared, Record, Settings, choose, prepare
from modelgen.dataset.processing.rounding import step_of
from modelgen.dataset.processing.saturation import CUT_OFF, FEWEST, ends_of, saturated, standing_at
from modelgen.description import Arm
from modelgen.errors import InputError
from modelgen.evaluation import Evaluator
from modelgen.functions import Model, Options, build_model
from modelgen.functions.options import prepared as reduced
from modelgen.identification.effort_limits import Beyond, End, beside, gain_of, ideal_of, logged_of
from modelgen.identification.rows import motion_of
from modelgen.identification.validation import regression_of
from modelgen.numeric import Array
from modelgen.regression.censored import Samples, censored
from modelgen.regression.least_squares import Solution


class CutOffError(InputError):
    """Efforts that are cut off so often that the rest does not determine the parameters."""


BETTER = 0.85  # of the squares that a fit to all samples leaves, that clipping may leave to be believed
LEVELS = 4  # of an effort, with fewer of which nothing is known of what is between
FEW = 3  # rows per parameter, without which a fit tells nothing
SIZES = 6  # rounds of a fit and the size of what it leaves
ROUNDS = 3  # of a fit and what it leaves out
SAMPLES = 100_000  # that a fit looks at


def without_cut_off(
    train: Sequence[Record], test: Sequence[Record], settings: Settings | Chosen, arm: Arm
) -> tuple[list[Record], list[Record]]:
    """The records with the samples named at which efforts are cut off, and a remark where the model says so.

    Records as they are where no effort stands at its highest or lowest reading, or these cannot tell. Raises
    InputError where the others do not determine the parameters.
    """
    found = list(train), list(test)
    if any(r.input is None for r in train):
        return found
    try:
        chosen = choose(train, settings)
        prepared, tested = ([uncut(r, chosen) for r in part] for part in (train, test))
        limits = limits_of(prepared, list(ends_in(prepared)), arm)
    except CutOffError:
        raise
    except (InputError, np.linalg.LinAlgError, FloatingPointError):
        return found  # what is wrong is said where the parameters are found
    if limits is None:
        return found
    flags, unseen = ([limits.of(p) for p in part] for part in (prepared, tested))
    said = limits.remarks(prepared, flags)
    fitted = [replace(r, cut_off=x, remarks=(*r.remarks, *said)) for r, x in zip(train, flags, strict=True)]
    held = [replace(r, cut_off=x) for r, x in zip(test, unseen, strict=True)]
    return fitted, held


@dataclass(frozen=True)
class Limits:
    """Ends at which efforts are cut off, and what tells the samples. names: of the joints."""

    ends: Sequence[End]
    beyond: Beyond
    names: Sequence[str]

    def of(self, p: Prepared, levels: Sequence[Sequence[float]] | None = None) -> NDArray[np.bool_]:
        """Samples (N, n) beyond the limits, and those of the other joints as the readings alone show them.

        levels: readings by joint at which these show it; None: to be read off the record.
        """
        found = self.beyond.of(p)
        for j in set(range(p.n)) - {e.joint for e in self.ends}:
            logged = logged_of(p)[:, j]
            found[:, j] = (
                saturated(logged, p.record.q[:, j]) if levels is None else standing_at(logged, levels[j])
            )
        return found

    def remarks(self, prepared: Sequence[Prepared], flags: Sequence[NDArray[np.bool_]]) -> tuple[str, ...]:
        """What is left out of records, of which flags (N, n) say what it is."""
        return tuple(_remarks(prepared, flags, self.ends, self.names))


def limits_of(prepared: Sequence[Prepared], ends: Sequence[End], arm: Arm) -> Limits | None:
    """Limits among the ends that the model shows in records; None where there are none.

    Raises CutOffError where what is not cut off does not determine the parameters.
    """
    if not ends:
        return None
    options = Options().evaluated
    model, evaluator = build_model(arm, options), Evaluator(reduced(arm, options))
    fit = _Fit(prepared, ends, model, evaluator)
    shown = fit.cut()
    if not shown:
        return None
    names = model.arm.coordinate_names
    beyond = fit.without(shown)
    if beyond is None:
        raise CutOffError(f"{prepared[0].record.name}: {_too_much(prepared, shown, names)}")
    return Limits(shown, beyond, names)


def uncut(record: Record, chosen: Chosen) -> Prepared:
    """The record, prepared as if no effort were cut off, and with positions as smooth as the rows are: what a
    single sample asks for has all noise of its acceleration.
    """
    smooth = replace(chosen, position_cutoff=chosen.cutoff or chosen.position_cutoff)
    return prepare(replace(record, cut_off=np.zeros(record.q.shape, dtype=bool)), smooth)


def ends_in(prepared: Sequence[Prepared]) -> Iterator[End]:
    """Readings at which an effort stands as often as one that is cut off does at least."""
    for j in range(prepared[0].n):
        logged = np.concatenate([logged_of(p)[p.awake[:, j], j] for p in prepared])
        if not len(logged):
            continue
        least = max(FEWEST, CUT_OFF * len(logged))
        levels, counts = np.unique(logged, return_counts=True)
        if len(levels) < LEVELS:
            continue
        step = step_of(logged)
        shown = {level for p in prepared for level, _ in ends_of(logged_of(p)[:, j], p.record.q[:, j])}
        for sign, at in ((1, -1), (-1, 0)):
            if counts[at] >= least:
                yield End(j, sign, float(levels[at]), step, float(levels[at]) in shown)


def _too_much(prepared: Sequence[Prepared], ends: Sequence[End], names: Sequence[str]) -> str:
    """What there is to say where what is not cut off does not determine the parameters."""
    said = []
    for e in ends:
        logged = np.concatenate([logged_of(p)[p.awake[:, e.joint], e.joint] for p in prepared])
        share = 100.0 * float(np.mean(logged == e.reading))
        said.append(
            f"{names[e.joint]} at {e.reading:.6g} {prepared[0].effort_unit[e.joint]} in {share:.2g} %"
        )
    return (
        f"efforts are cut off, that of {', of '.join(said)} of the moving samples, and the others do not "
        "determine the parameters; record motions with smaller efforts, or a wider range of the readings"
    )


def _remarks(
    prepared: Sequence[Prepared],
    flags: Sequence[NDArray[np.bool_]],
    ends: Sequence[End],
    names: Sequence[str],
) -> Iterator[str]:
    for j in sorted({e.joint for e in ends}):
        own = sorted(e.reading for e in ends if e.joint == j)
        share = float(np.mean(np.concatenate([x[:, j] for x in flags])))
        unit = prepared[0].effort_unit[j]
        readings = " and ".join(f"{x:.6g}" for x in own)
        yield (
            f"the effort of {names[j]} is cut off at {readings} {unit}: the model asks for more, or may, in "
            f"{100 * share:.3g} % of the samples, which are left out"
        )


class _Fit:
    """Samples of records by joint, and the fits of a model to them."""

    def __init__(
        self, prepared: Sequence[Prepared], ends: Sequence[End], model: Model, evaluator: Evaluator
    ) -> None:
        self.prepared, self.ends, self.model, self.evaluator = prepared, ends, model, evaluator
        plain = regression_of(evaluator, model, prepared, np.zeros(len(model.grouping.base))).solve("wls")
        self.whole, self.known = plain.theta, plain.determined
        total = sum(int(p.awake.sum()) for p in prepared)
        every = max(1, total // SAMPLES)
        self.samples = [self._of_joint(j, every) for j in range(prepared[0].n)]
        bounded = [self._bounded(j, x) for j, x in enumerate(self.samples)]
        self.theta = self.plain = self.whole
        for _ in range(SIZES):
            self.theta, self.plain = censored(self.samples, self.theta), censored(bounded, self.plain)

    def _of_joint(self, j: int, every: int) -> Samples:
        """One sample of `every` of a joint."""
        own, parts = [e for e in self.ends if e.joint == j], []
        for p in self.prepared:
            assert p.input is not None
            full = np.asarray(self.evaluator.regressor(self.model, motion_of(p), self.whole))[:, j]
            gain, logged = gain_of(p)[:, j], logged_of(p)[:, j]
            side = np.zeros(len(logged), dtype=np.intp)
            for e in own:
                side[logged == e.reading] = e.sign
            kept = p.awake[:, j] & ((side != 0) | ~beside(side != 0))
            at = np.flatnonzero(kept)[::every]
            parts.append((full[at] * gain[at, None], (p.input[:, j] * gain)[at], side[at]))
        columns, effort, side = (np.concatenate(x) for x in zip(*parts, strict=True))
        for e in own:
            effort[side == e.sign] = e.reading - e.sign * e.step / 2
        return Samples(columns, effort, side)

    def _bounded(self, j: int, x: Samples) -> Samples:
        """The samples as they are where nothing is cut off: readings as they stand, or of a step."""
        step = max((e.step for e in self.ends if e.joint == j), default=0.0)
        return replace(x, width=step) if step else replace(x, side=np.zeros_like(x.side))

    def cut(self) -> list[End]:
        """Ends at which efforts are cut off.

        A model that lacks something may gain by clipping too. It is believed where all that is left then is
        less than what rounding makes, or where the readings alone show as much.
        """
        found: list[End] = []
        for j in sorted({e.joint for e in self.ends}):
            own = [e for e in self.ends if e.joint == j]
            whole, plain, ideal = (
                [ideal_of(p, self.model, self.evaluator, theta)[:, j] for p in self.prepared]
                for theta in (self.whole, self.plain, self.theta)
            )
            model = [own[0].rounded(x) for x in ideal]
            rounding = self._squares(j, [x - y for x, y in zip(model, ideal, strict=True)])
            least = BETTER * min(
                self._squares(j, self._left(j, [own[0].rounded(x) for x in every]))
                for every in (whole, plain)
            )
            best: list[End] = []
            for some in ([own[0]], [own[-1]], own) if len(own) > 1 else (own,):
                clipped = model
                for e in some:
                    clipped = [e.clipped(x) for x in clipped]
                left = self._squares(j, self._left(j, clipped))
                if left < least and (left < rounding or all(e.shown for e in some)):
                    least, best = BETTER * left, some
            found += best
        return found

    def without(self, ends: Sequence[End]) -> Beyond | None:
        """What is cut off, by a fit without that; None where the other samples do not determine the model."""
        first = self._fitted([self._standing(p, ends) for p in self.prepared], self.theta)
        if first is None:
            return None
        n = self.prepared[0].n
        found = Beyond(ends, self.model, self.evaluator, self.theta, np.zeros(n), first.covariance)
        for _ in range(ROUNDS):
            found = replace(found, noise=found.noise_of(self.prepared))
            again = self._fitted([found.of(p) for p in self.prepared], found.theta)
            if again is None:
                break
            found = replace(found, theta=again.theta)
        return found

    def _standing(self, p: Prepared, ends: Sequence[End]) -> NDArray[np.bool_]:
        """Samples (N, n) at the readings at which efforts may be cut off, and beside them."""
        found = np.zeros(p.q.shape, dtype=bool)
        for e in ends:
            found[:, e.joint] |= logged_of(p)[:, e.joint] == e.reading
        return found | beside(found)

    def _fitted(self, without: Sequence[NDArray[np.bool_]], theta: Array) -> Solution | None:
        """A fit without samples (N, n) by record; None where it leaves open what all samples determine."""
        kept = [
            replace(p, awake=p.awake & ~x, moving=p.moving & ~x[p.rows])
            for p, x in zip(self.prepared, without, strict=True)
        ]
        regression = regression_of(self.evaluator, self.model, kept, theta)
        if sum(int(m.sum()) for m in regression.moving) < FEW * len(theta):
            return None
        solution = regression.solve("wls")
        return None if (self.known & ~solution.determined).any() else solution

    def _left(self, j: int, ideal: Sequence[Array]) -> list[Array]:
        """What efforts (N,) of joint j leave of those of the log."""
        every = zip(self.prepared, ideal, strict=True)
        return [p.input[:, j] * gain_of(p)[:, j] - x for p, x in every if p.input is not None]

    def _squares(self, j: int, left: Sequence[Array]) -> float:
        """Sum of squares of parts (N,) of the efforts of joint j, through the filter."""
        total = 0.0
        for p, x in zip(self.prepared, left, strict=True):
            rows = p.parallel(x)[p.moving[:, j]]
            total += float(rows @ rows)
        return total
