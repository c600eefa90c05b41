"""Pictures of the house, drawn from its imports: packages on their floors, and the stages of the diagnosis.

    PYTHONPATH=tests python -m architecture.picture     draw those of docs/architecture.md anew

The packages are too many to be described in their boxes: a table in the page does it, from their docstrings.
A box stands one floor above the highest that it imports. An arrow leads from a box to one that it imports;
what follows from other arrows is left out (transitive reduction). Single files on the first floor of the
whole, which nearly everything imports, are named in a line below. Same source, same bytes.
"""

from __future__ import annotations

import ast
import math
import textwrap
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from html import escape
from pathlib import Path

from architecture.house import NAME, ROOT, Graph, file_graph, files, floors, rooms

PAGE = ROOT / "docs" / "architecture.md"
TABLE = ("<!-- the table of packages: begin -->", "<!-- the table of packages: end -->")
PICTURES = {"architecture.svg": NAME, "diagnosis_stages.svg": f"{NAME}.diagnosis"}
ENTRY = "__main__"  # the two lines behind `python -m modelgen`
GAP, LANE = 14.0, 4.0  # between boxes, and the width of an arrow that passes a floor
HEIGHT, BETWEEN, MARGIN, LINE = 50.0, 36.0, 16.0, 13.0
LETTER, BOLD = 5.6, 8.6  # widest mean of a line, and of a name
NAME_HEIGHT = 27.0  # of a box that has a name alone
PORTS = 16.0, 10.0  # between arrows that leave a box, and that reach it, at most
SWEEPS, SETTLING = 40, 300  # of the order on the floors, and of the places
STRAIGHT = 6.0  # times as much a bend of an arrow counts where it passes a floor as where it meets a box
COLOURS = ("#1f5fa8", "#d1661a", "#3a8f4d", "#8a4fa3", "#a83a4a", "#2a8f8f", "#666666")
PAPER, SHEET, INK, TEXT = "#ffffff", "#f7f9fc", "#000000", "#333333"
# Where the reader's system is dark, a style puts these in the places of those.
NIGHT = {
    **dict(
        zip(
            COLOURS,
            ("#6fb0f0", "#ffb07a", "#5fbf75", "#c490dc", "#f08a98", "#5fc9c9", "#aab4bd"),
            strict=True,
        )
    ),
    PAPER: "#14191e",
    SHEET: "#20272e",
    INK: "#e6ebef",
    TEXT: "#c8d0d8",
}


@dataclass
class Node:
    """A box, or a place on a floor where an arrow passes. below: what it leads to on the next floor."""

    name: str
    floor: int
    width: float = LANE
    below: list[Node] = field(default_factory=list)
    above: list[Node] = field(default_factory=list)
    x: float = 0.0

    @property
    def is_box(self) -> bool:
        """Whether it is a room."""
        return self.width > LANE


def reduced(graph: Graph) -> Graph:
    """The arrows that do not follow from others; the graph must have no circle."""

    @cache
    def reached(node: str) -> frozenset[str]:
        return graph[node].union(*map(reached, graph[node]))

    return {
        name: frozenset(t for t in targets if not any(t in reached(other) for other in targets))
        for name, targets in graph.items()
    }


def layered(graph: Graph, widths: Mapping[str, float]) -> list[list[Node]]:
    """Nodes floor by floor, the lowest first; an arrow over several floors has a node on each between."""
    level = floors(graph)
    boxes = {name: Node(name, level[name], widths[name]) for name in sorted(graph)}
    result: list[list[Node]] = [[] for _ in range(max(level.values()))]
    for node in boxes.values():
        result[node.floor - 1].append(node)
    for name, targets in sorted(reduced(graph).items()):
        for target in sorted(targets):
            upper, end = boxes[name], boxes[target]
            for floor in range(upper.floor - 1, end.floor, -1):
                passing = Node(f"{name}>{target}", floor)
                result[floor - 1].append(passing)
                _join(upper, passing)
                upper = passing
            _join(upper, end)
    return result


def _join(upper: Node, lower: Node) -> None:
    upper.below.append(lower)
    lower.above.append(upper)


def arrange(layers: Sequence[list[Node]]) -> None:
    """Order on each floor by the neighbours' barycentres (Sugiyama 1981), then the places nearest to them."""
    for layer in layers:
        _place(layer, [0.0] * len(layer))
    for sweep in range(SWEEPS):
        downward = sweep % 2 == 0
        for layer in reversed(layers) if downward else layers:
            wanted = [_middle(n, n.above if downward else n.below) for n in layer]
            pairs = sorted(zip(wanted, layer, strict=True), key=lambda pair: (pair[0], pair[1].name))
            layer[:] = [node for _, node in pairs]
            _place(layer, [x for x, _ in pairs])
    for sweep in range(SETTLING):
        for layer in layers if sweep % 2 else reversed(layers):
            _place(layer, [_middle(n, [*n.above, *n.below]) for n in layer])
    left = min(n.x - n.width / 2 for layer in layers for n in layer)
    for node in (n for layer in layers for n in layer):
        node.x += MARGIN - left


