"""Round numbers along an axis."""

from __future__ import annotations

import math
from collections.abc import Sequence

_LEAST = 3  # ticks of an axis
_WIDER = 2.0  # than asked for a step may be
_DIGIT = 7.0  # px, of a digit at the most
_MOST = 9  # digits of one of two numbers that hardly differ
_LARGE, _SMALL = 1e5, 1e-4  # beyond which numbers are written with an exponent


def ticks(low: float, high: float, about: int) -> list[float]:
    """Multiples of 1, 2 or 5 times a power of ten within [low, high]: about that many, three at least."""
    rough = (high - low) / max(about, 1)
    power = 10.0 ** math.floor(math.log10(rough))
    found: list[float] = []
    for step in (m * power for m in (10.0, 5.0, 2.0, 1.0, 0.5)):
        first, last = math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9)
        found = [k * step for k in range(first, last + 1)]
        if len(found) >= _LEAST and step <= rough * _WIDER:
            break
    return found


def written(values: list[float]) -> list[str]:
    """Numbers of one axis with as many digits as tell them apart."""
    if len(values) < 2:
        return [f"{v:.3g}" for v in values]
    step, most = values[1] - values[0], max(map(abs, values))
    if most >= 100 * _LARGE or most < 10 * _SMALL:
        return [f"{0.0 if abs(v) < 0.5 * step else v:.3g}" for v in values]
    digits = max(0, -math.floor(math.log10(step) + 1e-9))
    return [f"{0.0 if abs(v) < 0.5 * step else v:.{digits}f}" for v in values]


def anchored(at: float, word: str, width: float) -> str:
    """Attributes x and text-anchor of a number under its tick, inside a picture of this width [px]."""
    half = 0.5 * _DIGIT * len(word)
    if at + half > width:
        return f'x="{width:g}" text-anchor="end"'
    return 'x="0" text-anchor="start"' if at < half else f'x="{at:.1f}" text-anchor="middle"'


def sized(value: float, unit: str, digits: int = 3) -> str:
    """A number with its unit; that of a ratio is not written."""
    return f"{number(value, digits)} {'' if unit == '1' else unit}".rstrip()


def at_joints(names: Sequence[str], figures: Sequence[str]) -> str:
    """Figures in words, each at its joint; said once where all joints have the same."""
    if len(set(figures)) == 1:
        return f"{figures[0]} at {'every joint' if len(figures) > 1 else names[0]}"
    return ", ".join(f"{figure} at {name}" for name, figure in zip(names, figures, strict=True))


def apart(before: float, after: float, digits: int = 3) -> tuple[str, str]:
    """Two numbers in a row with that many digits, or with as many more as tell them apart."""
    for more in range(digits, _MOST + 1):
        texts = number(before, more), number(after, more)
        if texts[0] != texts[1]:
            return texts
    return number(before, digits), number(after, digits)


def number(value: float, digits: int = 3) -> str:
    """A number in a sentence: significant digits, no exponent where that can be read without."""
    if value == 0.0 or not math.isfinite(value):
        return f"{value:zg}"
    if not _SMALL <= abs(value) < _LARGE:
        return f"{value:.{digits}g}"
    return f"{value:.{max(0, digits - 1 - math.floor(math.log10(abs(value))))}f}"


def known(value: float, std: float | None, digits: int = 5) -> str:
    """A number down to the second digit of its standard deviation, where that is known; at most `digits`."""
    if not std or not math.isfinite(std) or value == 0.0 or not math.isfinite(value):
        return number(value, digits)
    figures = math.floor(math.log10(abs(value))) - math.floor(math.log10(std)) + 2
    return number(value, min(max(figures, 1), digits))


def in_percent(share: float) -> str:
    """A share in percent; of more than a thousand none has a use for the digits."""
    return f"{share:z.1f}" if share <= 1000.0 else "> 1000"
