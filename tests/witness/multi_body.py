"""An arm in MuJoCo, with gears' inertia, viscous friction and springs at its joints."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from xml.etree import ElementTree

import mujoco
import numpy as np
from numpy.typing import NDArray

from modelgen.description import Arm
from witness.bodies import Body
from witness.geometry import moving, parents_first, placement

Array = NDArray[np.float64]


def _text(values: Sequence[float] | Array) -> str:
    return " ".join(f"{float(v):.17g}" for v in values)


def _quaternion(rotation: Array) -> Array:
    result = np.zeros(4)
    mujoco.mju_mat2Quat(result, np.ascontiguousarray(rotation).reshape(9))
    return result


class MultiBody:
    """`joints`: attributes of MuJoCo's joints (armature, damping, stiffness, springref) by coordinate."""

    def __init__(
        self, arm: Arm, bodies: Sequence[Body], joints: Sequence[Mapping[str, float]] | None = None
    ) -> None:
        root = ElementTree.Element("mujoco")
        ElementTree.SubElement(root, "compiler", angle="radian", autolimits="false")
        ElementTree.SubElement(root, "option", gravity=_text(arm.gravity))
        carriers: dict[int | None, ElementTree.Element] = {None: ElementTree.SubElement(root, "worldbody")}
        coordinates = moving(arm)
        for i in parents_first(arm):
            joint, body = arm.joints[i], bodies[i]
            place = placement(arm, i, joint.locked or 0.0)
            element = ElementTree.SubElement(
                carriers[joint.antecedent],
                "body",
                name=f"link{i}",
                pos=_text(place[:3, 3]),
                quat=_text(_quaternion(place[:3, :3])),
            )
            tensor = body.inertia
            full = [*np.diag(tensor), tensor[0, 1], tensor[0, 2], tensor[1, 2]]
            mass = f"{body.mass:.17g}"
            ElementTree.SubElement(
                element, "inertial", pos=_text(body.com), mass=mass, fullinertia=_text(full)
            )
            if i in coordinates:
                extra = joints[coordinates.index(i)] if joints else {}
                kind = "slide" if joint.type == "prismatic" else "hinge"
                given = {key: f"{value:.17g}" for key, value in extra.items()}
                ElementTree.SubElement(element, "joint", name=f"joint{i}", type=kind, axis="0 0 1", **given)
            carriers[i] = element
        self.model = mujoco.MjModel.from_xml_string(ElementTree.tostring(root, encoding="unicode"))
        self.data = mujoco.MjData(self.model)
        self.places = [self.model.joint(f"joint{i}").dofadr[0] for i in coordinates]

    def _set(self, q: Array, dq: Array) -> None:
        self.data.qpos[self.places], self.data.qvel[self.places] = q, dq

    def effort(self, q: Array, dq: Array, ddq: Array) -> Array:
        """Inverse dynamics [N m or N]."""
        self._set(q, dq)
        self.data.qacc[self.places] = ddq
        mujoco.mj_inverse(self.model, self.data)
        return self.data.qfrc_inverse[self.places].copy()

    def acceleration(self, q: Array, dq: Array, effort: Array) -> Array:
        """Forward dynamics."""
        self._set(q, dq)
        self.data.qfrc_applied[self.places] = effort
        mujoco.mj_forward(self.model, self.data)
        return self.data.qacc[self.places].copy()

    def mass_matrix(self, q: Array) -> Array:
        """n x n, gears included."""
        self._set(q, 0 * q)
        mujoco.mj_forward(self.model, self.data)
        full = np.zeros((self.model.nv, self.model.nv))
        mujoco.mj_fullM(self.model, self.data, full)
        return full[np.ix_(self.places, self.places)]
