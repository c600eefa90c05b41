"""Smooth functions of one thing, without a physical law, describe what the causes leave.

A cause outside the catalogue may look like an effect inside. It looks more like a function of what it does
depend on: where the arm is (a hard spot, a contact) or what its drives take (a supply that sags). The
functions are Gaussian processes: one that bends more costs more evidence, a law that is right costs its few
parameters only (Rasmussen and Williams 2006, 2.7 and 5.4.1; with inducing points, as in their 8.3).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.distance import cdist

from modelgen.dataset.drives import gains
from modelgen.diagnosis.adequacy.null_distribution import NULLS
from modelgen.diagnosis.equations import Equations
from modelgen.diagnosis.evidence import StackedEquations, System
from modelgen.diagnosis.options.thresholds import AdequacyThresholds
from modelgen.numeric import Array

SHAPE = "shape"  # among the nulls
POINTS = 80  # at which a function is free
SAMPLES = 4000  # among which they are chosen
SPREAD = 1e-8  # of the kernel's largest eigenvalue: less is rounding
SIZES = np.logspace(-3.0, 5.0, 17)  # of a function against the noise, over which its evidence is the best


@dataclass(frozen=True)
class SmoothFunction:
    """text: what it is; columns: by joint (from 0) that it acts on, (M, k) of every record. encoder: joint
    (from 0) of whose encoder it is an error.
    """

    text: str
    columns: Mapping[int, Sequence[Array]]
    encoder: int | None = None


@dataclass(frozen=True)
class Likeness:
    """A function that what the causes leave is most like, with its evidence (delta BIC)."""

    shape: SmoothFunction
    evidence: float


@dataclass(frozen=True)
class Worth:
    """evidence: delta BIC in the fair equations; percent: of the RMSE of the joints that it acts on."""

    evidence: float
    percent: float

    @property
    def share(self) -> float:
        """Of the mean squares of those joints."""
        return 1.0 - (1.0 - self.percent / 100.0) ** 2


def likeness(shapes: Iterable[SmoothFunction], system: System) -> Likeness | None:
    """What the causes leave is most like this one of them; None where none has the evidence and a share."""
    limits = system.equations.thresholds
    least, worth = like_delta_bic(limits.adequacy), limits.validation.min_gain_percent
    found = [(shape, log_evidence(shape, system)) for shape in shapes]
    like = [Likeness(shape, w.evidence) for shape, w in found if w.evidence > least and w.percent > worth]
    return max(like, key=lambda one: one.evidence, default=None)


def like_delta_bic(limits: AdequacyThresholds) -> float:
    """Evidence from which what is left is called like a function of no law."""
    return float(np.quantile(NULLS[SHAPE], limits.null_share))


def smooth_functions(system: System) -> Iterator[SmoothFunction]:
    """Functions for driven arms, with the inputs that follow from the system's parameters."""
    equations, rows, n = system.equations, system.rows, system.n
    limits = equations.thresholds.adequacy
    inputs = [equations.evaluator.inputs(r.motion, system.base) for r in rows]
    power = [
        np.abs(gains(equations.arm, r.prepared.q) * u * r.prepared.dq).sum(axis=1, keepdims=True)
        for r, u in zip(rows, inputs, strict=True)
    ]
    for j in range(n):
        yield spots(j, equations)
    for bend in limits.bend_lengths:
        yield from of_pose(equations, bend)
        taken = functions(power, bend)
        columns = {
            j: [r.equation(j, u[:, [j]] * x) for r, u, x in zip(rows, inputs, taken, strict=True)]
            for j in range(n)
        }
        yield SmoothFunction("a gain of all drives that depends on the power that they take", columns)


def of_pose(equations: Equations, bend: float) -> Iterator[SmoothFunction]:
    """A function of where the arm is at each joint in turn, of a bend length."""
    free = functions([r.prepared.q for r in equations.rows], bend)
    for j, name in enumerate(equations.arm.coordinate_names):
        where = [r.equation(j, x) for r, x in zip(equations.rows, free, strict=True)]
        yield SmoothFunction(f"a force at {name} that depends on where the arm is", {j: where})


def spots(j: int, equations: Equations) -> SmoothFunction:
    """A fine function of the position of joint j (from 0), for hard spots."""
    positions = [r.prepared.q[:, [j]] for r in equations.rows]
    over = functions(positions, equations.thresholds.adequacy.spot_length)
    columns = [r.equation(j, x) for r, x in zip(equations.rows, over, strict=True)]
    name = equations.arm.coordinate_names[j]
    return SmoothFunction(f"a force at {name} that depends on its position", {j: columns})


