"""Parameters that no arm has, or far from the described one: each doubt with the question that it asks."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from modelgen.dataset import Prepared, drives_of
from modelgen.dataset.drives import gains
from modelgen.errors import InputError
from modelgen.evaluation import Evaluator, Motion
from modelgen.functions import Model, grouped
from modelgen.functions.nominal import nominal_links
from modelgen.identification.impossible import CLEARLY
from modelgen.identification.objects import DIAGNOSING, Doubt, Identification, Impossible, WorseThanNone
from modelgen.numeric import Array

POSES = 60  # of the records, at which inertia and weight are looked at
PART = 0.1  # of the efforts, that an inertia makes up to be looked at
FACTOR = 5.0  # between the weight found and that of the nominal links, from which on it is asked about
ALONE = 0.8  # of the power of what differs, that another size of one link explains if it is asked about
NOTABLE = 0.02  # of the largest weight at a joint [N m, N], below which that at another is not compared
WORSE = 3.0  # times the error of what was fitted, from which on that of the test records is asked about
LARGE = 10.0  # % of the effort, likewise
NOTHING = 100.0  # % of the effort, which a model that predicts zero misses
LINK = ("XX", "XY", "XZ", "YY", "YZ", "ZZ", "MX", "MY", "MZ", "M")


def doubts(
    train: Sequence[Prepared],
    model: Model,
    evaluator: Evaluator,
    theta: Array,
    covariance: Array,
    determined: NDArray[np.bool_],
    *,
    whole: bool = True,
) -> list[Doubt]:
    """Questions about base parameters theta (p,) by poses of the records.

    determined: flags (p,). whole: whether nothing is known to be missing in the model; what is would show in
    its inertia.
    """
    links = _links(model)
    found: list[Doubt] = (
        [*inertia_below_zero(train, model, evaluator, theta, covariance, determined)] if whole else []
    )
    if not links[1]:
        return found
    q, ddq, _ = _poses(train)
    at_rest = _columns(model, evaluator, q, np.zeros_like(q), theta)
    along = _columns(model, evaluator, q, ddq, theta)
    gain = gains(model.arm, q)
    weight = _weight(model, gain, at_rest, links, theta, determined)
    return [*found, *(weight or _one_link(model, along * gain[:, :, None], links, theta, determined))]


def inertia_below_zero(
    train: Sequence[Prepared],
    model: Model,
    evaluator: Evaluator,
    theta: Array,
    covariance: Array,
    determined: NDArray[np.bool_],
) -> list[Impossible]:
    """The question about joints whose own inertia is below zero, of base parameters theta (p,) by poses of
    the records. determined: flags (p,).
    """
    q, ddq, efforts = _poses(train)
    at_rest = _columns(model, evaluator, q, np.zeros_like(q), theta)
    below = _below_zero(model, evaluator, (q, ddq, efforts), at_rest, theta, covariance, determined)
    found = [model.arm.coordinate_names[j] for j in below]
    if not found:
        return []
    text = (
        f"Impossible: the inertia at {', '.join(found)} comes out below zero. Is the sign of the efforts the "
        "other way round, are positions and efforts of one joint and instant, are the positions too coarse, "
        f"or does the model lack an effect{DIAGNOSING}?"
    )
    return [Impossible(text, found)]


def worse_on_test(found: Identification, train: Sequence[Prepared]) -> list[str]:
    """The question about joints whose efforts are predicted far worse on test records than those fitted."""
    test = found.test
    if test is None or not np.all(np.isfinite(found.solution.sigma)):
        return []
    names, said = found.arm.coordinate_names, list[str]()
    for j, name in enumerate(names):
        gain = 1.0 if train[0].gain is None else float(np.sqrt(np.mean(train[0].gain[:, j] ** 2)))
        fitted = float(found.solution.sigma[j]) * gain
        times = float(test.rmse[j]) / max(fitted, 1e-300)
        if test.nrmse_percent[j] > NOTHING:
            text = (
                f"The error at {name} is {test.nrmse_percent[j]:.0f} % of its effort on the test records, "
                "more than that of no model at all: are they of the same arm, read alike, and do training "
                "records move that joint?"
            )
            said.append(WorseThanNone(text, [name]))
        elif times > WORSE and test.nrmse_percent[j] > LARGE:
            said.append(
                f"The error at {name} is {test.nrmse_percent[j]:.0f} % of its effort on the test records, "
                f"{times:.0f} times what it is on those fitted: are they of the same arm, read alike, and "
                f"what does the description lack{DIAGNOSING}?"
            )
    return said


def of_other_sign(
    train: Sequence[Prepared],
    model: Model,
    evaluator: Evaluator,
    theta: Array,
    covariance: Array,
    determined: NDArray[np.bool_],
    part: float | None = None,
) -> list[int]:
    """Coordinates (from 0) whose own inertia is below zero, or whose weight has the other sign than that of
    the nominal links, of base parameters theta (p,) by poses of the records. determined: flags (p,). part: of
    the efforts, that an inertia makes up to be looked at.
    """
    q, ddq, efforts = _poses(train)
    at_rest = _columns(model, evaluator, q, np.zeros_like(q), theta)
    poses = q, ddq, efforts
    below = _below_zero(model, evaluator, poses, at_rest, theta, covariance, determined, part)
    links = _links(model)
    if links[1]:
        scales = _weights(model, gains(model.arm, q), at_rest, links, theta, determined)
        below += [j for j, scale in scales.items() if scale < -1.0 / FACTOR]
    return below


def _poses(train: Sequence[Prepared]) -> tuple[Array, Array, Array]:
    """Positions, accelerations and inputs at some rows of the records, (N, n) each."""
    rows = [(p.picked(p.q), p.picked(p.ddq), p.effort) for p in train]
    q, ddq, efforts = (np.concatenate(x) for x in zip(*rows, strict=True))
    every = slice(None, None, max(1, len(q) // POSES))
    return q[every], ddq[every], efforts[every]


def _columns(model: Model, evaluator: Evaluator, q: Array, ddq: Array, theta: Array) -> Array:
    """Regressor (N, n, p) at poses without speed."""
    motion = Motion(np.arange(len(q)) / 1000.0, q, np.zeros_like(q), ddq)
    return np.asarray(evaluator.regressor(model, motion, theta))


def _below_zero(
    model: Model,
    evaluator: Evaluator,
    motion: tuple[Array, Array, Array],
    at_rest: Array,
    theta: Array,
    covariance: Array,
    determined: NDArray[np.bool_],
    part: float | None = None,
) -> list[int]:
    """Coordinates whose own inertia is below zero clearly, at most of the poses: no body has that.

    Where what it does is a small part of the efforts, errors of the model that are larger may hide in it.
    """
    drives, found, (q, accelerations, efforts) = drives_of(model.arm), [], motion
    for j in range(q.shape[1]):
        alone = np.zeros_like(q)
        alone[:, j] = 1.0
        row = (_columns(model, evaluator, q, alone, theta) - at_rest)[:, j]
        made = float(np.linalg.norm((row @ theta) * accelerations[:, j]))
        if made < (PART if part is None else part) * float(np.linalg.norm(efforts[:, j])):
            continue
        row = row * np.sign(drives[j].gain(q[:, j]))[:, None]
        if row[:, ~determined].any():
            continue
        size = np.sqrt(np.maximum(np.einsum("ki,ij,kj->k", row, covariance, row), 0.0))
        if np.mean(row @ theta < -CLEARLY * size) > 0.5:
            found.append(j)
    return found


def _links(model: Model) -> tuple[NDArray[np.bool_], list[Array]]:
    """Base parameters (p,) that links alone have a part in, and the vector (p,) of each nominal link.

    No vectors where the description has not all of the links.
    """
    of_links = np.array(
        [
            all(model.standard[i].name.rstrip("0123456789") in LINK for i, _ in b.terms)
            for b in model.grouping.base
        ]
    )
    try:
        known = nominal_links(model.arm)
    except InputError:
        return of_links, []
    own = []
    for i in range(len(model.arm.links)):
        names = {f"{name}{i + 1}" for name in LINK}
        standard = [known.get(p.name, 0.0) if p.name in names else 0.0 for p in model.standard]
        own.append(np.array(list(grouped(model, standard).values())))
    return of_links, own


def _one_link(
    model: Model,
    columns: Array,
    links: tuple[NDArray[np.bool_], list[Array]],
    theta: Array,
    determined: NDArray[np.bool_],
) -> list[Doubt]:
    """The link that is some times its nominal self, where that alone explains how the efforts differ.

    columns: (N, n, p) of weight and accelerations along the records.
    """
    of_links, own = links
    used = of_links & determined
    if not used.any():  # of a screw drive that hides the link's mass, say
        return []
    table = columns[:, :, used].reshape(-1, int(used.sum()))
    parts = [table @ x[used] for x in own]
    nominal, seen = sum(parts, np.zeros(len(table))), table @ theta[used]
    apart = seen - nominal
    if np.linalg.norm(apart) < PART * min(float(np.linalg.norm(x)) for x in (seen, nominal)):
        return []
    power = np.array([float(part @ part) for part in parts])
    more = np.array([float(apart @ part) for part in parts]) / np.maximum(power, 1e-300)
    best = int(np.argmax(more**2 * power))
    times, share = 1.0 + float(more[best]), float(more[best] ** 2 * power[best] / (apart @ apart))
    if share < ALONE or 1.0 / FACTOR < times < FACTOR:
        return []
    name = model.arm.joints[best].name
    text = (
        f"The efforts are those of {times:.2g} times the nominal link {name}, the others as described: is a "
        "unit another one there, of its mass or of lengths?"
    )
    return [Doubt(text, [name])]


def _weight(model: Model, *given: Any) -> list[Doubt]:
    """Joints whose weight is far from that of the nominal links, where the description has all of them."""
    said = list[Doubt]()
    for j, scale in _weights(model, *given).items():
        name = model.arm.joints[model.arm.coordinates[j]].name
        if scale < -1.0 / FACTOR:
            text = (
                f"The weight at {name} comes out {scale:.3g} times that of the nominal links, of the other "
                "sign: do gravity in the description and the sign of the efforts agree?"
            )
            said.append(Doubt(text, [name]))
        elif not 1.0 / FACTOR < scale < FACTOR:
            text = (
                f"The weight at {name} comes out {scale:.3g} times that of the nominal links: is a unit "
                "another one, of masses and lengths there, of the efforts, or of torque_constant and ratio?"
            )
            said.append(Doubt(text, [name]))
    return said


def _weights(
    model: Model,
    gain: Array,
    at_rest: Array,
    links: tuple[NDArray[np.bool_], list[Array]],
    theta: Array,
    determined: NDArray[np.bool_],
) -> dict[int, float]:
    """By coordinate, what the weight there is of that of the nominal links, where it is notable."""
    of_links, own = links
    nominal = np.sum(own, axis=0)
    described, seen = (at_rest[:, :, of_links] @ x[of_links] for x in (nominal, theta))
    lost = np.asarray(at_rest[:, :, of_links & ~determined].any(axis=(0, 2)))
    power = ((described * gain) ** 2).mean(axis=0)
    notable = np.maximum(power, ((seen * gain) ** 2).mean(axis=0))
    asked = ~lost & (notable > NOTABLE**2 * notable.max()) & (power > 0.0)
    return {
        int(j): float(described[:, j] @ seen[:, j] / (described[:, j] @ described[:, j]))
        for j in np.flatnonzero(asked)
    }
