"""Identification of logs of any length: triangles and sums that do not grow with the rows.

One pass over the blocks makes one triangle per joint, which holds every weighting of the joints. A part of
them, spread evenly, gives the residuals' autocovariance and the sandwich that it makes; blocks count as
records of their own there.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from modelgen.dataset import Prepared, Stream, prepare
from modelgen.dataset.reading.jumps import check_jumps
from modelgen.description import Arm
from modelgen.errors import InputError
from modelgen.evaluation import Evaluator
from modelgen.functions import Options, build_model
from modelgen.functions.options import prepared as reduced
from modelgen.identification.cut_off_streamed import StreamedLimits
from modelgen.identification.identify import concluded
from modelgen.identification.objects import Identification
from modelgen.identification.reading_errors import with_reading_errors
from modelgen.identification.rows import Rows
from modelgen.identification.validation import regression_of
from modelgen.numeric import Array
from modelgen.regression.autocovariance import ORDER, autoregression, meat_of
from modelgen.regression.least_squares import ROUNDS, Solution, Triangle

Progress = Callable[[int, int], None]
Block = tuple[Array, Array, NDArray[np.bool_]]
PART = 32  # blocks that the standard deviations are made of, at most
WHOLE = 4  # of them kept with every sample, for what errors of the readings do
KEPT = 128 * 1024**2  # bytes of them that are kept


def identify_streamed(
    train: Sequence[Stream],
    arm: Arm,
    options: Options | None = None,
    *,
    test: Sequence[Prepared] = (),
    method: str = "wls",
    physical: bool = False,
    limits: StreamedLimits | None = None,
    progress: Progress | None = None,
) -> Identification:
    """Identify as `identify` does, with memory that does not depend on the samples; method "ols" or "wls".

    limits: what is left out where efforts are cut off. progress: called with the number of blocks done and of
    all. Raises InputError as `identify` does, and for a method or an effect that needs all rows at once.
    """
    if method not in ("ols", "wls"):
        raise InputError(f"--method {method}: a streamed log knows ols and wls only; give a part, FILE@t0:t1")
    options = options or Options()
    model, evaluator = build_model(arm, options.evaluated), Evaluator(reduced(arm, options))
    rows = Rows(model, evaluator)
    if model.function("regressor").reads("load", "state"):
        raise InputError(f"{arm.name}: an effect with states or loads needs the whole log; give a part of it")
    n, p = rows.n, rows.p
    blocks = _Blocks(train, rows, limits, progress)
    own = [Triangle(s.stop - s.start) for s in rows.of_joint]
    for effort, columns, moving in blocks:
        for j, triangle in enumerate(own):
            table, right = columns[:, rows.of_joint[j]], effort[:, j]
            if not moving[:, j].all():
                table, right = table[moving[:, j]], right[moving[:, j]]
            if len(right):
                triangle.add(table, right)
    if sum(t.count for t in own) < 3 * p:
        raise InputError(f"{arm.name}: too few moving rows for {p} parameters; see modelgen excite")
    triangles = [_spread(t, rows.parameter[s], p) for t, s in zip(own, rows.of_joint, strict=True)]
    theta, known, condition, sigma = _weighted(triangles, method)
    precision = np.zeros((p, p))
    for t, size in zip(triangles, sigma, strict=True):
        if t.count:
            precision += t.r[:, :p].T @ t.r[:, :p] / size**2
    weights = np.ones(n) if method == "ols" else 1.0 / sigma
    covariance = np.zeros((p, p))
    covariance[np.ix_(known, known)] = _sandwich(blocks, triangles, theta, known, weights)
    solution = Solution(theta, covariance, known, condition, sigma, precision)
    # Such errors move parameters by as much in a part of the log as in the whole.
    some = regression_of(evaluator, model, blocks.whole, theta)
    solution = with_reading_errors(solution, some, blocks.whole, model, evaluator)
    return concluded(arm, model, evaluator, method, solution, test, physical=physical)


class _Blocks:
    """Efforts (M, n), columns (M, c) and moving rows (M, n) of block after block, as often as wanted.

    Those of `part` are kept from the first time on where they fit into KEPT bytes, else computed again.
    whole: a few blocks, evenly spread, with every sample.
    """

    def __init__(
        self, streams: Sequence[Stream], rows: Rows, limits: StreamedLimits | None, progress: Progress | None
    ) -> None:
        self.streams, self.rows, self.limits, self.progress = streams, rows, limits, progress
        self.count = sum(len(s) for s in streams)
        self.step = max(1, -(-self.count // PART))  # of the blocks that `part` takes
        self.done, self.total = 0, self.count
        self.kept: list[Block] | None = []
        self.whole: list[Prepared] = []
        self._apart = -(-self.count // WHOLE)

    def __iter__(self) -> Iterator[Block]:
        """Every block."""
        self.whole = []
        for number, p, block in self._blocks(1):
            if number % self._apart == self._apart // 2:
                self.whole.append(p)
            if self.kept is not None and number % self.step == 0:
                self.kept.append(block)
                if sum(array.nbytes for one in self.kept for array in one) > KEPT:
                    self.kept = None
            yield block
        if self.kept is None:
            self.total += 2 * len(range(0, self.count, self.step))

    def part(self) -> Iterator[Block]:
        """Every block whose number is a multiple of `step`, after all of them."""
        if self.kept is not None:
            yield from self.kept
        else:
            yield from (block for *_, block in self._blocks(self.step))

    def _blocks(self, step: int) -> Iterator[tuple[int, Prepared, Block]]:
        zero = np.zeros(self.rows.p)
        number = -1
        for stream in self.streams:
            for record in stream.records():
                number += 1
                if number % step:
                    continue
                check_jumps([record])
                whole = record if self.limits is None else self.limits.without(record)
                p = prepare(whole, stream.settings)
                effort, columns = self.rows.of(p, zero)
                yield number, p, (effort, columns, self.rows.moving(p))
                self.done += 1
                if self.progress is not None:
                    self.progress(self.done, self.total)


def _spread(triangle: Triangle, places: NDArray[np.intp], size: int) -> Triangle:
    """A triangle of some columns as one of all `size`: the others are zero."""
    result = Triangle(size)
    result.count = triangle.count
    result.r = np.zeros((len(triangle.r), size + 1))
    result.r[:, [*places, size]] = triangle.r
    return result


def _weighted(triangles: Sequence[Triangle], method: str) -> tuple[Array, NDArray[np.bool_], float, Array]:
    """theta, which are determined, condition, and the residuals' size by joint."""
    p = triangles[0].r.shape[1] - 1
    sigma = np.ones(len(triangles))
    theta, known, condition = np.zeros(p), np.zeros(p, dtype=bool), 1.0
    for turn in range(ROUNDS if method == "wls" else 1):
        whole = Triangle(p)
        for t, size in zip(triangles, sigma, strict=True):
            if t.count:
                whole.add(t.r[:, :p] / size, t.r[:, p] / size)
        before = theta
        theta, known, condition = whole.solve()
        found = [np.linalg.norm(t.r @ np.append(-theta, 1.0)) / np.sqrt(max(1, t.count)) for t in triangles]
        sigma = np.array([float(x) or 1.0 for x in found])
        if turn and np.allclose(theta, before, rtol=1e-9, atol=1e-12):
            break
    return theta, known, condition, sigma


