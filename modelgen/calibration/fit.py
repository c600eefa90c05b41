"""Least squares of a lever's geometry; what the angles leave open comes from the lengths as measured.

The joint angle is a function of three combinations of the four lengths (their common scale leaves it as it
is) and of the offset. The lengths of the description, known to a few millimetres, enter as a Gaussian prior
(Beck and Arnold 1977, chapter 6); what the angles say outweighs it by far wherever they say anything.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy import special
from scipy.optimize import least_squares

from modelgen.calibration.lever import NAMES, UNITS, Lever
from modelgen.dataset.recorded import Recorded
from modelgen.errors import InputError
from modelgen.numeric import Array

LEAST_SAMPLES = 20
_ROUNDS = 8  # of fit and residual variance
_FAR = 6.0  # standard deviations of the prior
_SIGNIFICANCE = 1e-3  # of the test that the lever as described explains the angles
_STEP = 1e-4  # of the stroke, for central differences: far above rounding, far below the lever's bend
_OFFSET_PRIOR = 2 * np.pi  # [rad]: the offset is free


@dataclass(frozen=True)
class Estimate:
    """One value before and after, and the standard deviation of the latter."""

    name: str
    before: float
    value: float
    std: float
    unit: str


@dataclass(frozen=True)
class Calibration:
    """Result of a calibration.

    before, after: the lever as described and as found. rms: of the angle errors [rad]; `shifted` is that of
    the lever as described with the best constant added. candidates: rev to rms. correlation: samples
    that count as one, since their residuals hang together. weak: combinations that the angles tell less of
    than the lengths as measured do, in words. motor, measured: (N,) the data. record: the log that they are
    from. angle_std: (N,) [rad], of the angle by the lever as found; effort_std: (N,), of the joint's effort
    per current, as a share of it. Both are by what the values leave open together.
    """

    joint: int
    before: Lever
    after: Lever
    rms_before: float
    rms_shifted: float
    rms_after: float
    candidates: dict[int, float]
    estimates: tuple[Estimate, ...]
    correlation: float
    weak: tuple[str, ...]
    motor: Array
    measured: Array
    angle_std: Array
    effort_std: Array
    record: Recorded | None = None

    @property
    def agrees(self) -> bool:
        """Whether the lever as described explains the angles as well as the one found, all values together.

        By the ratio of likelihoods of as many samples as are independent (Wilks 1938).
        """
        gained = len(self.motor) / self.correlation * ((self.rms_before / self.rms_after) ** 2 - 1.0)
        return self.before.rev == self.after.rev and bool(gained <= special.chdtri(len(NAMES), _SIGNIFICANCE))

    @property
    def improvement_percent(self) -> float:
        """Improvement of the RMS error in percent."""
        return 100 * (1 - self.rms_after / self.rms_before) if self.rms_before > 0 else 0.0


def calibrate(lever: Lever, joint: int, motor: Array, measured: Array, length_std: float) -> Calibration:
    """The lever that explains `measured` angles (N,) [rad] at `motor` coordinates (N,).

    length_std [m]: how well the four lengths of the description are known. Both branches (rev) are tried.
    Raises InputError for data that determine nothing.
    """
    _check(lever, motor, measured)
    fits = {rev: _fit(replace(lever, rev=rev), motor, measured, length_std) for rev in (1, -1)}
    rms = {rev: _rms(fit, motor, measured) for rev, fit in fits.items()}
    rev = min(rms, key=lambda r: (rms[r], r != lever.rev))
    after = fits[rev]
    if rev == lever.rev:  # an angle is known up to whole turns
        turns = np.round((after.values[4] - lever.values[4]) / (2 * np.pi))
        kept = measured - 2 * np.pi * turns
        after = replace(after, values=after.values - np.array([0, 0, 0, 0, 2 * np.pi * turns]))
    else:
        kept = measured
    residuals = kept - after.angle(motor)
    if not np.isfinite(residuals).all():
        raise InputError(
            "no lever near the one described passes through these angles; expected the joint's own motor "
            "coordinate and lengths known to a few per cent"
        )
    inflation = _correlation(residuals)
    covariance, weak = _spread(after, motor, residuals, inflation, length_std)
    found = tuple(
        Estimate(name, float(a), float(b), float(s), unit)
        for name, a, b, s, unit in zip(
            NAMES, lever.values, after.values, np.sqrt(np.diag(covariance)), UNITS, strict=True
        )
    )
    raw = kept - lever.angle(motor)
    raw = raw[np.isfinite(raw)]
    shifted = float(np.std(raw)) if len(raw) else float("nan")
    before = float(np.sqrt(np.mean(raw**2))) if len(raw) else float("nan")
    return Calibration(
        joint,
        lever,
        after,
        before,
        shifted,
        _rms(after, motor, kept),
        rms,
        found,
        inflation,
        weak,
        motor,
        kept,
        *_meaning(after, motor, covariance),
    )


def _meaning(lever: Lever, motor: Array, covariance: Array) -> tuple[Array, Array]:
    """Standard deviations (N,) of the angle [rad] and, as a share, of the effort per current at the joint.

    The effort is the motor's over dq/dq_m, so that its share is that of this slope.
    """
    step = _STEP * (lever.motor[1] - lever.motor[0])
    inside = np.clip(motor, min(lever.motor) + abs(step), max(lever.motor) - abs(step))
    columns = lever.jacobian(inside)
    slope = (lever.continued(inside + step) - lever.continued(inside - step)) / (2.0 * step)
    bend = (lever.jacobian(inside + step) - lever.jacobian(inside - step)) / (2.0 * step)
    angle, share = (np.sqrt(np.einsum("ni,ij,nj->n", x, covariance, x).clip(0.0)) for x in (columns, bend))
    return angle, share / np.maximum(np.abs(slope), 1e-300)


def _check(lever: Lever, motor: Array, measured: Array) -> None:
    if len(motor) < LEAST_SAMPLES:
        raise InputError(f"the log has {len(motor)} samples, expected at least {LEAST_SAMPLES}")
    if not (np.isfinite(motor).all() and np.isfinite(measured).all()):
        raise InputError("the log has cells that are not finite, expected numbers everywhere")
    share = lever.share(motor)
    if share.min() < -0.05 or share.max() > 1.05:
        low, high = lever.motor
        raise InputError(
            f"motor coordinates from {motor.min():g} to {motor.max():g}, expected {low:g} to {high:g}: "
            "the log is of another joint, or counts from another zero"
        )
    if np.ptp(share) < 0.1:
        raise InputError(
            f"the motion covers {100 * np.ptp(share):.1f} % of the stroke, expected at least 10 %: "
            "move the joint through its range"
        )
    if np.abs(measured - measured.mean()).max() > 2 * np.pi:
        raise InputError("joint angles spread over more than a turn, expected rad (not degrees)")


def _fit(lever: Lever, motor: Array, measured: Array, length_std: float) -> Lever:
    """Maximum a posteriori, the residuals' variance found with it."""
    prior = np.array([length_std] * 4 + [_OFFSET_PRIOR])
    mean = lever.values.copy()
    mean[4] += np.mean(measured - lever.continued(motor))
    # Within six deviations of what is known, and no length below a tenth of it: past that lie mirror images.
    far = np.full(5, -_FAR)
    low = np.maximum(far, np.append(-0.9 * mean[:4] / prior[:4], -_FAR))
    values, sigma = mean.copy(), 0.1

    def at(x: Array) -> Lever:
        return replace(lever, values=mean + prior * x)

    for _ in range(_ROUNDS):

        def residuals(x: Array, sigma: float = sigma) -> Array:
            return np.concatenate([(at(x).continued(motor) - measured) / sigma, x])

        def slopes(x: Array, sigma: float = sigma) -> Array:
            return np.vstack([at(x).jacobian(motor) * prior / sigma, np.eye(5)])

        start = np.clip((values - mean) / prior, low + 1e-6, -far - 1e-6)
        step = least_squares(
            residuals, start, slopes, bounds=(low, -far), x_scale="jac", xtol=1e-12, ftol=1e-12, gtol=1e-12
        )
        values = mean + prior * step.x
        now = max(_rms(replace(lever, values=values), motor, measured), 1e-7)
        if abs(now - sigma) < 1e-6 * sigma:
            break
        sigma = now
    return replace(lever, values=values)


