"""Which joints move: the part of the robot between root and tips, what is held, and what is refused."""

from __future__ import annotations

import difflib
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from modelgen.errors import InputError
from modelgen.importing.bodies import doubt, moved_body
from modelgen.importing.poses import moved
from modelgen.importing.robot import MOVING, Body, Robot, SourceJoint, SourcePair
from modelgen.numeric import Array


@dataclass(frozen=True)
class Carried:
    """A link that a joint carries rigidly, with its pose in the axes of the root, drawn."""

    name: str
    pose: Array
    end: bool  # nothing stands on it


@dataclass(frozen=True)
class MovingJoint:
    """A joint that stays in the model, in the axes of the root in the drawn pose.

    antecedent: index among the moving joints, None for the base. place: a point of the axis [m], the joint's
    own origin. pose: frame of its child link.
    """

    joint: SourceJoint
    antecedent: int | None
    axis: Array
    place: Array
    pose: Array
    bodies: tuple[Body, ...]
    links: tuple[Carried, ...]


@dataclass(frozen=True)
class Mechanism:
    """The part that is imported: antecedents stand before what they carry. gravity: axes of the root."""

    joints: tuple[MovingJoint, ...]
    root: str
    base_links: tuple[Carried, ...]
    gravity: Array
    remarks: tuple[str, ...]
    pairs: tuple[SourcePair, ...] = ()


def select(robot: Robot, root: str | None, tip: str | None, lock: Mapping[str, float]) -> Mechanism:
    """The mechanism between `root` and `tip`, links of the source; without a tip, all that root carries.

    lock: joints held, by coordinate [rad, m]. Joints beside the way to the tip, and behind it, are held where
    they are drawn, at zero mostly; what they carry stays, as a part of the link that carries them. Raises
    InputError for names that do not exist, and for what moves but cannot be imported.
    """
    return _Selection(robot, root or robot.root, tip, lock).made()


