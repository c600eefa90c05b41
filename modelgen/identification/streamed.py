"""Identification of logs of any length: triangles and sums that do not grow with the rows.

One pass over the blocks makes one triangle per joint, which holds every weighting of the joints. Two passes
over a part of them, spread evenly, give the residuals' autocovariance and the sandwich that it makes; blocks
count as records of their own there.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from modelgen.dataset import Prepared, Stream, prepare
from modelgen.description import Arm
from modelgen.errors import InputError
from modelgen.functions import Model, Options, build_model
from modelgen.functions.options import prepared as reduced
from modelgen.identification.autocovariance import ORDER, autoregression, meat_of
from modelgen.identification.identify import Identification, concluded, rows_of
from modelgen.identification.regression import ROUNDS, Solution, Triangle
from modelgen.probing import Prober

Array = NDArray[np.float64]
Progress = Callable[[int, int], None]
Block = tuple[Array, Array, NDArray[np.bool_]]
PART = 32  # blocks that the standard deviations are made of, at least where there are as many


def identify_streamed(
    train: Sequence[Stream],
    arm: Arm,
    options: Options | None = None,
    *,
    test: Sequence[Prepared] = (),
    method: str = "wls",
    physical: bool = False,
    progress: Progress | None = None,
) -> Identification:
    """As `identify`, with memory that does not depend on the samples; method "ols" or "wls".

    progress: called with the number of blocks done and of all. Raises InputError as `identify` does, and for
    a method or an effect that needs all rows at once.
    """
    if method not in ("ols", "wls"):
        raise InputError(f"--method {method}: a streamed log knows ols and wls only; give a part, FILE@t0:t1")
    options = options or Options()
    model, prober = build_model(arm, options), Prober(reduced(arm, options))
    (function,) = [f for f in model.functions if f.name == "regressor"]
    if {"load", "state"} & {a.name for a in function.arguments}:
        raise InputError(f"{arm.name}: an effect with states or loads needs the whole log; give a part of it")
    n, p = len(arm.coordinates), len(model.grouping.base)
    blocks = _Blocks(train, model, prober, progress)
    triangles = [Triangle(p) for _ in range(n)]
    for effort, columns, moving in blocks:
        for j, triangle in enumerate(triangles):
            rows = moving[:, j]
            if rows.any():
                triangle.add(columns[rows, j], effort[rows, j])
    if sum(t.count for t in triangles) < 3 * p:
        raise InputError(f"{arm.name}: too few moving rows for {p} parameters; see modelgen excite")
    theta, known, condition, sigma = _weighted(triangles, method)
    precision = np.zeros((p, p))
    for t, size in zip(triangles, sigma, strict=True):
        if t.count:
            precision += t.r[:, :p].T @ t.r[:, :p] / size**2
    weights = np.ones(n) if method == "ols" else 1.0 / sigma
    covariance = np.zeros((p, p))
    covariance[np.ix_(known, known)] = _sandwich(blocks, triangles, theta, known, weights)
    solution = Solution(theta, covariance, known, condition, sigma, precision)
    return concluded(arm, model, prober, method, solution, test, physical=physical)


class _Blocks:
    """Efforts (M, n), columns (M, n, p) and moving rows (M, n) of block after block, as often as wanted."""

    def __init__(
        self, streams: Sequence[Stream], model: Model, prober: Prober, progress: Progress | None
    ) -> None:
        self.streams, self.model, self.prober, self.progress = streams, model, prober, progress
        self.count = sum(len(s) for s in streams)
        self.step = max(1, self.count // PART)  # of the blocks that `part` takes
        self.done, self.total = 0, self.count + 2 * len(range(0, self.count, self.step))

    def __iter__(self) -> Iterator[Block]:
        return self.part(1)

    def part(self, step: int) -> Iterator[Block]:
        """Every block whose number is a multiple of `step`."""
        zero = np.zeros(len(self.model.grouping.base))
        number = -1
        for stream in self.streams:
            for record in stream.records():
                number += 1
                if number % step:
                    continue
                p = prepare(record, stream.settings)
                effort, columns = rows_of(self.prober, self.model, p, zero)
                yield effort, columns, p.moving
                self.done += 1
                if self.progress is not None:
                    self.progress(self.done, self.total)


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
    sums, count = np.zeros((n, ORDER + 1)), np.zeros(n)
    for effort, columns, moving in blocks.part(blocks.step):
        e = (effort - columns @ theta) * moving * weights
        count += moving.sum(axis=0)
        for lag in range(min(ORDER + 1, len(e))):
            sums[:, lag] += np.einsum("ij,ij->j", e[lag:], e[: len(e) - lag])
    models = [autoregression(s / max(1.0, c)) for s, c in zip(sums, count, strict=True)]
    size = int(known.sum())
    meat, normal = np.zeros((size, size)), np.zeros((size, size))
    for t, w in zip(triangles, weights, strict=True):
        if t.count:
            table = t.r[:, :-1][:, known] * w
            normal += table.T @ table
    for _, columns, moving in blocks.part(blocks.step):
        for j, (taps, power) in enumerate(models):
            meat += meat_of(columns[:, j][:, known] * (moving[:, j, None] * weights[j]), taps, power)
    meat *= sum(t.count for t in triangles) / max(1.0, float(count.sum()))
    scale = np.sqrt(np.diag(normal))
    bread = np.linalg.inv(normal / np.outer(scale, scale)) / np.outer(scale, scale)
    return np.asarray(bread @ meat @ bread)
