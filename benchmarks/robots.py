"""Robots of others as arms: every URDF of the PyPI package example-robot-data, MJCF of every kind of joint.

    python benchmarks/robots.py [--only WORD] [--folder ROBOTS]     print the page
    python benchmarks/robots.py --accept                            write docs/imported-robots.md

Each is imported as it stands, joints that mimic others held at zero, and compared at 200 states with what
Pinocchio and MuJoCo make of the source itself. Some twenty minutes.
"""

from __future__ import annotations

import argparse
import re
import sys
import sysconfig
import tempfile
import textwrap
import xml.etree.ElementTree as ET
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import mujoco
import pinocchio

import modelgen as mg

ROOT = Path(__file__).resolve().parent.parent
sys.path.append(str(ROOT / "tests" / "support"))  # what the tests compare with

import importing_support  # noqa: E402
import mjcf_models  # noqa: E402

PAGE = ROOT / "docs" / "imported-robots.md"
INSTALLED = Path(sysconfig.get_path("purelib")) / "cmeel.prefix" / "share" / "example-robot-data" / "robots"
WORST = 1e-9
COLUMNS = ("joints", "links", "standard", "base", "operations", "held")


@dataclass(frozen=True)
class Row:
    """One robot. figures: in the order of COLUMNS, None where it is refused; off: from the simulator."""

    name: str
    figures: tuple[int, ...] | None = None
    off: float = 0.0
    reason: str = ""


def main(arguments: Sequence[str]) -> int:
    """Import, compare, print or write."""
    parser = argparse.ArgumentParser(description="Robots of others as arms.")
    parser.add_argument("--only", default="", help="robots whose name holds this word")
    parser.add_argument("--folder", type=Path, default=INSTALLED, help="robots of example-robot-data")
    parser.add_argument("--accept", action="store_true", help="write docs/imported-robots.md")
    given = parser.parse_args(arguments)
    if given.accept and given.only:
        parser.error("--accept takes every robot")
    if not given.folder.is_dir():
        parser.error(f"there is no folder {given.folder}: pip install example-robot-data, or say --folder")
    robots = [row for row in urdf_rows(given.folder, given.only) if seen(row)]
    models = [row for row in mjcf_rows() if given.only in row.name and seen(row)]
    text = page(robots, models, version(given.folder))
    worst = max((row.off for row in [*robots, *models]), default=0.0)
    if given.accept and worst <= WORST:
        PAGE.write_text(text, encoding="utf-8")
    print(text)
    return 0 if worst <= WORST else 1


def seen(row: Row) -> bool:
    """Tell how far it is."""
    print(row.name, row.figures or row.reason, f"{row.off:.0e}", file=sys.stderr, flush=True)
    return True


def version(folder: Path) -> str:
    """Of the package that the folder belongs to."""
    found = next(folder.resolve().parents[3].glob("example_robot_data-*.dist-info"))
    return found.name.split("-")[1].removesuffix(".dist")


# -- one robot --------------------------------------------------------------------------------


def urdf_rows(folder: Path, only: str = "") -> Iterable[Row]:
    """All URDF of the package, by name."""
    for path in sorted(folder.rglob("*.urdf"), key=lambda p: (label(folder, p).lower(), p)):
        if only in label(folder, path):
            yield urdf_row(folder, path)


def label(folder: Path, path: Path) -> str:
    """Folder and file, without what all are called."""
    robot = path.relative_to(folder).parts[0]
    return f"{re.sub('(_simple)?_(description|data)$', '', robot)}/{path.stem}"


def urdf_row(folder: Path, path: Path) -> Row:
    """One of them."""
    name = label(folder, path)
    mimics = dict.fromkeys(mimicking(path), 0.0)
    return row_of(name, path, mimics, lambda arm: importing_support.off_pinocchio(path, arm, mimics))


def mimicking(path: Path) -> list[str]:
    """Joints that follow others, and move."""
    joints = ET.parse(path).getroot().iter("joint")
    follow = [joint for joint in joints if joint.find("mimic") is not None]
    return [joint.attrib["name"] for joint in follow if joint.attrib["type"] != "fixed"]


def mjcf_rows() -> Iterable[Row]:
    """Models of MJCF that the tests have."""
    with tempfile.TemporaryDirectory() as made:
        path = Path(made) / "model.xml"
        for name in mjcf_models.MODELS:
            text = mjcf_models.whole(name)
            path.write_text(text, encoding="utf-8")
            yield row_of(name, path, {}, partial(importing_support.off_mujoco, text))


def row_of(
    name: str, path: Path, held: dict[str, float], compare: Callable[[importing_support.Arm], float]
) -> Row:
    """Import it, and compare. Operations are those of a plain import, which rounds angles."""
    try:
        exact = mg.import_robot(path, lock=held, exact=True)
        plain = mg.import_robot(path, lock=held)
    except mg.InputError as error:
        return Row(name, reason=str(error).replace(f"{path}:", "line "))
    arm = importing_support.Arm(exact)
    same = plain.text.partition("arms:")[2] == exact.text.partition("arms:")[2]
    model = arm.model if same else mg.build_model(plain.arm, derivatives=False)
    count = next(f.operations for f in model.built.functions if f.name == "inverse_dynamics")
    operations = sum(count[kind] for kind in ("mul", "add", "neg"))
    sizes = len(plain.arm.coordinates), len(plain.links), len(model.built.standard)
    return Row(name, (*sizes, len(model.base_parameters), operations, len(held)), compare(arm))


# -- the page ---------------------------------------------------------------------------------


def page(robots: Sequence[Row], models: Sequence[Row], package: str) -> str:
    """The whole of it."""
    worst = max((row.off for row in [*robots, *models]), default=0.0)
    taken = [row for row in robots if row.figures is not None]
    about = (
        "*Is a robot like mine among those that have been imported, and how large is its model?* "
        f"Every URDF of the PyPI package `example-robot-data` {package}, {len(robots)} files, and models of "
        "MJCF with joints and settings of every kind, were [imported](importing.md) and compared with "
        f"Pinocchio {pinocchio.__version__} and MuJoCo {mujoco.__version__}, which read the source itself, "
        f"at {importing_support.SAMPLES} states: efforts of inverse dynamics, mass matrix and the pose of "
        f"every link. The largest difference of all is {worst:.0e}, relative to the largest value. What "
        "walks or flies is fixed at its root link. `make bench-robots` writes this page."
    )
    columns = (
        "Operations are multiplications, additions and negations of `inverse_dynamics`; held are joints that "
        "mimic others, at zero."
    )
    lines = [
        "# Robots that have been brought in",
        "",
        *textwrap.wrap(about, 120, break_on_hyphens=False),
        "",
        *textwrap.wrap(columns, 120, break_on_hyphens=False),
        "",
        f"## {len(taken)} robots of example-robot-data",
        "",
        *table(taken),
        "",
        "Refused, and why:",
        "",
        "| robot | reason |",
        "|---|---|",
        *(f"| {row.name} | {row.reason} |" for row in robots if row.figures is None),
        "",
        f"## {len(models)} models of MJCF",
        "",
        *table(models),
    ]
    return "\n".join(lines) + "\n"


def table(rows: Sequence[Row]) -> list[str]:
    """Figures of robots."""
    headings = ("robot", "joints", "links", "standard parameters", "base parameters", "operations", "held")
    return [
        f"| {' | '.join(headings)} |",
        f"|---|{'---:|' * len(COLUMNS)}",
        *(line(row) for row in rows),
    ]


def line(row: Row) -> str:
    """One line of a table."""
    return f"| {row.name} | {' | '.join(map(str, row.figures or ()))} |"


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
