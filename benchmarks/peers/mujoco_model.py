"""An arm for MuJoCo's harness."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from xml.etree import ElementTree

import mujoco
import numpy as np

from modelgen.description.objects import Arm
from peers.arms import placement
from peers.build import object_file, package, program


def _text(numbers: Iterable[float]) -> str:
    return " ".join(f"{float(number):.17g}" for number in numbers)


def save(arm: Arm, path: Path) -> None:
    """Write the arm as a compiled model (.mjb)."""
    root = ElementTree.Element("mujoco")
    ElementTree.SubElement(root, "compiler", angle="radian", autolimits="false")
    ElementTree.SubElement(root, "option", gravity=_text(arm.gravity))
    carrier = ElementTree.SubElement(root, "worldbody")
    for i, (joint, link) in enumerate(zip(arm.joints, arm.links, strict=True)):
        assert link is not None
        place = placement(arm, i)
        quaternion = np.zeros(4)
        mujoco.mju_mat2Quat(quaternion, np.ascontiguousarray(place[:3, :3]).reshape(9))
        carrier = ElementTree.SubElement(carrier, "body", pos=_text(place[:3, 3]), quat=_text(quaternion))
        xx, xy, xz, yy, yz, zz = link.inertia
        inertia = _text((xx, yy, zz, xy, xz, yz))
        mass, com = _text([link.mass]), _text(link.com)
        ElementTree.SubElement(carrier, "inertial", pos=com, mass=mass, fullinertia=inertia)
        kind = "slide" if joint.type == "prismatic" else "hinge"
        ElementTree.SubElement(carrier, "joint", type=kind, axis="0 0 1")
    model = mujoco.MjModel.from_xml_string(ElementTree.tostring(root, encoding="unicode"))
    mujoco.mj_saveModel(model, str(path), None)


def harness(folder: Path) -> Path:
    """The harness with MuJoCo."""
    wheel = package("mujoco")
    assert wheel is not None
    library = next(wheel.glob("libmujoco.so*"))
    compiled = object_file(Path(__file__).parent / "mujoco.c", folder / "mujoco.o", f"-I{wheel / 'include'}")
    return program(folder / "mujoco", [compiled], str(library), f"-Wl,-rpath,{wheel}")