def _sandwich(
    blocks: _Blocks, triangles: Sequence[Triangle], theta: Array, known: NDArray[np.bool_], weights: Array
) -> Array:
    """Covariance of the determined parameters, as `autocovariance.sandwich` has it for many rows."""
    n = len(weights)
    rows = blocks.rows
    sums, count = np.zeros((n, ORDER + 1)), np.zeros(n)
    for effort, columns, moving in blocks.part():
        count += moving.sum(axis=0)
        for j, own in enumerate(rows.of_joint):
            e = (effort[:, j] - columns[:, own] @ theta[rows.parameter[own]]) * moving[:, j] * weights[j]
            for lag in range(min(ORDER + 1, len(e))):
                sums[j, lag] += e[lag:] @ e[: len(e) - lag]
    models = [autoregression(s / max(1.0, c)) for s, c in zip(sums, count, strict=True)]
    size = len(known)
    meat, normal = np.zeros((size, size)), np.zeros((size, size))
    for t, w in zip(triangles, weights, strict=True):
        if t.count:
            table = t.r[:, :-1] * w
            normal += table.T @ table
    for _, columns, moving in blocks.part():
        for own, (taps, power), move, w in zip(rows.of_joint, models, moving.T, weights, strict=True):
            places = rows.parameter[own]
            meat[np.ix_(places, places)] += meat_of(columns[:, own] * (move[:, None] * w), taps, power)
    meat *= sum(t.count for t in triangles) / max(1.0, float(count.sum()))
    meat, normal = meat[np.ix_(known, known)], normal[np.ix_(known, known)]
    scale = np.sqrt(np.diag(normal))
    bread = np.linalg.inv(normal / np.outer(scale, scale)) / np.outer(scale, scale)
    return np.asarray(bread @ meat @ bread)
