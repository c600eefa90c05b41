"""Drawings of arms."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from modelgen.api.description import an_arm
from modelgen.api.results import Shown, Table
from modelgen.description import Arm
from modelgen.drawing import framed, page, start
from modelgen.files import check_writable, write_together
from modelgen.simulation.values import by_joint

_HEIGHT = 620  # pixels, in a notebook


class Drawing(Shown):
    """An arm in three dimensions, to turn and move.

    Parameters
    ----------
    arm : Arm
        The arm.
    q : sequence of float
        Coordinates (n,) that it is drawn at [rad, m].

    Attributes
    ----------
    arm : Arm
        The arm.
    q : list of float
        Coordinates (n,) that it is drawn at [rad, m].
    html : str
        The page; it needs nothing beside it.
    """

    def __init__(self, arm: Arm, q: Sequence[float]) -> None:
        self.arm = arm
        self.q = [float(x) for x in q]
        self.html = page(arm, self.q)

    def write(self, path: Path | str) -> None:
        """Write the page.

        Parameters
        ----------
        path : Path or str
            The file; one that is there is replaced.

        Raises
        ------
        InputError
            Where it cannot be written.
        """
        path = Path(path)
        check_writable("--out", path)
        write_together(f"--out {path}", path.parent, {path.name: self.html})

    def to_json(self) -> dict[str, Any]:
        """Plain data: what is drawn, and where.

        Returns
        -------
        dict
            The arm's name, its coordinates by joint [rad, m] and the size of the page [bytes].
        """
        names = self.arm.coordinate_names
        return {
            "arm": self.arm.name,
            "q": dict(zip(names, self.q, strict=True)),
            "bytes": len(self.html.encode()),
        }

    def shown(self) -> Sequence[str | Table]:
        """One line.

        Returns
        -------
        sequence of str
            What is drawn, and where.
        """
        return [repr(self)]

    def __repr__(self) -> str:
        at = ", ".join(f"{name} {value:g}" for name, value in self.to_json()["q"].items())
        return f"{self.arm.name} at {at}"

    def _repr_html_(self) -> str:
        return str(framed(self.html, f"drawing of {self.arm.name}", _HEIGHT))


def draw(arm: Arm, out: Path | str | None = None, q: str | float | Sequence[float] | None = None) -> Drawing:
    """Draw an arm: one HTML page with frames, axes, levers, centres of mass and inertias, to turn and move.

    Parameters
    ----------
    arm : Arm
        The arm.
    out : Path or str, optional
        File to write the page to.
    q : str, float or sequence of float, optional
        Coordinates that it is drawn at [rad, m]: "20 deg" for all joints, "20 deg, 0.1, ..." for each, or
        numbers. Default: zero, or the middle of a range that zero is not in.

    Returns
    -------
    Drawing
        The page; a notebook shows it.

    Raises
    ------
    InputError
        For coordinates outside the joints' ranges, and where the file cannot be written.
    """
    an_arm(arm)
    if out is not None:
        check_writable("--out", Path(out))
    names = arm.coordinate_names
    found = Drawing(arm, start(arm) if q is None else by_joint("--q", q, names).tolist())
    if out is not None:
        found.write(out)
    return found
