"""What a figure was before somebody rounded it, and how a figure is written.

URDF has 1.5708 and 1.57 where a right angle is meant, and exporters leave 1e-11 m where zero is. A right
angle costs nothing in the generated code, 1.5708 does.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

ANGLE_NEAR = 1e-6  # rad; nearer than that to a part of pi an angle is that part
LENGTH_NEAR = 1e-6  # m; nearer than that to zero a length is zero
NOISE = 1e-11  # of arithmetic, rad or m: below, nothing is worth a remark
PART = math.pi / 12  # 15 degrees, and its multiples
_QUARTER = math.pi / 2
_COARSE = 2  # decimals at which a right angle may still be meant: 1.57
_FINE = 4  # the same of another multiple of 15 degrees: 0.7854


@dataclass
class Rounding:
    """What is made of rounded figures while a source is read. exact: they stay as they are.

    read: by the text of a figure, how far [rad] it was from what it stands for.
    """

    exact: bool = False
    read: dict[str, float] = field(default_factory=dict)

    def angle(self, token: str, value: float) -> float:
        """The angle [rad] that `token`, with the value `value`, stands for."""
        if self.exact:
            return value
        meant = _angle_of(token, value)
        if abs(meant - value) > NOISE:
            self.read[token] = abs(meant - value)
        return meant

    def remarks(self) -> list[str]:
        """What the user must know of it."""
        if not self.read:
            return []
        shown = ", ".join(sorted(self.read, key=lambda token: -self.read[token])[:4])
        return [
            f"rounded angles are read as multiples of 15 deg, {max(self.read.values()):.1e} rad off at "
            f"most ({shown}{', …' if len(self.read) > 4 else ''}); --exact keeps them"
        ]


def _angle_of(token: str, value: float) -> float:
    """The multiple of 15 degrees of which `token` is the rounded text, `value` where there is none."""
    mantissa = token.lower().partition("e")[0]
    if mantissa != token.lower():
        return value
    decimals = len(mantissa.partition(".")[2])
    for part, least in ((_QUARTER, _COARSE), (PART, _FINE)):
        multiple = part * round(value / part)
        # rounded or cut after its decimals: one unit of the last
        if decimals >= least and multiple and abs(value - multiple) < 10.0**-decimals:
            return multiple
    return value


def near_angle(value: float, within: float) -> float:
    """The multiple of 15 degrees within `within` [rad] of `value`, else `value`."""
    multiple = PART * round(value / PART)
    return multiple if abs(value - multiple) <= within else value


def near_zero(value: float, within: float) -> float:
    """Zero where `value` is within `within` of it."""
    return 0.0 if abs(value) <= within else value


def shortest(value: float, within: float = 1e-13) -> str:
    """The number with the fewest digits within `within`, relative above 1."""
    room = within * max(1.0, abs(value))
    if abs(value) <= room:
        return "0"
    for digits in range(1, 18):
        text = f"{value:.{digits}g}"
        if abs(float(text) - value) <= room:
            break
    return _plain(text)


def precise(value: float) -> str:
    """The number with the fewest digits within 1e-13 of its size."""
    return shortest(value, 1e-13 * abs(value) / max(1.0, abs(value)))


def written_angle(value: float) -> str:
    """An angle [rad] as people write it: a fraction of pi, whole degrees, or radians."""
    twelfths = round(value / PART)
    if abs(value - twelfths * PART) <= 1e-14 * max(1, abs(twelfths)):
        return _fraction(twelfths)
    degrees = value * 180 / math.pi
    text = shortest(degrees, 1e-12)
    if len(text.lstrip("-").replace(".", "")) <= 5 and "e" not in text:
        return f"{text} deg"
    return shortest(value)


def _fraction(twelfths: int) -> str:
    if twelfths == 0:
        return "0"
    divisor = math.gcd(twelfths, 12)
    top, below = abs(twelfths) // divisor, 12 // divisor
    sign = "-" if twelfths < 0 else ""
    head = "pi" if top == 1 else f"{top}*pi"
    return f"{sign}{head}" if below == 1 else f"{sign}{head}/{below}"


def _plain(text: str) -> str:
    """1e-05 as YAML and people take it: 1.0e-5."""
    if "e" not in text:
        return text
    mantissa, _, exponent = text.partition("e")
    power = int(exponent)
    if -4 <= power < 0 or 0 <= power < 7:
        decimals = max(0, len(mantissa.partition(".")[2]) - power)
        return f"{float(text):.{decimals}f}"
    return f"{mantissa if '.' in mantissa else mantissa + '.0'}e{power}"
