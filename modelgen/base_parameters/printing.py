"""Groups in print: MX2 + d3*(M3 + M4)."""

from __future__ import annotations

from collections.abc import Sequence

import sympy as sp

from modelgen.description.objects import Scalar


def printed(terms: Sequence[tuple[str, Scalar]]) -> str:
    """The sum of factor times name, names of equal factor in one bracket; reads as Python."""
    groups: dict[str, list[tuple[str, str]]] = {}
    for name, factor in terms:
        sign, magnitude = _split(factor)
        groups.setdefault(magnitude, []).append((sign, name))
    text = ""
    for magnitude, members in groups.items():
        if magnitude == "1":
            for sign, name in members:
                text += _joined(text, sign, name)
            continue
        outer = members[0][0]
        inner = ""
        for sign, name in members:
            inner += _joined(inner, "+" if sign == outer else "-", name)
        if len(members) > 1:
            inner = f"({inner})"
        text += _joined(text, outer, f"{magnitude}*{inner}")
    return text


def for_reading(expression: str) -> str:
    """Write the combination with products set side by side: MX2 + d3 (M3 + M4)."""
    return expression.replace("**", "^").replace("*", " ")


def _joined(before: str, sign: str, what: str) -> str:
    if not before:
        return what if sign == "+" else f"-{what}"
    return f" {sign} {what}"


def _split(factor: Scalar) -> tuple[str, str]:
    """Sign and printed magnitude."""
    if isinstance(factor, sp.Expr):
        negative = factor.could_extract_minus_sign()
        magnitude = -factor if negative else factor
        text = str(_plain(magnitude))
        bracketed = isinstance(magnitude, sp.Add) or "/" in text
        return ("-" if negative else "+"), f"({text})" if bracketed else text
    return ("-" if factor < 0 else "+"), _shortest(abs(factor))


def _shortest(value: float) -> str:
    """The fewest digits, twelve at least, that say `value` to a few units in its last place."""
    for digits in (12, 14, 15, 16):
        text = f"{value:.{digits}g}"
        if abs(float(text) - value) <= 1e-15 * value:
            return text
    return f"{value:.17g}"


def _plain(expression: sp.Expr) -> sp.Expr:
    """Floats that are whole numbers as such."""
    whole = {f: sp.Integer(int(f)) for f in expression.atoms(sp.Float) if float(f).is_integer()}
    return expression.xreplace(whole)
