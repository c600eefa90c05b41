"""How far measured inputs are from those of a model, along records that were not fitted."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.signal import lfilter

from modelgen.backends import NumpyFunction
from modelgen.dataset import Prepared
from modelgen.evaluation import Evaluator
from modelgen.functions import EVALUATED, Model, Options, build_model
from modelgen.functions.options import prepared as reduced
from modelgen.identification.objects import Identification
from modelgen.identification.validation import regression_of
from modelgen.numeric import Array
from modelgen.options.noise import BANDWIDTH, SETTLED, Noise

UNCORRELATED = 0.05  # of the variance: where the sum of an autocorrelation ends
OF_STEP = {"q", "dq", "input", "dt", "gain", "parameters", "state"}  # what the observer reads of most arms


def with_noise(
    found: Identification, options: Options, test: Sequence[Prepared], payload: bool
) -> Identification:
    """With the noise of the test records, where nothing else is carried in them."""
    if found.test is None or payload or options.gains == "row_wise":
        return found
    theta = np.array([e.value for e in found.estimates])
    noise = noise_of(found.model, Evaluator(reduced(found.arm, options)), test, theta)
    return replace(found, test=replace(found.test, noise=noise))


def noise_of(model: Model, evaluator: Evaluator, records: Sequence[Prepared], theta: Array) -> Noise | None:
    """Errors of the model with the base parameters theta (p,); None where there is no observer to try."""
    external = outside(model, records, theta)
    if external is None:
        return None
    regression = regression_of(evaluator, model, records, theta, all_samples=True)
    residuals = regression.residuals(theta)
    n = residuals[0].shape[1]
    step = float(np.median(np.diff(records[0].t)))
    rms, correlation = [], []
    for j in range(n):
        moving = regression.moving
        flags = [m[:, j] if any(m[:, j].any() for m in moving) else np.ones(len(m), bool) for m in moving]
        parts = [np.where(m, e[:, j], 0.0) for e, m in zip(residuals, flags, strict=True)]
        power = sum(float(e @ e) for e in parts)
        rms.append(float(np.sqrt(power / max(1, sum(int(m.sum()) for m in flags)))))
        correlation.append(step * _correlated(parts, power))
    settings, every = records[0].settings, np.concatenate(external)
    return Noise(
        tuple(rms),
        tuple(correlation),
        tuple(float(gate) for gate in settings.rest_speeds),
        tuple(float(x) for x in np.sqrt(np.mean(every**2, axis=0))),
        tuple(float(x) for x in np.abs(every).max(axis=0)),
        gain_of(records),
        len(every) * records[0].record.step,
    )


def gain_of(records: Sequence[Prepared]) -> float:
    """Gain of the observer [1/s]: within the bandwidth of the records, and of their samples."""
    cutoff = records[0].settings.cutoff or BANDWIDTH / records[0].record.step
    return float(min(2 * np.pi * BANDWIDTH * cutoff, 0.1 / records[0].record.step))


def outside(model: Model, records: Sequence[Prepared], theta: Array) -> list[Array] | None:
    """What the momentum observer gives along records on which nothing acts from outside: by record (N, n),
    once it has settled; None of an arm that has none, or none that these inputs suffice for.

    Speeds are those of the log, where it has any: their errors count as they do beside a controller.
    """
    watched = build_model(replace(model.arm, monitor=()), replace(EVALUATED, watch=True))
    found = [f for f in watched.functions if f.name == "momentum_observer_step"]
    if (
        not found
        or not {a.name for a in found[0].arguments} <= OF_STEP
        or len(theta) != len(model.grouping.base)
    ):
        return None
    observer, gain = NumpyFunction(found[0]), gain_of(records)
    results = []
    for p in records:
        if p.input is None:
            return None
        dq = p.dq if p.record.dq is None else p.record.dq
        zero = np.zeros(p.n)
        # Without a state the momentum, without a gain the force: the rest of a step is a filter.
        momentum = observer(p.q, dq, p.input, [0.0], zero + 1.0, theta, zero)[1]
        force = observer(p.q, dq, p.input, [1.0], zero, theta, zero)[0]
        step = p.record.step
        change = np.diff(momentum, axis=0, prepend=momentum[:1])
        change[1:] -= step * force[:-1]
        # The ends are no motion of the arm's: filters run out there.
        first, last = int(p.rows[0]), int(p.rows[-1]) + 1
        change[: first + 1] = 0.0
        external = lfilter([gain], [1.0, gain * step - 1.0], change, axis=0)[first:last]
        begun = round(SETTLED / gain / step)
        results.append(np.asarray(external[begun if begun < len(external) // 2 else 0 :]))
    return results


def _correlated(parts: Sequence[Array], power: float) -> float:
    """Rows that go together: 1 + 2 (sum of the autocorrelation), up to where it is lost."""
    total = 1.0
    for lag in range(1, max(len(e) for e in parts) // 2):
        share = sum(float(e[lag:] @ e[:-lag]) for e in parts if len(e) > lag) / max(power, 1e-300)
        if share < UNCORRELATED:
            break
        total += 2.0 * share
    return total
