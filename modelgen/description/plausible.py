"""Numbers without a unit that look as if they were in another one are asked about."""

from __future__ import annotations

import math
from collections.abc import Sequence

from modelgen.description.context import Context
from modelgen.description.document import Steps

MOST = {"angle": 2 * math.pi, "range": 4 * math.pi, "length": 30.0}  # rad, rad, m
MOST_GRAVITY = 50.0  # m/s^2, twice that of Jupiter
_ASKED = {
    "angle": 'is it in degrees? Write "{0} deg", or "{0} rad" where it is not',
    "range": 'is it in degrees? Write "{0} deg", or "{0} rad" where it is not',
    "length": 'is it in millimetres? Write "{0} mm", or "{0} m" where it is not',
}


def ask_unit(context: Context, raw: float | str, kind: str, steps: Steps) -> None:
    """A plain number must be of a size that its unit makes likely; one with its unit is believed.

    kind: "angle" [rad] of a frame, "range" [rad] of a joint, or "length" [m]. Raises InputError.
    """
    if not isinstance(raw, str) and abs(raw) > MOST[kind]:
        unit = "m" if kind == "length" else "rad"
        raise context.error(f"found {raw:g} {unit}: {_ASKED[kind].format(f'{raw:g}')}", steps)


def ask_gravity(context: Context, gravity: Sequence[float], steps: Steps) -> None:
    """Gravity of a planet, in m/s^2; a note where it points along +z. Raises InputError."""
    size = math.sqrt(sum(x * x for x in gravity))
    if size > MOST_GRAVITY:
        raise context.error(f"found {size:g} m/s^2: is it in mm/s^2 or cm/s^2? Expected m/s^2", steps)
    if gravity[2] > 0.5 * size > 0.0:
        context.notes.append(
            f"gravity points along +z of the base frame, {gravity[2]:g} m/s^2: does that axis point down? "
            f"Where it points up, gravity is [0, 0, -{size:g}]"
        )
