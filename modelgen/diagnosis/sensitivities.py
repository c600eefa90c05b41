"""Columns of effects in which nothing is linear: how the inputs change with their parameters, by differences.

A slope is right for small values. A delay of a quarter of the fastest period, or a tilt that turns heavy
links, is beyond that: its column is then the whole change over the value, a secant.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from modelgen.numeric import Array
from modelgen.probing import Motion, Prober

# The step over which slopes are taken, by parameter.
STEPS: Mapping[str, Mapping[str, float]] = {
    "encoder_offset": {"offset": 1e-4},
    "base_tilt": {"x": 1e-4, "y": 1e-4, "z": 1e-4},
    "lever_geometry": {"l1": 1e-6, "l2": 1e-6, "length": 1e-6},
    "drive_gain_error": {"error": 1e-4},
    "torque_constant_saturation": {"coefficient": 1e-8},
    "time_delay": {"delay": 1e-4},
}
FORWARD = "torque_constant_saturation"  # not negative
INVISIBLE = 1e-5  # of the largest column


def sensitivities(
    effect: str,
    joint: int | None,
    motion: Motion,
    prober: Prober,
    base: Array,
    names: Sequence[str],
    around: Mapping[str, float],
) -> Array:
    """Changes of the inputs (N, n, k) with the named parameters of the effect, per unit.

    around: values by name; where one is given, and is more than the step of a slope, the column is what that
    value alone changes, over it. Raises InputError where the arm does not admit it.
    """
    parts = []
    for name in names:
        step, value = STEPS[effect][name], around.get(name, 0.0)
        if abs(value) > step:
            parts.append(prober.contribution(effect, joint, motion, {name: value}, base) / value)
            continue
        ahead = prober.contribution(effect, joint, motion, {name: step}, base)
        if effect == FORWARD:
            parts.append(ahead / step)
        else:
            behind = prober.contribution(effect, joint, motion, {name: -step}, base)
            parts.append((ahead - behind) / (2 * step))
    together = np.stack(parts, axis=2)
    # what differences leave of an effect that does not show is no column
    sizes = np.abs(together).max(axis=(0, 1))
    return np.where(sizes > INVISIBLE * sizes.max(initial=0.0), together, 0.0)


def payload(
    joint: int | None, motion: Motion, prober: Prober, base: Array, around: Mapping[str, float]
) -> Array:
    """Changes of the inputs (N, n, 4) with mass and first moments of what the last link carries.

    around: mass and place of what was found; its second moments are as if it were all there. At the link's
    origin where there is none.
    """
    step = 1e-3
    place = {a: around.get(a, 0.0) if around.get("mass", 0.0) > 0 else 0.0 for a in "xyz"}

    def of(**moved: float) -> Array:
        return prober.contribution("payload_change", joint, motion, {"mass": 1.0, **place, **moved}, base)

    moments = []
    for a in "xyz":
        ahead, behind = (of(**{a: place[a] + d}) for d in (step, -step))
        moments.append((ahead - behind) / (2 * step))
    mass = of() - sum(place[a] * moment for a, moment in zip("xyz", moments, strict=True))
    return np.stack([mass, *moments], axis=2)