def _middle(node: Node, others: Sequence[Node]) -> float:
    """Mean place of others, weighted by what a bend on the way to them costs."""
    weights = [_weight(node, other) for other in others]
    together = math.fsum(w * n.x for w, n in zip(weights, others, strict=True))
    return together / math.fsum(weights) if others else node.x


def _weight(one: Node, other: Node) -> float:
    return 1.0 if one.is_box or other.is_box else STRAIGHT


def _place(layer: Sequence[Node], wanted: Sequence[float]) -> None:
    """Places in this order without overlap, nearest to those that are wanted (isotonic regression)."""
    offsets, at = [], 0.0
    for k, node in enumerate(layer):
        at += (node.width + layer[k - 1].width) / 2 + GAP if k else 0.0
        offsets.append(at)
    blocks: list[tuple[float, float, int]] = []  # mean, weight, how many
    for node, x, offset in zip(layer, wanted, offsets, strict=True):
        weight = math.fsum(_weight(node, other) for other in (*node.above, *node.below))
        mean, count = x - offset, 1
        while blocks and blocks[-1][0] > mean:
            before, heavy, size = blocks.pop()
            mean = (mean * weight + before * heavy) / (weight + heavy)
            weight, count = weight + heavy, count + size
        blocks.append((mean, weight, count))
    means = [mean for mean, _, count in blocks for _ in range(count)]
    for node, mean, offset in zip(layer, means, offsets, strict=True):
        node.x = mean + offset


def described(package: str, room: str, modules: Mapping[str, Path]) -> tuple[str, list[str]]:
    """First sentence of a room's docstring, and the names of the files in it."""
    name = f"{package}.{room}"
    text = ast.get_docstring(ast.parse(modules[name].read_text(encoding="utf-8"))) or ""
    inside = [
        m[len(name) + 1 :]
        for m in modules
        if m.startswith(f"{name}.") and m.count(".") == name.count(".") + 1
    ]
    return text.split("\n", maxsplit=1)[0].rstrip(".").replace("`", ""), sorted(inside)


def boxed(package: str, root: Path) -> tuple[dict[str, frozenset[str]], set[str]]:
    """Rooms that have a box with what they import, and single files that nearly everything imports."""
    modules = files(root)
    graph = {k: v - {ENTRY} for k, v in rooms(package, file_graph(root)).items() if k != ENTRY}
    single = {
        k
        for k, v in graph.items()
        if package == NAME and not v and modules[f"{package}.{k}"].stem != "__init__"
    }
    return {k: v - single for k, v in graph.items() if k not in single}, single


def packages(root: Path = ROOT) -> str:
    """The packages and what each is for, from the top floor down, as a table in Markdown."""
    graph, _ = boxed(NAME, root)
    level, modules = floors(graph), files(root)
    rows = [
        f"| `{name}` | {described(NAME, name, modules)[0]} |"
        for name in sorted(graph, key=lambda name: (-level[name], name))
    ]
    return "\n".join(["| package | what it is |", "|---|---|", *rows])


def tabled(page: str, table: str) -> str:
    """A page with the table between its marks."""
    before, rest = page.split(TABLE[0])
    after = rest.split(TABLE[1])[1]
    return f"{before}{TABLE[0]}\n\n{table}\n\n{TABLE[1]}{after}"


