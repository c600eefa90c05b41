"""Which format a file is in."""

from __future__ import annotations

from pathlib import Path

from modelgen.errors import InputError
from modelgen.importing.mjcf import read_mjcf
from modelgen.importing.robot import Robot
from modelgen.importing.rounded import Rounding
from modelgen.importing.urdf import read_urdf
from modelgen.importing.xml_text import read_xml


def read_robot(path: Path, rounding: Rounding) -> Robot:
    """The robot of a file, by its content. Raises InputError, with the line, at the first mistake."""
    if path.suffix.lower() == ".xacro":
        raise InputError(f"{path}: expand it first: xacro {path.name} > {path.stem.split('.')[0]}.urdf")
    root = read_xml(path)
    if root.tag == "robot":
        return read_urdf(root, rounding)
    if root.tag == "mujoco":
        return read_mjcf(root, rounding)
    raise root.error(f"found <{root.tag}>, expected <robot> (URDF) or <mujoco> (MJCF)")