def _rms(lever: Lever, motor: Array, measured: Array) -> float:
    error = measured - lever.angle(motor)
    error = np.where(np.isfinite(error), error, np.pi)
    return float(np.sqrt(np.mean(error**2)))


def _correlation(residuals: Array) -> float:
    """1 + 2 sum of autocorrelations up to the first that is not positive (Geyer 1992)."""
    e = residuals - residuals.mean()
    power = float(e @ e)
    if power == 0:
        return 1.0
    total = 1.0
    for lag in range(1, len(e) // 4):
        r = float(e[lag:] @ e[:-lag]) / power
        if r <= 2 / np.sqrt(len(e)):
            break
        total += 2 * r
    return total


def _spread(
    lever: Lever, motor: Array, residuals: Array, inflation: float, length_std: float
) -> tuple[Array, tuple[str, ...]]:
    """Covariance (5, 5) of the values, and the combinations that the prior rather than the angles decides."""
    prior = np.array([length_std] * 4 + [_OFFSET_PRIOR])
    variance = max(float(residuals @ residuals) / max(len(motor) - 4, 1), 1e-14) * inflation
    jacobian = lever.jacobian(motor) * prior / np.sqrt(variance)
    _, singular, directions = np.linalg.svd(jacobian, full_matrices=False)
    # In units of the prior: angles alone leave 1 / singular, both together 1 / sqrt(1 + singular^2).
    covariance = (directions.T / (1 + singular**2)) @ directions * np.outer(prior, prior)
    weak = []
    for s, direction in zip(singular, directions, strict=True):
        if s < 1:
            weak.append(_words(lever, direction * prior, s < 1e-6 * singular[0]))
    return covariance, tuple(weak)


def _words(lever: Lever, direction: Array, never: bool) -> str:
    """Write a combination (5,) of values that the angles leave open."""
    relative = direction[:4] / lever.values[:4]
    if abs(direction[4]) < 1e-6 and np.ptp(relative) < 1e-4 * np.abs(relative).max():
        return (
            "the common scale of l1, l2, qp_min and qp_max: no measurement of angles tells it, "
            "the lengths of the description do"
        )
    unit = direction[:4] / np.abs(direction[:4]).max()
    parts = [f"{x:+.2f} mm of {name}" for x, name in zip(unit, NAMES[:4], strict=True) if abs(x) >= 0.005]
    parts.append(f"{np.degrees(direction[4] / np.abs(direction[:4]).max()) * 1e-3:+.3f} deg of offset")
    how = "no angle tells it" if never else "these angles tell less of it than the lengths as measured"
    return f"{', '.join(parts)} together: {how}"
