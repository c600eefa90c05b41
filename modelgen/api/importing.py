"""Robots of other formats as arms."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from modelgen.api.results import Shown, Table
from modelgen.description import Arm
from modelgen.files import check_writable, write_new
from modelgen.importing import Imported, import_model
from modelgen.numeric import Array


class ImportedRobot(Shown):
    """An arm that was made of a robot in another format.

    Parameters
    ----------
    found : modelgen.importing.Imported
        What the import gives back.

    Attributes
    ----------
    arm : Arm
        The arm, as `load_arms` gives it.
    text : str
        The description in YAML that holds it.
    joints : mapping of str to str
        Names of the arm's joints by those of the source.
    links : mapping of str to tuple
        For each link of the source: the joint that carries it, None for the base, and the link's frame (4, 4)
        in the frame of that joint, or in the world [m].
    remarks : tuple of str
        What was rounded, held, left out or is doubtful.
    """

    def __init__(self, found: Imported) -> None:
        self.found = found
        self.arm: Arm = found.arm
        self.text = found.text
        self.joints: Mapping[str, str] = found.joints
        self.links: Mapping[str, tuple[str | None, Array]] = found.links
        self.remarks = found.remarks

    def write(self, path: Path | str) -> None:
        """Write the description to a file that does not exist yet.

        Parameters
        ----------
        path : Path or str
            The file.

        Raises
        ------
        InputError
            Where the file exists or cannot be written.
        """
        check_writable("--out", Path(path))
        write_new(Path(path), self.text)

    def to_json(self) -> dict[str, Any]:
        """Plain data: names, places of the source's links, remarks.

        Returns
        -------
        dict
            Arm, joints, links with their frames (4, 4) [m], remarks, the description.
        """
        return {
            "arm": self.arm.name,
            "joints": dict(self.joints),
            "links": {
                name: {"joint": joint, "frame": frame.tolist()} for name, (joint, frame) in self.links.items()
            },
            "remarks": list(self.remarks),
            "description": self.text,
        }

    def shown(self) -> Sequence[str | Table]:
        """Lines and a table of the joints.

        Returns
        -------
        sequence of str or Table
            In the order in which they are printed.
        """
        rows = [[theirs, own] for theirs, own in self.joints.items()]
        columns = {"joint of the source": "left", "joint of the arm": "left"}
        table = [Table("", columns, rows)] if any(a != b for a, b in rows) else []
        return [repr(self), *table, *(f"note: {remark}" for remark in self.remarks)]

    def __repr__(self) -> str:
        n = len(self.arm.coordinates)
        return f"{self.arm.name}: {n} joint{'' if n == 1 else 's'}, {len(self.links)} links of the source"


def import_robot(
    source: Path | str,
    *,
    root: str | None = None,
    tip: str | None = None,
    lock: Mapping[str, float] | None = None,
    name: str | None = None,
    exact: bool = False,
) -> ImportedRobot:
    """Make an arm of a robot in URDF or MJCF, or of a table of standard DH parameters (CSV).

    Coordinates are the source's.

    Parameters
    ----------
    source : Path or str
        The file; what it holds tells the format, .csv, .tsv or .txt a table.
    root : str, optional
        Link that the arm stands on. Default: the source's own.
    tip : str, optional
        Link that the arm ends with; joints beside the way there are held. Default: all that the root carries.
    lock : mapping of str to float, optional
        Joints of the source that are held, by coordinate [rad, m].
    name : str, optional
        Name of the arm. Default: the source's.
    exact : bool
        Keep rounded angles such as 1.5708, and lengths of 1e-11 m, as they are.

    Returns
    -------
    ImportedRobot
        The arm, its description, where the source's links are, and remarks.

    Raises
    ------
    InputError
        With its line, for a file that cannot be read, and by name for what moves but is no joint of one
        degree of freedom in a tree.

    References
    ----------
    Khalil and Kleinfinger, A new geometric notation for open and closed-loop robots, 1986.
    """
    return ImportedRobot(import_model(source, root=root, tip=tip, lock=lock, name=name, exact=exact))
