"""Linear actuators of MJCF: a tendon between two sites that one hinge turns against each other."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from modelgen.importing.mjcf.bodies import WORLD
from modelgen.importing.mjcf.settings import Compiler, Defaults
from modelgen.importing.poses import inverse
from modelgen.importing.robot import MOVING, SourceJoint, SourceLever
from modelgen.importing.xml_text import Element
from modelgen.numeric import Array

FLAT = 1e-9  # m, out of the plane of a lever; MuJoCo normalises quaternions
CLEARANCE = math.radians(1.0)  # from its dead centres, that a lever without a range keeps


@dataclass
class Levers:
    """What was found. joints: with their levers, without what stood for the sites. tendons: names of those
    that are levers, by the joint that they turn. sites: of their ends.
    """

    joints: list[SourceJoint]
    tendons: dict[str, str] = field(default_factory=dict)
    sites: set[str] = field(default_factory=set)


def with_levers(
    root: Element, compiler: Compiler, defaults: Defaults, joints: Sequence[SourceJoint]
) -> Levers:
    """The joints with the levers that drive them; tendons that are none are left to others."""
    found = Levers(list(joints))
    ground = [site for world in root.all("worldbody") for site in world.all("site")]
    fixed = [
        SourceJoint(name, "fixed", WORLD, name, compiler.pose(site))
        for site in ground
        if (name := site.attributes.get("name", ""))
    ]
    for section in root.all("tendon"):
        for element in section.all("spatial"):
            tendon = defaults.complete(element, None)
            ends = [part.text("site") for part in tendon.all("site")]
            if len(ends) != 2 or len(tendon.children) != 2 or "name" not in tendon.attributes:
                continue
            made = _lever(tendon, ends, [*found.joints, *fixed])
            if made is not None:
                found.tendons[made.name] = tendon.text("name")
                found.sites |= set(ends)
                found.joints = [made if joint.name == made.name else joint for joint in found.joints]
    found.joints = [joint for joint in found.joints if joint.child not in found.sites]
    return found


def _lever(tendon: Element, ends: Sequence[str], joints: Sequence[SourceJoint]) -> SourceJoint | None:
    """The hinge with its lever, None where the tendon is none."""
    carriers = {joint.child: joint for joint in joints}
    if any(end not in carriers for end in ends):
        return None
    chains = [_chain(end, carriers) for end in ends]
    known = [{joint.name for joint in chain} for chain in chains]
    own = [[joint for joint in chain if joint.name not in known[1 - k]] for k, chain in enumerate(chains)]
    moving = [(k, joint) for k in (0, 1) for joint in own[k] if joint.kind != "fixed"]
    if len(moving) != 1 or moving[0][1].kind != MOVING[0] or moving[0][1].lever is not None:
        return None
    side, joint = moving[0]
    frames = [_frame(chain) for chain in chains]
    here = inverse(_frame(_chain(joint.child, carriers)))
    tip, base = ((here @ frames[k])[:3, 3] - joint.anchor for k in (side, 1 - side))
    lever = _triangle(joint, base, tip)
    if lever is None or set(tendon.attributes) & {"range", "springlength"}:
        return None
    named = {"friction": "frictionloss", "armature": "armature"}
    properties = {own: tendon.number(theirs, 0.0) for own, theirs in named.items()} | tendon.damping()
    if tendon.number("stiffness", 0.0) or any(name in joint.properties for name in properties):
        return None
    kept = {name: value for name, value in properties.items() if value}
    return replace(joint, lever=lever, properties={**joint.properties, **kept})


def _chain(link: str, carriers: Mapping[str, SourceJoint]) -> list[SourceJoint]:
    """The joints from the root to a link."""
    found: list[SourceJoint] = []
    while link in carriers:
        found.append(carriers[link])
        link = carriers[link].parent
    return found[::-1]


def _frame(chain: Sequence[SourceJoint]) -> Array:
    """Root <- the last joint's child (4, 4), drawn pose."""
    frame = np.eye(4)
    for joint in chain:
        frame = frame @ joint.pose
    return frame


def _triangle(joint: SourceJoint, base: Array, tip: Array) -> SourceLever | None:
    """The lever of two points, seen from the joint's axis; None where they make none on all the range."""
    if abs(float((tip - base) @ joint.axis)) > FLAT:
        return None
    base, tip = (x - (x @ joint.axis) * joint.axis for x in (base, tip))
    l1, l2 = float(np.linalg.norm(base)), float(np.linalg.norm(tip))
    if min(l1, l2) <= FLAT:
        return None
    drawn = math.atan2(float(joint.axis @ np.cross(base, tip)), float(base @ tip))
    offset = joint.reference - drawn
    if joint.position is None:
        rev = 1 if drawn >= 0 else -1
        angles = (CLEARANCE, math.pi - CLEARANCE)
    else:
        middle = sum(joint.position) / 2
        turned = math.remainder(middle - offset, math.tau)
        rev = 1 if turned >= 0 else -1
        offset = middle - turned
        angles = (rev * (joint.position[0] - offset), rev * (joint.position[1] - offset))
        if not all(0 < angle < math.pi for angle in angles):
            return None
    lengths = [math.sqrt(l1**2 + l2**2 - 2 * l1 * l2 * math.cos(angle)) for angle in angles]
    return SourceLever(l1, l2, rev, offset, (lengths[0], lengths[1]))
