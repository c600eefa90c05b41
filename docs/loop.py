"""The picture of the first pages: from the arm to its log, to the cause of the error, to the code, and back.

    python docs/loop.py     writes docs/loop.svg anew

The curve of the log is the current of the stick in examples/diagnosis, the law that of the friction hidden
there; the rest is a sketch. The picture stands on a ground of its own, with colours for the day and for the
night. Same files, same bytes.
"""

from __future__ import annotations

import csv
import math
from collections.abc import Iterable
from html import escape
from pathlib import Path

HERE = Path(__file__).resolve().parent
LOG = HERE.parent / "examples" / "diagnosis" / "test.csv"
WIDTH, HEIGHT = 664, 392
BOX = (264, 150)  # width and height of a station
AT = {"arm": (14, 14), "log": (386, 14), "cause": (386, 228), "code": (14, 228)}
INK, SOFT, BLUE, ORANGE, GROUND = "#1b1f24", "#59636e", "#1f5fa8", "#b3500e", "#ffffff"
SHEET, EDGE, GREEN, PIVOT = "#f3f5f7", "#c8d0d8", "#3a8f4d", "#f0a04b"
# Where the reader's system is dark, a style replaces each by the second.
NIGHT = {
    INK: "#e6ebef",
    SOFT: "#a4afb9",
    BLUE: "#6fb0f0",
    ORANGE: "#ffb07a",
    GROUND: "#14191e",
    SHEET: "#20272e",
    EDGE: "#3a444d",
    GREEN: "#5fbf75",
}
FONT = "font-family='Helvetica, Arial, sans-serif'"


def picture() -> str:
    """The picture as SVG."""
    parts = [
        f"<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {WIDTH} {HEIGHT}' role='img' "
        "aria-labelledby='title text'>",
        "<title id='title'>The loop of modelgen</title>",
        "<desc id='text'>An arm is moved and recorded. The log shows what its model gets wrong. "
        "The diagnosis names the physical cause. Its code goes into the controller of the arm.</desc>",
        f"<style>@media (prefers-color-scheme: dark) {{ {_night()} }}</style>",
        "<defs><marker id='tip' viewBox='0 0 8 8' refX='7' refY='4' markerWidth='7' markerHeight='7' "
        f"orient='auto'><path d='M0 0 8 4 0 8Z' fill='{BLUE}'/></marker></defs>",
        f"<rect width='{WIDTH}' height='{HEIGHT}' rx='10' fill='{SHEET}'/>",
    ]
    for name, (x, y) in AT.items():
        parts.append(
            f"<rect x='{x}' y='{y}' width='{BOX[0]}' height='{BOX[1]}' rx='8' fill='{GROUND}' "
            f"stroke='{EDGE}'/>"
        )
        parts.append(_text(x + 14, y + 26, name, size=19, weight="bold"))
    parts += [*_arm(), *_log(), *_cause(), *_code(), *_arrows(), "</svg>"]
    return "\n".join(parts) + "\n"


def _night() -> str:
    """Rules that put the colours of the night in place of those of the day."""
    kinds = ("fill", "stroke")
    return " ".join(
        f"[{kind}='{day}'] {{ {kind}: {night}; }}" for day, night in NIGHT.items() for kind in kinds
    )


def _arm() -> Iterable[str]:
    """A boom and a stick, each turned by a linear actuator on a lever."""
    x, y = AT["arm"]
    base, elbow, tip = (x + 64, y + 122), (x + 138, y + 54), (x + 226, y + 98)
    yield f"<path d='M{base[0] - 34} {base[1] + 10}h68' stroke='{SOFT}' stroke-width='3'/>"
    yield _path([(base[0] + 34, base[1] + 6), (x + 116, y + 76)], GREEN, 6)
    yield _path([(x + 92, y + 80), (elbow[0] - 8, elbow[1] - 22), (elbow[0] + 26, elbow[1] + 13)], GREEN, 5)
    yield _path([base, elbow, tip], INK, 8)
    for cx, cy in (base, elbow):
        yield f"<circle cx='{cx}' cy='{cy}' r='8' fill='{PIVOT}' stroke='{INK}' stroke-width='2'/>"
    yield _text(x + BOX[0] - 14, y + 26, "arms.yaml", size=15, colour=SOFT, anchor="end", mono=True)