def functions(values: Sequence[Array], bend: float) -> list[Array]:
    """Functions (N, k) of each record's values (N, d), whose sum with independent weights of variance 1 is a
    process with a squared exponential kernel.
    """
    every = np.concatenate(values)
    lengths = np.maximum(bend * np.ptp(every, axis=0), 1e-300)
    points = _far_apart(every[:: max(1, len(every) // SAMPLES)] / lengths)
    sizes, vectors = np.linalg.eigh(_kernel(points, points))
    kept = sizes > SPREAD * sizes[-1]
    turn = vectors[:, kept] / np.sqrt(sizes[kept])
    return [_kernel(x / lengths, points) @ turn for x in values]


def _kernel(a: Array, b: Array) -> Array:
    return np.asarray(np.exp(-0.5 * cdist(a, b, "sqeuclidean")))


def _far_apart(values: Array) -> Array:
    """Points (POINTS, d) of values (N, d), each the farthest from those before (Gonzalez 1985)."""
    chosen = [0]
    distance = cdist(values, values[:1])[:, 0]
    while len(chosen) < POINTS and distance.max() > 0:
        chosen.append(int(np.argmax(distance)))
        distance = np.minimum(distance, cdist(values, values[chosen[-1:]])[:, 0])
    return values[chosen]


def log_evidence(shape: SmoothFunction, system: System) -> Worth:
    """Evidence of the shape beside the system's columns: its marginal likelihood, of the best of SIZES.

    In the fair equations the variance of each joint's noise is at its best and its colour known: a function
    that bends follows noise of the same colour.
    """
    k = next(iter(shape.columns.values()))[0].shape[1]
    columns = [np.zeros((*r.effort.shape, k)) for r in system.rows]
    for j, tables in shape.columns.items():
        for whole, table in zip(columns, tables, strict=True):
            whole[:, j] = table
    acted = np.array([j in shape.columns for j in range(system.n)])
    evidence, function = _likelihood(system.fair, columns, acted)
    plain = system.plain
    taken = plain.stacked([table @ function[:, None] for table in columns])[:, 0]
    left = plain.by_group(plain.left - taken + plain.basis @ (plain.basis.T @ taken))[: len(acted)]
    share = float(left[acted].sum() / max(plain.rss[acted].sum(), 1e-300))
    return Worth(evidence, 100.0 * (1.0 - float(np.sqrt(share))))


def _likelihood(
    stack: StackedEquations, columns: Sequence[Array], acted: NDArray[np.bool_]
) -> tuple[float, Array]:
    """Likelihood of the columns' weights (k,), each of variance 1 times the best size, and the weights there.

    Over that without them; the price of the size is that of one parameter. acted: joints (n,) with columns.
    """
    # of the rows of the joints acted on: elsewhere the columns are zero, and have what the baseline takes up
    there = np.isin(stack.groups, np.flatnonzero(acted))
    own = stack.stacked(columns)[there]
    through = stack.basis[there].T @ own
    sizes, vectors = np.linalg.eigh(own.T @ own - through.T @ through)
    sizes, own, through = stack.share * np.maximum(sizes, 0.0), own @ vectors, through @ vectors
    best, function = -np.inf, np.zeros(len(vectors))
    if not (sizes.max() > 0 and stack.rss.any()):
        return best, function
    grams, rights = [], []
    for j, (basis, taken) in enumerate(stack.products):
        gram, right = through.T @ basis @ through, -through.T @ taken
        if j < len(acted) and acted[j]:
            place = stack.groups == j
            part = own[place[there]]
            cross = part.T @ stack.basis[place] @ through
            gram, right = gram + part.T @ part - cross - cross.T, right + part.T @ stack.left[place]
        grams.append(gram)
        rights.append(right)
    used = stack.squares > 0
    acting = np.zeros(len(grams))
    acting[: len(acted)] = acted / acted.sum()
    for scale in SIZES / sizes.max():
        weights = scale * stack.share / (1.0 + scale * sizes) * sum(rights)
        left = stack.squares + [
            weights @ gram @ weights - 2.0 * weights @ right
            for gram, right in zip(grams, rights, strict=True)
        ]
        left = left + acting * float(weights @ weights) / (scale * stack.share)
        evidence = (
            float(stack.weights[used] @ np.log(stack.squares[used] / np.maximum(left[used], 1e-300)))
            - float(np.log1p(scale * sizes).sum())
            - float(np.log(stack.counts[acted].sum()))
        )
        if evidence > best:
            best, function = evidence, vectors @ weights
    return best, function
