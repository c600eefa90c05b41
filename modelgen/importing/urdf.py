"""URDF: links, joints, their limits, damping, friction and gears. Meshes and colours are passed over."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from modelgen.importing.bodies import body_of
from modelgen.importing.poses import from_rpy, pose
from modelgen.importing.robot import Body, Mimic, Robot, SourceJoint, SourceLink
from modelgen.importing.rounded import Rounding
from modelgen.importing.xml_text import Element
from modelgen.numeric import Array

KINDS = {"revolute": "revolute", "continuous": "revolute", "prismatic": "prismatic", "fixed": "fixed"}
# Kinds of several degrees of freedom: refused later, if they are to move.
OTHERS = ("floating", "planar", "spherical", "screw")
UNLIMITED = 1e9  # rad/s, m/s, N m, N: URDF demands limits, and this is none
_UP = np.array([1.0, 0.0, 0.0])  # the axis of a joint that names none, as URDF has it


def read_urdf(root: Element, rounding: Rounding) -> Robot:
    """The robot of a <robot> element. rounding: what is made of angles such as 1.5708.

    Raises InputError, with the line, at the first mistake.
    """
    _refuse_xacro(root)
    links = {link.name: link for link in _links(root, rounding)}
    if not links:
        raise root.error("<robot> has no <link>")
    reductions = _reductions(root)
    joints = tuple(_joint(element, links, reductions, rounding) for element in root.all("joint"))
    _unique(root, joints)
    return Robot(
        name=root.attributes.get("name", "").strip(),
        form="URDF",
        root=_root(root, links, joints),
        links=links,
        joints=joints,
    )


def _refuse_xacro(root: Element) -> None:
    for element in root.below():
        if element.tag.startswith("xacro:"):
            raise element.error(f"found <{element.tag}>; expand it first: xacro FILE > robot.urdf")


def _links(root: Element, rounding: Rounding) -> Iterator[SourceLink]:
    seen: set[str] = set()
    for element in root.all("link"):
        name = element.text("name")
        if name in seen:
            raise element.error(f"two links are called '{name}'")
        seen.add(name)
        yield SourceLink(name, _body(element, rounding), element.line)


def _body(link: Element, rounding: Rounding) -> Body | None:
    inertial = link.first("inertial")
    if inertial is None:
        return None
    mass, tensor = inertial.first("mass"), inertial.first("inertia")
    if mass is None:
        raise inertial.error(f"link {link.text('name')}: <inertial> has no <mass>")
    if tensor is None:
        raise inertial.error(f"link {link.text('name')}: <inertial> has no <inertia>")
    place = _origin(inertial, rounding)
    six = [tensor.number(name) for name in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")]
    return body_of(mass.number("value"), place, six)


def _origin(element: Element, rounding: Rounding) -> Array:
    origin = element.first("origin")
    if origin is None:
        return np.eye(4)
    turn = from_rpy(origin.angles("rpy", 3, rounding)) if "rpy" in origin.attributes else np.eye(3)
    return pose(turn, origin.vector("xyz", 3, np.zeros(3)))


def _joint(
    element: Element, links: dict[str, SourceLink], reductions: dict[str, float], rounding: Rounding
) -> SourceJoint:
    name, word = element.text("name"), element.text("type")
    if word not in KINDS and word not in OTHERS:
        known = ", ".join((*KINDS, *OTHERS))
        raise element.error(f"joint {name}: found the type '{word}', expected one of {known}")
    ends = []
    for tag in ("parent", "child"):
        end = element.first(tag)
        if end is None:
            raise element.error(f"joint {name}: <{tag} link=…> is missing")
        if end.text("link") not in links:
            raise end.error(f"joint {name}: there is no link '{end.text('link')}'")
        ends.append(end.text("link"))
    limit, dynamics = element.first("limit"), element.first("dynamics")
    properties = {} if dynamics is None else _dynamics(dynamics)
    position = velocity = effort = None
    if limit is not None:
        position = _range(limit) if word in ("revolute", "prismatic") else None
        velocity, effort = (limit.number(which, 0.0) for which in ("velocity", "effort"))
    return SourceJoint(
        name=name,
        kind=KINDS.get(word, word),
        parent=ends[0],
        child=ends[1],
        pose=_origin(element, rounding),
        axis=_axis(element, name, KINDS.get(word, word)),
        position=position,
        velocity=velocity if velocity and 0 < velocity < UNLIMITED else None,
        effort=effort if effort and 0 < effort < UNLIMITED else None,
        properties=properties,
        reduction=reductions.get(name, 1.0),
        mimic=_mimic(element),
        line=element.line,
    )


def _axis(element: Element, name: str, kind: str) -> Array:
    given = element.first("axis")
    axis = _UP if given is None else given.vector("xyz", 3, _UP)
    length = float(np.linalg.norm(axis))
    if length < 1e-9:
        if kind == "fixed":
            return _UP
        raise (given or element).error(f"joint {name}: its axis is zero, expected a direction")
    return np.asarray(axis / length)


def _range(limit: Element) -> tuple[float, float] | None:
    low, high = limit.number("lower", 0.0), limit.number("upper", 0.0)
    if low > high:
        raise limit.error(f"<limit>: found {low:g} to {high:g}, expected the lower end first")
    return (low, high) if low < high else None


def _dynamics(dynamics: Element) -> dict[str, float]:
    found = {name: dynamics.number(name, 0.0) for name in ("damping", "friction")}
    for name, value in found.items():
        if value < 0:
            raise dynamics.error(f"<dynamics {name}>: found {value:g}, expected 0 or more")
    return {name: value for name, value in found.items() if value}


def _mimic(element: Element) -> Mimic | None:
    mimic = element.first("mimic")
    if mimic is None:
        return None
    return Mimic(mimic.text("joint"), mimic.number("multiplier", 1.0), mimic.number("offset", 0.0))


def _reductions(root: Element) -> dict[str, float]:
    """Gear ratios of simple transmissions by joint; those of several joints are left to the user."""
    found: dict[str, float] = {}
    for transmission in root.all("transmission"):
        joints = transmission.all("joint")
        if len(joints) != 1 or "name" not in joints[0].attributes:
            continue
        for element in transmission.below():
            if element.tag == "mechanicalReduction":
                value = _number(element.content)
                if value is not None:
                    found[joints[0].text("name")] = value
    return found


def _number(text: str) -> float | None:
    try:
        value = float(text)
    except ValueError:
        return None
    return value if np.isfinite(value) and value != 0 else None


def _unique(root: Element, joints: tuple[SourceJoint, ...]) -> None:
    seen: set[str] = set()
    for element, joint in zip(root.all("joint"), joints, strict=True):
        if joint.name in seen:
            raise element.error(f"two joints are called '{joint.name}'")
        seen.add(joint.name)


def _root(root: Element, links: dict[str, SourceLink], joints: tuple[SourceJoint, ...]) -> str:
    """The one link that no joint carries; every other is carried by one."""
    carried: dict[str, str] = {}
    for element, joint in zip(root.all("joint"), joints, strict=True):
        if joint.child in carried:
            raise element.error(
                f"link {joint.child} is carried by the joints {carried[joint.child]} and {joint.name}: "
                "loops are not imported; open it at one of them"
            )
        carried[joint.child] = joint.name
    free = [name for name in links if name not in carried]
    if not free:
        raise root.error("the joints form a loop: every link is carried by a joint, expected one that is not")
    if len(free) > 1:
        raise root.error(
            f"found {len(free)} links that no joint carries, expected one: {', '.join(free[:6])}"
            f"{', …' if len(free) > 6 else ''}"
        )
    _stands(root, free[0], joints)
    return free[0]


def _stands(root: Element, base: str, joints: tuple[SourceJoint, ...]) -> None:
    """A joint that does not stand on the base, where each link is carried once, is part of a loop."""
    above = {joint.child: joint for joint in joints}
    standing = {base}
    for element, joint in zip(root.all("joint"), joints, strict=True):
        way: list[SourceJoint] = []
        link = joint.child
        while link not in standing:
            if any(passed.child == link for passed in way):
                loop = ", ".join(sorted(j.name for j in way[[j.child for j in way].index(link) :]))
                raise element.error(f"the joints {loop} carry each other: loops are not imported")
            way.append(above[link])
            link = above[link].parent
        standing |= {passed.child for passed in way}