def _log() -> Iterable[str]:
    """The stick's current over a period of the record."""
    x, y = AT["log"]
    with LOG.open(encoding="utf-8", newline="") as file:
        rows = [(float(r["t"]), float(r["i2"])) for r in csv.DictReader(file)]
    rows = [r for r in rows if r[0] < 10.0][::10]
    low, high = min(i for _, i in rows), max(i for _, i in rows)
    left, top, width, height = x + 16, y + 44, BOX[0] - 32, 84
    yield f"<path d='M{left} {top}v{height}h{width}' stroke='{SOFT}' fill='none'/>"
    points = [(left + t / 10.0 * width, top + height * (high - i) / (high - low)) for t, i in rows]
    yield _path(points, BLUE, 1.5)
    yield _text(x + BOX[0] - 14, y + 26, "current of the stick", size=15, colour=SOFT, anchor="end")
    yield _text(x + BOX[0] - 16, y + 144, "time", size=13, colour=SOFT, anchor="end")


def _cause() -> Iterable[str]:
    """Friction that grows with the load, as a law over the load."""
    x, y = AT["cause"]
    left, bottom, width = x + 16, y + 120, 112
    yield f"<path d='M{left} {y + 44}V{bottom}h{width}' stroke='{SOFT}' fill='none'/>"
    yield _path([(left, bottom - 18), (left + width, bottom - 18)], SOFT, 2, dashed=True)
    yield _path([(left, bottom - 18), (left + width, bottom - 68)], ORANGE, 3)
    for k in range(9):  # the scatter of a measurement, the same every time
        u = (k + 0.5) / 9
        v = bottom - 18 - 50 * u + 6 * math.sin(7.3 * k + 1.0)
        yield f"<circle cx='{left + u * width:.1f}' cy='{v:.1f}' r='2.6' fill='{BLUE}'/>"
    yield _text(left + width, y + 140, "load", size=13, colour=SOFT, anchor="end")
    yield _text(left + 6, y + 56, "friction", size=13, colour=SOFT)
    for k, line in enumerate(("Friction in the", "stick's drive", "grows with", "the load.")):
        yield _text(x + 142, y + 58 + 21 * k, line, size=17)


def _code() -> Iterable[str]:
    """What the controller calls."""
    x, y = AT["code"]
    lines = ("digger_inverse_dynamics_", "  identified(q, dq, ddq,", "             current);")
    for k, line in enumerate(lines):
        yield _text(x + 14, y + 62 + 23 * k, line, size=16, mono=True)
    yield _text(x + BOX[0] - 14, y + 26, "C99, CasADi", size=15, colour=SOFT, anchor="end")


def _arrows() -> Iterable[str]:
    """From station to station, each with what leads there."""
    right, left = AT["arm"][0] + BOX[0], AT["log"][0]
    low, high = AT["arm"][1] + BOX[1], AT["cause"][1]
    upper, lower = AT["arm"][1] + 84, AT["cause"][1] + 84
    middle = (right + left) / 2
    yield _arrow(right + 6, upper, left - 6, upper)
    yield _text(middle, upper - 12, "excite", size=16, anchor="middle", colour=BLUE, mono=True)
    yield _text(middle, upper + 24, "and record", size=15, anchor="middle", colour=BLUE)
    down = AT["log"][0] + 60
    yield _arrow(down, low + 6, down, high - 6)
    yield _text(down + 14, (low + high) / 2 + 6, "diagnose", size=16, colour=BLUE, mono=True)
    yield _arrow(left - 6, lower, right + 6, lower)
    yield _text(middle, lower - 12, "generate", size=16, anchor="middle", colour=BLUE, mono=True)
    up = AT["arm"][0] + 60
    yield _arrow(up, high - 6, up, low + 6)
    yield _text(up + 14, (low + high) / 2 + 6, "into the controller", size=15, colour=BLUE)


def _path(points: Iterable[tuple[float, float]], colour: str, width: float, *, dashed: bool = False) -> str:
    along = " ".join(f"{a:.1f},{b:.1f}" for a, b in points)
    dashes = " stroke-dasharray='5 4'" if dashed else ""
    return (
        f"<polyline points='{along}' fill='none' stroke='{colour}' stroke-width='{width:g}' "
        f"stroke-linejoin='round' stroke-linecap='round'{dashes}/>"
    )


def _arrow(x0: float, y0: float, x1: float, y1: float) -> str:
    return (
        f"<path d='M{x0:g} {y0:g}L{x1:g} {y1:g}' stroke='{BLUE}' stroke-width='2.5' marker-end='url(#tip)'/>"
    )


def _text(
    x: float,
    y: float,
    text: str,
    *,
    size: float,
    colour: str = INK,
    weight: str = "normal",
    anchor: str = "start",
    mono: bool = False,
) -> str:
    font = "font-family='Menlo, Consolas, monospace'" if mono else FONT
    return (
        f"<text x='{x:g}' y='{y:g}' {font} font-size='{size:g}' font-weight='{weight}' fill='{colour}' "
        f"text-anchor='{anchor}' xml:space='preserve'>{escape(text)}</text>"
    )


if __name__ == "__main__":
    (HERE / "loop.svg").write_text(picture(), encoding="utf-8")