def drawn(package: str, root: Path = ROOT) -> str:
    """The picture of a package's rooms as SVG."""
    modules, whole = files(root), package == NAME
    graph, single = boxed(package, root)
    layers = layered(graph, {name: BOLD * len(name) + 12.0 if whole else 350.0 for name in graph})
    arrange(layers)
    lines: dict[str, list[tuple[str, str]]] = {name: [] for name in graph}
    for node in (n for row in layers for n in row if n.is_box and not whole):
        text, inside = described(package, node.name, modules)
        letters = int((node.width - 8.0) / LETTER)
        lines[node.name] = [
            *((x, TEXT) for x in textwrap.wrap(text, letters)),
            *((x, COLOURS[0]) for x in textwrap.wrap(", ".join(inside), letters)),
        ]
    least = NAME_HEIGHT if whole else HEIGHT
    heights = [
        max(least, *(25.0 + LINE * len(lines[n.name]) if lines[n.name] else 0.0 for n in row if n.is_box))
        for row in layers
    ]
    tops = [MARGIN + sum(h + BETWEEN for h in heights[k + 1 :]) for k in range(len(layers))]
    across = max(n.x + n.width / 2 for row in layers for n in row) + MARGIN
    foot = tops[0] + heights[0] + MARGIN
    total = foot + (30.0 if single else 0.0)
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {across:.0f} {total:.0f}" '
        f'width="{across:.0f}" height="{total:.0f}" font-family="DejaVu Sans, sans-serif" font-size="10">',
        f"  <title>What {package} is made of: an arrow leads to what is imported</title>",
        f"  <style>@media (prefers-color-scheme: dark) {{ {_night()} }}</style>",
        "  <defs>",
        *(
            f'    <marker id="end{k}" viewBox="0 0 8 8" refX="7" refY="4" markerWidth="7" markerHeight="7" '
            f'orient="auto"><path d="M0 0 L8 4 L0 8 z" fill="{colour}"/></marker>'
            for k, colour in enumerate(COLOURS)
        ),
        "  </defs>",
        f'  <rect width="100%" height="100%" fill="{PAPER}"/>',
    ]
    boxes = [n for row in reversed(layers) for n in row if n.is_box]
    for k, node in enumerate(boxes):
        parts += [_arrow(node, end, tops, heights, k % len(COLOURS)) for end in node.below]
    for k, node in enumerate(boxes):
        top, height = tops[node.floor - 1], heights[node.floor - 1]
        parts += _box(node, top, height, lines[node.name], COLOURS[k % len(COLOURS)])
    if single:
        said = f"Below all of them, single files: {', '.join(sorted(single))}"
        parts.append(
            f'  <text x="{MARGIN:.0f}" y="{foot + 12:.0f}" font-size="11" fill="{INK}">{said}</text>'
        )
    return "\n".join([*parts, "</svg>"]) + "\n"


def _night() -> str:
    """Rules that put the colours of the night in place of those of the day."""
    return " ".join(
        f"[{kind}='{day}'] {{ {kind}: {night}; }}"
        for day, night in NIGHT.items()
        for kind in ("fill", "stroke")
    )


def _arrow(start: Node, end: Node, tops: Sequence[float], heights: Sequence[float], colour: int) -> str:
    """From the foot of a box to the head of another one, straight where it passes a floor."""
    places = {n.name: k for k, n in enumerate(sorted(start.below, key=lambda n: n.x))}
    x = start.x + (places[end.name] - (len(start.below) - 1) / 2) * _port(start, start.below, PORTS[0])
    y = tops[start.floor - 1] + heights[start.floor - 1]
    path = f"M{x:.0f} {y:.0f}"
    before, node = start, end
    while True:
        near = tops[node.floor - 1]
        to = node.x
        if node.is_box:
            arriving = sorted(node.above, key=lambda n: n.x)
            to += (arriving.index(before) - (len(arriving) - 1) / 2) * _port(node, arriving, PORTS[1])
        middle = (y + near) / 2
        path += f" C{x:.0f} {middle:.0f} {to:.0f} {middle:.0f} {to:.0f} {near:.0f}"
        if node.is_box:
            break
        x, y = to, near + heights[node.floor - 1]
        path += f" V{y:.0f}"
        before, node = node, node.below[0]
    return (
        f'  <path d="{path}" fill="none" stroke="{COLOURS[colour]}" stroke-width="1.3" '
        f'marker-end="url(#end{colour})"/>'
    )


def _port(box: Node, arrows: Sequence[Node], most: float) -> float:
    """Distance of a box's arrows at its edge, so that all are within it."""
    return min(most, (box.width - 10.0) / len(arrows))


def _box(node: Node, top: float, height: float, lines: Sequence[tuple[str, str]], colour: str) -> list[str]:
    left, middle = node.x - node.width / 2, f'x="{node.x:.0f}" text-anchor="middle"'
    return [
        f'  <rect x="{left:.0f}" y="{top:.0f}" width="{node.width:.0f}" height="{height:.0f}" rx="5" '
        f'fill="{SHEET}" stroke="{colour}" stroke-width="1.5"/>',
        f'  <text {middle} y="{top + 16:.0f}" font-size="12.5" font-weight="bold" fill="{INK}">'
        f"{escape(node.name)}</text>",
        *(
            f'  <text {middle} y="{top + 31 + LINE * k:.0f}" fill="{shade}">{escape(line)}</text>'
            for k, (line, shade) in enumerate(lines)
        ),
    ]


def main() -> None:
    """Write the pictures and the table."""
    for name, package in PICTURES.items():
        (ROOT / "docs" / name).write_text(drawn(package), encoding="utf-8")
        print(f"docs/{name}")
    PAGE.write_text(tabled(PAGE.read_text(encoding="utf-8"), packages()), encoding="utf-8")


if __name__ == "__main__":
    main()
