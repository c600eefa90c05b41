"""What is left as a smooth function of one thing, whatever the function: no physical law stands behind it.

A cause outside the catalogue may look like an effect inside. It looks more like a function of what it does
depend on: where the arm is (a hard spot, a contact) or what its drives take (a supply that sags). The
functions are Gaussian processes: one that bends more costs more evidence, a law that is right costs its few
parameters only (Rasmussen and Williams 2006, 2.7 and 5.4.1; with inducing points, as in their 8.3).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial.distance import cdist

from modelgen.dataset import drives_of
from modelgen.diagnosis.rows import Array, Rows
from modelgen.diagnosis.system import System
from modelgen.probing import Prober

SHAPE = "shape"  # among the nulls
BENDS = (0.2, 0.5)  # length over which a function bends, of the range of what it depends on
SHORT = 0.06  # the same for a single joint: a hard spot
POINTS = 80  # at which a function is free
SAMPLES = 4000  # among which they are chosen
SPREAD = 1e-8  # of the kernel's largest eigenvalue: less is rounding
SIZES = np.logspace(-3.0, 5.0, 17)  # of a function against the noise, over which its evidence is the best


@dataclass(frozen=True)
class Shape:
    """text: what it is; columns: by joint (from 0) that it acts on, (M, k) of every record."""

    text: str
    columns: Mapping[int, Sequence[Array]]


@dataclass(frozen=True)
class Worth:
    """evidence: delta BIC; percent: of the RMSE of the joints that it acts on."""

    evidence: float
    percent: float


def shapes(rows: Sequence[Rows], prober: Prober, base: Array) -> Iterator[Shape]:
    """Of driven arms. base: base parameters (p,), from which the inputs follow."""
    n = rows[0].effort.shape[1]
    inputs = [prober.inputs(r.motion, base) for r in rows]
    drives = drives_of(prober.arm)
    power = []
    for r, u in zip(rows, inputs, strict=True):
        gains = np.column_stack([drive.gain(r.prepared.q[:, j]) for j, drive in enumerate(drives)])
        power.append(np.abs(gains * u * r.prepared.dq).sum(axis=1, keepdims=True))
    for j in range(n):
        alone = functions([r.prepared.q[:, [j]] for r in rows], SHORT)
        spots = [r.prepared.parallel(x) for r, x in zip(rows, alone, strict=True)]
        yield Shape(f"a force at joint {j + 1} that depends on its position", {j: spots})
    for bend in BENDS:
        free = functions([r.prepared.q for r in rows], bend)
        where = [r.prepared.parallel(x) for r, x in zip(rows, free, strict=True)]
        for j in range(n):
            yield Shape(f"a force at joint {j + 1} that depends on where the arm is", {j: where})
        taken = functions(power, bend)
        columns = {
            j: [r.prepared.parallel(u[:, [j]] * x) for r, u, x in zip(rows, inputs, taken, strict=True)]
            for j in range(n)
        }
        yield Shape("a gain of all drives that depends on the power that they take", columns)


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


def worth(shape: Shape, system: System) -> Worth:
    """What the shape explains beside the system's columns: its marginal likelihood, of the best of SIZES.

    The rows are those as they are, with as many of them as are independent: shapes are slow.
    """
    plain = system.plain
    k = next(iter(shape.columns.values()))[0].shape[1]
    gram, seen, right = np.zeros((k, k)), np.zeros((plain.basis.shape[1], k)), np.zeros(k)
    power, count, rows = 0.0, 0.0, 0
    for j, tables in shape.columns.items():
        own = plain.joint == j
        table = np.concatenate([t[r.moving[:, j]] for t, r in zip(tables, plain.rows, strict=True)])
        table = table / plain.sizes[j]
        gram, seen = gram + table.T @ table, seen + plain.basis[own].T @ table
        right, power = right + table.T @ plain.left[own], power + float(plain.left[own] @ plain.left[own])
        count, rows = count + float(plain.counts[j]), rows + int(own.sum())
    if not power > 0:
        return Worth(-np.inf, 0.0)
    share = count / rows
    sizes, vectors = np.linalg.eigh(gram - seen.T @ seen)
    sizes, seen_by = share * np.maximum(sizes, 0.0), share * (vectors.T @ right) ** 2
    best = Worth(-np.inf, 0.0)
    for scale in SIZES / max(float(sizes.max()), 1e-300):
        explained = float((scale * seen_by / (1.0 + scale * sizes)).sum()) / power
        evidence = (
            -count * np.log(max(1.0 - explained, 1e-300)) - np.log1p(scale * sizes).sum() - np.log(count)
        )
        if evidence > best.evidence:
            best = Worth(float(evidence), 100.0 * (1.0 - float(np.sqrt(max(0.0, 1.0 - explained)))))
    return best
