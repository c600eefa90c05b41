"""The pictures of the house are those of the code, and can be read."""

import re
from itertools import pairwise
from xml.etree import ElementTree as ET

import pytest

from architecture.house import ROOT, Graph, circles, file_graph, rooms
from architecture.picture import NAME, PAGE, PICTURES, arrange, drawn, layered, packages, reduced, tabled

pytestmark = pytest.mark.xdist_group("picture")

SVG = "{http://www.w3.org/2000/svg}"
COLUMN = 736  # of the documentation's text on a screen of 1280 [pixel]
PHONE = 368  # of the same on one of 400, on which a picture has three quarters of its size


@pytest.fixture(scope="module")
def made() -> dict[str, str]:
    return {name: drawn(package) for name, package in PICTURES.items()}


@pytest.mark.parametrize("name", sorted(PICTURES))
def test_the_picture_is_that_of_the_imports(name: str, made: dict[str, str]) -> None:
    """Where it is not: PYTHONPATH=tests python -m architecture.picture."""
    kept = (ROOT / "docs" / name).read_text(encoding="utf-8")
    assert made[name] == kept, "PYTHONPATH=tests python -m architecture.picture draws it anew"


def test_the_table_of_packages_is_that_of_their_docstrings() -> None:
    """Where it is not: PYTHONPATH=tests python -m architecture.picture."""
    kept, table = PAGE.read_text(encoding="utf-8"), packages()
    assert tabled(kept, table) == kept
    rows = [line.strip("| ").split(" | ") for line in table.splitlines()[2:]]
    assert all(len(row) == 2 and len(row[1]) > 10 for row in rows), rows
    folders = {p.parent.name for p in (ROOT / NAME).glob("*/__init__.py")}
    assert folders <= {row[0].strip("`") for row in rows}


def test_the_house_is_legible_on_a_desk_and_begins_on_a_phone_with_a_box(made: dict[str, str]) -> None:
    root = ET.fromstring(made["architecture.svg"])
    assert float(root.attrib["width"]) <= COLUMN
    top = min(root.findall(f"{SVG}rect")[1:], key=lambda r: float(r.attrib["y"])).attrib
    assert 0.75 * (float(top["x"]) + float(top["width"])) < PHONE


@pytest.mark.parametrize("name", sorted(PICTURES))
def test_boxes_stand_apart_and_hold_their_text(name: str, made: dict[str, str]) -> None:
    root = ET.fromstring(made[name])
    _, *frames = root.findall(f"{SVG}rect")
    boxes = [tuple(float(r.attrib[k]) for k in ("x", "y", "width", "height")) for r in frames]
    assert len(boxes) > 8
    for k, (x, y, w, h) in enumerate(boxes):
        assert x >= 0
        assert y >= 0
        for other_x, other_y, other_w, other_h in boxes[:k]:
            assert x >= other_x + other_w or other_x >= x + w or y >= other_y + other_h or other_y >= y + h
    for text in root.findall(f"{SVG}text"):
        place = float(text.attrib["y"])
        if text.attrib.get("text-anchor") == "middle":
            at = float(text.attrib["x"])
            inside = [b for b in boxes if b[0] < at < b[0] + b[2] and b[1] < place < b[1] + b[3]]
            assert len(inside) == 1, text.text
            assert 5.6 * len(text.text or "") <= inside[0][2], text.text


@pytest.mark.parametrize("name", sorted(PICTURES))
def test_arrows_lead_down(name: str, made: dict[str, str]) -> None:
    root = ET.fromstring(made[name])
    paths = [p.attrib["d"] for p in root.findall(f"{SVG}path")]
    assert paths
    for path in paths:
        first = re.match(r"M-?\d+ (\d+)", path)
        assert first is not None
        assert int(path.split()[-1]) > int(first[1])


def test_arrows_that_follow_from_others_are_left_out_and_no_others() -> None:
    graph = {"a": frozenset("bc"), "b": frozenset("c"), "c": frozenset(), "d": frozenset("ac")}
    assert reduced(graph) == {"a": {"b"}, "b": {"c"}, "c": set(), "d": {"a"}}


def test_what_can_be_reached_stays() -> None:
    graph = rooms(NAME, file_graph())
    assert not circles(graph)
    less = reduced(graph)

    def reached(some: Graph, node: str) -> set[str]:
        found, left = set[str](), [node]
        while left:
            new = some[left.pop()] - found
            found |= new
            left += new
        return found

    for node in graph:
        assert reached(graph, node) == reached(less, node)
    assert sum(map(len, less.values())) < sum(map(len, graph.values()))


def test_nodes_of_a_floor_keep_their_distance() -> None:
    layers = layered(
        {"a": frozenset("bcd"), "b": frozenset("d"), "c": frozenset("d"), "d": frozenset()},
        dict.fromkeys("abcd", 100.0),
    )
    arrange(layers)
    for layer in layers:
        for left, right in pairwise(layer):
            assert right.x - left.x > (left.width + right.width) / 2
