"""Which format a file is in."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from modelgen.errors import InputError
from modelgen.importing.dh_table import read_dh_table
from modelgen.importing.mjcf import read_mjcf
from modelgen.importing.robot import Robot
from modelgen.importing.rounded import Rounding
from modelgen.importing.urdf import read_urdf
from modelgen.importing.xml_text import read_xml

TABLES = (".csv", ".tsv", ".txt")


def read_robot(path: Path, rounding: Rounding) -> Robot:
    """The robot of a file, by its content; a table of DH parameters by its name.

    Raises InputError, with the line, at the first mistake.
    """
    return replace(_read(path, rounding), file=str(path))


def _read(path: Path, rounding: Rounding) -> Robot:
    if path.suffix.lower() == ".xacro":
        raise InputError(f"{path}: expand it first: xacro {path.name} > {path.stem.split('.')[0]}.urdf")
    if path.suffix.lower() in TABLES:
        return read_dh_table(path, _text(path), rounding)
    root = read_xml(path)
    if root.tag == "robot":
        return read_urdf(root, rounding)
    if root.tag == "mujoco":
        return read_mjcf(root, rounding)
    raise root.error(f"found <{root.tag}>, expected <robot> (URDF) or <mujoco> (MJCF)")


def _text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8")
    except FileNotFoundError:
        raise InputError(f"{path}: there is no such file") from None
    except UnicodeDecodeError:
        raise InputError(f"{path}: this is no text in UTF-8, save it as such (CSV UTF-8)") from None
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror}") from None