class _Selection:
    def __init__(self, robot: Robot, root: str, tip: str | None, lock: Mapping[str, float]) -> None:
        self.robot = robot
        self.remarks: list[str] = []
        self.pairs: list[SourcePair] = []
        self.by_name = {joint.name: joint for joint in robot.joints}
        self.above = {joint.child: joint for joint in robot.joints}
        self.below: dict[str, list[SourceJoint]] = {}
        for joint in robot.joints:
            self.below.setdefault(joint.parent, []).append(joint)
        for option, link in (("--root", root), ("--tip", tip)):
            if link is not None and link not in robot.links:
                raise InputError(f"{option}: there is no link '{link}'{_near(link, robot.links)}")
        self.root, self.tip = root, tip
        self.held = self._held(lock)
        self.wanted = self._wanted()

    def made(self) -> Mechanism:
        """The mechanism."""
        found: list[tuple[SourceJoint, int | None, Array]] = []
        bodies: dict[int | None, list[Body]] = {None: []}
        links: dict[int | None, list[Carried]] = {None: []}
        # depth first, in the order of the file: joint, frame that its parent gives it, what carries that
        stack: list[tuple[SourceJoint | None, Array, int | None]] = [(None, np.eye(4), None)]
        while stack:
            joint, frame, carrier = stack.pop()
            if joint is not None and joint.name in self.wanted:
                found.append((joint, carrier, frame))
                carrier = len(found) - 1
                bodies[carrier], links[carrier] = [], []
            elif joint is not None:
                frame = frame @ self._hold(joint)
            name = self.root if joint is None else joint.child
            link = self.robot.links[name]
            body = link.body
            branches = self.below.get(name, [])
            links[carrier].append(Carried(name, frame, not branches))
            if body is not None and body.mass < 0:
                raise InputError(
                    f"link {name}: found a mass of {body.mass:g} kg, expected 0 or more",
                    self.robot.where(link.line),
                )
            if body is not None and carrier is not None:
                bodies[carrier].append(moved_body(body, frame))
                if doubt(body):
                    self.remarks.append(f"link {name}: {doubt(body)}; kept as given")
            stack += [(branch, frame @ branch.pose, carrier) for branch in reversed(branches)]
        if not found:
            raise InputError("no joint is left that moves, expected at least one", self.robot.where(1))
        return Mechanism(
            joints=tuple(
                MovingJoint(
                    joint,
                    carrier,
                    frame[:3, :3] @ joint.axis,
                    frame[:3, :3] @ joint.anchor + frame[:3, 3],
                    frame,
                    tuple(bodies[index]),
                    tuple(links[index]),
                )
                for index, (joint, carrier, frame) in enumerate(found)
            ),
            root=self.root,
            base_links=tuple(links[None]),
            gravity=self._upright().T @ self.robot.gravity,
            remarks=tuple(self.remarks),
            pairs=tuple(self.pairs),
        )

    def _reached(self) -> list[SourceJoint]:
        """Joints below the root, depth first."""
        reached: list[SourceJoint] = []
        stack = self.below.get(self.root, [])[::-1]
        while stack:
            joint = stack.pop()
            reached.append(joint)
            stack += self.below.get(joint.child, [])[::-1]
        return reached

    def _held(self, lock: Mapping[str, float]) -> dict[str, float]:
        """Coordinates of the joints that --lock holds, and of those that mimic them."""
        for name, at in lock.items():
            if name not in self.by_name:
                raise InputError(f"--lock: there is no joint '{name}'{_near(name, self.by_name)}")
            joint = self.by_name[name]
            if joint.kind not in MOVING:
                raise InputError(f"--lock: joint {name} is {joint.kind}, expected one degree of freedom")
            if joint.position and not joint.position[0] <= at <= joint.position[1]:
                low, high = joint.position
                self.remarks.append(
                    f"joint {name}: locked at {at:g}, outside its range {low:g} to {high:g}; kept as given"
                )
        held = dict(lock)
        for joint in self.robot.joints:
            value = self._mimicked(joint, held)
            if value is not None:
                held.setdefault(joint.name, value)
        return held

    def _mimicked(self, joint: SourceJoint, held: Mapping[str, float]) -> float | None:
        """Where a joint stands whose master, or the master's own, is held; None where none is."""
        factor, offset, passed = 1.0, 0.0, {joint.name}
        while joint.mimic is not None:
            offset += factor * joint.mimic.offset
            factor *= joint.mimic.multiplier
            if joint.mimic.master not in self.by_name:
                return None
            joint = self.by_name[joint.mimic.master]
            if joint.name in held:
                return factor * held[joint.name] + offset
            if joint.name in passed:
                return None
            passed.add(joint.name)
        return None

    def _wanted(self) -> set[str]:
        """Names of the joints that stay in the model."""
        reached = self._reached()
        if self.tip is not None:
            way: list[SourceJoint] = []
            link = self.tip
            while link != self.root:
                if link not in self.above:
                    raise InputError(f"--tip: link {self.tip} does not stand on {self.root}")
                way.append(self.above[link])
                link = self.above[link].parent
            beside = [j for j in reached if j not in way and j.kind != "fixed" and j.name not in self.held]
            if beside:
                listed = ", ".join(j.name for j in beside[:8]) + (", …" if len(beside) > 8 else "")
                self.remarks.append(f"held where they are drawn, beside the way to {self.tip}: {listed}")
            reached = [j for j in reached if j in way]
        wanted = [j for j in reached if j.kind != "fixed" and j.name not in self.held]
        for joint in wanted:
            if joint.kind not in MOVING:
                raise InputError(
                    f"joint {joint.name} is {joint.kind}: only joints of one degree of freedom are imported"
                    f"; --root {joint.child} takes what stands on it",
                    self.robot.where(joint.line),
                )
        names = {joint.name for joint in wanted}
        for joint in wanted:
            if joint.mimic is not None:
                master = joint.mimic.master
                both = f", or both, --lock {master}=0" if master in self.by_name else ""
                raise InputError(
                    f"joint {joint.name} mimics {master}: coupled coordinates are not described"
                    f"; hold it, --lock {joint.name}=0{both}",
                    self.robot.where(joint.line),
                )
        for closure in self.robot.closures:
            involved = [name for name in closure.joints if name in names]
            pair = closure.pair
            if pair is not None and len(involved) == 2 and all(p.joint != pair.joint for p in self.pairs):
                self.pairs.append(pair)
                continue
            if involved or self._moving_links(closure.links, names):
                raise InputError(closure.text, self.robot.where(closure.line))
        return names

    def _moving_links(self, links: tuple[str, ...], names: set[str]) -> bool:
        """Whether one of the links moves."""
        for name in links:
            link = name
            while link in self.above:
                if self.above[link].name in names:
                    return True
                link = self.above[link].parent
        return False

    def _hold(self, joint: SourceJoint) -> Array:
        """Motion of a joint that does not move in the model, from the drawn pose."""
        if joint.kind not in MOVING or joint.name not in self.held:
            return np.eye(4)
        return moved(joint.kind, joint.axis, joint.anchor, self.held[joint.name] - joint.reference)

    def _upright(self) -> Array:
        """Rotation (3, 3) of the root against the source's own root, all joints between held."""
        frame = np.eye(4)
        link = self.root
        while link in self.above:
            joint = self.above[link]
            frame = joint.pose @ self._hold(joint) @ frame
            link = joint.parent
        return np.asarray(frame[:3, :3])


def _near(name: str, options: Mapping[str, object]) -> str:
    near = difflib.get_close_matches(name, list(options), n=1)
    if near:
        return f", did you mean '{near[0]}'?"
    listed = list(options)
    return f"; available: {', '.join(listed[:12])}{', …' if len(listed) > 12 else ''}"
