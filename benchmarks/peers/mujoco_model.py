"""An arm for MuJoCo's harness."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from xml.etree import ElementTree

import mujoco
import numpy as np

from peers.arms import Subject
from peers.build import object_file, package, program


def _text(numbers: Iterable[float]) -> str:
    return " ".join(f"{float(number):.17g}" for number in numbers)


def save(case: Subject, path: Path) -> None:
    """Write the arm as a compiled model (.mjb)."""
    root = ElementTree.Element("mujoco")
    ElementTree.SubElement(root, "compiler", angle="radian", autolimits="false")
    ElementTree.SubElement(root, "option", gravity=_text(case.arm.gravity))
    world = ElementTree.SubElement(root, "worldbody")
    made: list[ElementTree.Element] = []
    for body in case.bodies:
        quaternion = np.zeros(4)
        mujoco.mju_mat2Quat(quaternion, np.ascontiguousarray(body.place[:3, :3]).reshape(9))
        place = {"pos": _text(body.place[:3, 3]), "quat": _text(quaternion)}
        carrier = ElementTree.SubElement(world if body.parent is None else made[body.parent], "body", place)
        xx, xy, xz, yy, yz, zz = body.inertia
        inertia = _text((xx, yy, zz, xy, xz, yz))
        mass, com = _text([body.mass]), _text(body.com)
        ElementTree.SubElement(carrier, "inertial", pos=com, mass=mass, fullinertia=inertia)
        kind = "slide" if body.prismatic else "hinge"
        ElementTree.SubElement(carrier, "joint", type=kind, axis="0 0 1")
        made.append(carrier)
    model = mujoco.MjModel.from_xml_string(ElementTree.tostring(root, encoding="unicode"))
    mujoco.mj_saveModel(model, str(path), None)


def harness(folder: Path) -> Path:
    """The harness with MuJoCo."""
    wheel = package("mujoco")
    assert wheel is not None
    library = next(wheel.glob("libmujoco.so*"))
    compiled = object_file(Path(__file__).parent / "mujoco.c", folder / "mujoco.o", f"-I{wheel / 'include'}")
    return program(folder / "mujoco", [compiled], str(library), f"-Wl,-rpath,{wheel}")
