"""From a file of another format to an arm: read, select, place frames, write."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from modelgen.description import Arm, loads
from modelgen.effects import known_effects
from modelgen.importing.arm_text import ArmText, JointText, ToolText, text_of, unlikely
from modelgen.importing.axes import Axis, Line, Nearness
from modelgen.importing.bodies import moved_body, together
from modelgen.importing.formats import read_robot
from modelgen.importing.frames import Parameters, Placed, place_frames
from modelgen.importing.names import arm_name, joint_names
from modelgen.importing.poses import inverse
from modelgen.importing.resistance import drive_of, effects_of, shared_by
from modelgen.importing.robot import Body, Robot
from modelgen.importing.rounded import ANGLE_NEAR, LENGTH_NEAR, NOISE, Rounding
from modelgen.importing.selection import Mechanism, MovingJoint, select
from modelgen.numeric import Array

EXACT = Nearness(1e-12, 1e-12)  # of arithmetic alone
NEAR = Nearness(ANGLE_NEAR, LENGTH_NEAR)
_WHERE = "link {}"


@dataclass(frozen=True)
class Imported:
    """An imported arm.

    text: of an arms.yaml that holds it. joints: names in the arm by those of the source. links: for each link
    of the source that was imported, the joint that carries it (None: the base) and its frame (4, 4) in the
    frame of that joint, or in the world. remarks: what the user must know.
    """

    name: str
    text: str
    arm: Arm
    joints: Mapping[str, str]
    links: Mapping[str, tuple[str | None, Array]]
    remarks: tuple[str, ...]


def import_model(
    source: Path | str,
    *,
    root: str | None = None,
    tip: str | None = None,
    lock: Mapping[str, float] | None = None,
    name: str | None = None,
    exact: bool = False,
) -> Imported:
    """The arm of a URDF, an MJCF, or a table of standard DH parameters.

    root, tip: links of the source between which the arm lies; by default all that the source's root carries.
    lock: joints held, by coordinate [rad, m]. name: the arm's, by default the source's. exact: keep angles
    and lengths as they are, also near a multiple of 15 degrees and near zero. Raises InputError.
    """
    path = Path(source)
    rounding = Rounding(exact)
    robot = read_robot(path, rounding)
    mechanism = select(robot, root, tip, lock or {})
    placed = place_frames(
        [_axis(i, joint) for i, joint in enumerate(mechanism.joints)], EXACT if exact else NEAR
    )
    remarks = [*robot.remarks, *rounding.remarks(), *mechanism.remarks]
    if placed.snapped > NOISE:
        remarks.append(
            f"angles near a multiple of 15 deg and lengths near 0 are made exact, {placed.snapped:.1e} rad "
            "or m off at most; --exact keeps them"
        )
    return _Writing(path, robot, mechanism, placed, tip).imported(
        arm_name(name, robot.name or path.stem), remarks
    )


def _axis(index: int, joint: MovingJoint) -> Axis:
    line = Line(joint.place, joint.axis)
    return Axis(line, joint.joint.kind == "prismatic", joint.antecedent, joint.pose, index)


class _Writing:
    def __init__(
        self, path: Path, robot: Robot, mechanism: Mechanism, placed: Placed, tip: str | None
    ) -> None:
        self.path, self.robot, self.mechanism, self.placed, self.tip = path, robot, mechanism, placed, tip
        self.names = joint_names(self._wished(i) for i in range(len(placed.axes)))
        self.carrying = {axis.antecedent for axis in placed.axes}

    def _wished(self, index: int) -> str:
        """The source's name; a helper is called by what it carries."""
        axis = self.placed.axes[index]
        if axis.joint is not None:
            return self.mechanism.joints[axis.joint].joint.name
        carried = next(a.joint for a in self.placed.axes if a.antecedent == index)
        assert carried is not None
        return f"{self.mechanism.joints[carried].joint.name}_frame"

    def imported(self, name: str, remarks: Sequence[str]) -> Imported:
        """The arm, its text and where the source's links are."""
        base = self.placed.base
        joints = [self._joint(i) for i in range(len(self.names))]
        own_base = bool(np.abs(base - np.eye(4)).max() > 0)
        tools = self._tools()
        text = text_of(
            ArmText(
                name=name,
                heading=[f"Imported from {self.path.name} ({self.robot.form})."],
                source=f"{self.robot.form} {self.robot.name or self.path.stem}, {self.path.name}",
                gravity=base[:3, :3].T @ self.mechanism.gravity,
                base=base if own_base else None,
                base_note=f"the world is link {self.mechanism.root}",
                joints=joints,
                tools=tools,
            )
        )
        arm = loads(text, f"{self.path.name}, imported", known_effects())[name]
        return Imported(
            name=name,
            text=text,
            arm=arm,
            joints={
                self.mechanism.joints[axis.joint].joint.name: own
                for axis, own in zip(self.placed.axes, self.names, strict=True)
                if axis.joint is not None
            },
            links=self._links(),
            remarks=(*remarks, *(asked for joint in joints for asked in unlikely(joint)), *arm.notes),
        )

    def _joint(self, i: int) -> JointText:
        axis, parameters = self.placed.axes[i], self.placed.parameters[i]
        before = "base" if axis.antecedent is None else self.names[axis.antecedent]
        usual = i - 1 if i else None
        antecedent = None if axis.antecedent == usual else before
        if axis.joint is None:
            body = Body(0.0, np.zeros(3), np.zeros((3, 3))) if self.robot.inertials else None
            note = "a frame between two axes that are nearly parallel"
            return JointText(self.names[i], "fixed", parameters, antecedent, note, body=body)
        moving = self.mechanism.joints[axis.joint]
        joint = moving.joint
        own = [] if joint.name == self.names[i] else [joint.name]
        return JointText(
            name=self.names[i],
            kind=joint.kind,
            parameters=_at_zero(parameters, joint.kind, joint.reference),
            antecedent=antecedent,
            note=", ".join([*own, f"{joint.parent} -> {joint.child}"]),
            position=joint.position,
            velocity=joint.velocity,
            effort=joint.effort,
            drive=drive_of(joint),
            effects=effects_of(joint) | self._shared(joint.name),
            body=self._body(moving, self.placed.frames[i]),
            body_note=", ".join(link.name for link in moving.links if self.robot.links[link.name].body),
        )

    def _shared(self, name: str) -> dict[str, dict[str, float]]:
        """Effects of what turns with this joint and another."""
        numbers = [self.mechanism.joints[a.joint].joint.name for a in self.placed.axes if a.joint is not None]
        for pair in self.mechanism.pairs:
            if pair.joint == name:
                return shared_by(pair, numbers.index(pair.other) + 1)
        return {}

    def _body(self, moving: MovingJoint, frame: Array) -> Body | None:
        if not self.robot.inertials:
            return None
        return moved_body(together(moving.bodies), inverse(frame))

    def _tools(self) -> list[ToolText]:
        """Ends of the arm in the source, where they are not the frames of its last joints."""
        found = []
        for i, axis in enumerate(self.placed.axes):
            if axis.joint is None or i in self.carrying:
                continue
            for link in self.mechanism.joints[axis.joint].links:
                frame = inverse(self.placed.frames[i]) @ link.pose
                wanted = link.end if self.tip is None else link.name == self.tip
                if wanted and np.abs(frame - np.eye(4)).max() > NOISE:
                    found.append((link.name, self.names[i], frame))
        names = joint_names((name for name, _, _ in found), self.names)
        return [
            ToolText(own, link, frame, f"link {name}")
            for own, (name, link, frame) in zip(names, found, strict=True)
        ]

    def _links(self) -> dict[str, tuple[str | None, Array]]:
        links: dict[str, tuple[str | None, Array]] = {
            link.name: (None, link.pose) for link in self.mechanism.base_links
        }
        for i, axis in enumerate(self.placed.axes):
            if axis.joint is not None:
                back = inverse(self.placed.frames[i])
                for link in self.mechanism.joints[axis.joint].links:
                    links[link.name] = (self.names[i], back @ link.pose)
        return links


def _at_zero(parameters: Parameters, kind: str, reference: float) -> Parameters:
    """The parameters of the drawn pose less the coordinate there: those of the description."""
    if kind == "prismatic":
        return replace(parameters, r=parameters.r - reference)
    return replace(parameters, theta=parameters.theta - reference)
