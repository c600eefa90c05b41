"""What MJCF ties together besides the tree, and what drives the joints: equalities, tendons, actuators."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import replace

import numpy as np

from modelgen.importing.mjcf.levers import Levers
from modelgen.importing.mjcf.passive import passive_laws
from modelgen.importing.mjcf.settings import ACTUATORS, Defaults
from modelgen.importing.resistance import POWERS
from modelgen.importing.robot import Closure, SourceJoint, SourcePair
from modelgen.importing.xml_text import Element

# Attributes by which a tendon acts on what it runs along.
_ACTS = ("stiffness", "damping", "frictionloss", "armature", "range", "springlength")
# Power of a joint's coefficient by which a property is greater there than along the tendon.
ALONG = {"armature": 2, "damping": 2, "friction": 1}


def closures_of(root: Element, defaults: Defaults, levers: Collection[str]) -> Iterator[Closure]:
    """Equalities and tendons, but for those that are levers: refused where they hold what moves."""
    pulled = _pulled(root, defaults)
    for section in root.all("equality"):
        for element in section.children:
            given = defaults.complete(element, None).attributes
            if given.get("active", "true") != "false":
                yield _equality(element, given)
    for section in root.all("tendon"):
        for element in section.children:
            tendon = defaults.complete(element, None)
            name = tendon.attributes.get("name", f"of line {tendon.line}")
            if name in levers or (name not in pulled and not any(_acts(tendon, which) for which in _ACTS)):
                continue
            text = f"tendon {name} acts on several joints, which is not described"
            yield Closure(
                f"{text}; hold them (--lock), or take it out",
                joints=tuple(part.text("joint") for part in tendon.all("joint")),
                links=tuple(part.text("site") for part in tendon.all("site")),
                line=tendon.line,
                pair=None if name in pulled else _pair(tendon),
            )


def _pair(tendon: Element) -> SourcePair | None:
    """What turns with two joints and has inertia or friction alone; None where it is more."""
    parts = tendon.all("joint")
    found = tendon.damping() | {
        own: tendon.number(theirs, 0.0)
        for own, theirs in (("armature", "armature"), ("friction", "frictionloss"))
    }
    if tendon.tag != "fixed" or len(parts) != 2 or len(tendon.children) != 2 or set(found) - set(ALONG):
        return None
    if any(_acts(tendon, name) for name in ("stiffness", "range", "springlength")):
        return None
    first, second = (part.number("coef") for part in parts)
    if first == 0.0 or second == 0.0:
        return None
    scaled = {own: value * abs(first) ** ALONG[own] for own, value in found.items()}
    return SourcePair(parts[0].text("joint"), parts[1].text("joint"), second / first, scaled)


def _equality(element: Element, given: dict[str, str]) -> Closure:
    name = given.get("name", "")
    text = f"equality {name or element.tag} closes a loop or couples joints, which is not "
    joints = tuple(given[key] for key in ("joint1", "joint2") if key in given)
    links = tuple(given[key] for key in ("body1", "body2", "site1", "site2") if key in given)
    hint = f"; hold them, --lock {joints[0]}=0" if joints else "; open it: take it out, or hold its joints"
    return Closure(f"{text}described{hint}", joints, links, element.line)


def _pulled(root: Element, defaults: Defaults) -> set[str]:
    """Tendons that an actuator or an equality acts on."""
    names = set()
    for section in root.all("actuator", "equality"):
        for element in section.children:
            given = defaults.complete(element, None).attributes
            names |= {given[key] for key in ("tendon", "tendon1", "tendon2") if key in given}
    return names


def _acts(tendon: Element, name: str) -> bool:
    text = tendon.attributes.get(name, "0")
    return any(value not in ("0", "0.0", "-1") for value in text.split())


def with_actuators(root: Element, defaults: Defaults, levers: Levers) -> tuple[list[SourceJoint], list[str]]:
    """The joints with the gears, efforts and rotors of their actuators, and remarks."""
    by_name = {joint.name: joint for joint in levers.joints}
    turned = {tendon: joint for joint, tendon in levers.tendons.items()}
    remarks: list[str] = []
    seen: dict[str, str] = {}
    passive: list[tuple[str, str, Element, float]] = []
    for section in root.all("actuator"):
        for element in section.children:
            actuator = defaults.complete(element, None)
            name = actuator.attributes.get("name", f"of line {actuator.line}")
            given = actuator.attributes
            target = given.get("joint") or given.get("jointinparent") or turned.get(given.get("tendon", ""))
            if actuator.tag not in ACTUATORS or target is None:
                remarks.append(f"actuator {name} drives no joint of its own and is left out")
                continue
            if target not in by_name:
                raise actuator.error(f"actuator {name}: there is no joint '{target}'")
            gear = _gear(actuator)
            if given.get("input") == "none":
                passive.append((name, target, actuator, gear))
                continue
            if target in seen:
                remarks.append(f"joint {target}: {seen[target]} is its drive, actuator {name} is left out")
                continue
            seen[target] = f"actuator {name}"
            by_name[target] = _driven(by_name[target], actuator, gear)
    for name, target, actuator, gear in passive:
        joint = by_name[target]
        found = passive_laws(actuator, gear / joint.reduction)
        known = {tuple(own) for own in joint.alone}
        if not found or any(tuple(own) in known for own in found):
            remarks.append(f"actuator {name} of joint {target} has no input and is left out")
            continue
        by_name[target] = replace(joint, alone=(*joint.alone, *found))
    return [by_name[joint.name] for joint in levers.joints], remarks


def _gear(actuator: Element) -> float:
    values = actuator.attributes.get("gear", "1").split()
    gear = Element("gear", {"gear": values[0]}, actuator.file, actuator.line).number("gear")
    if gear == 0.0:
        raise actuator.error("<… gear>: found 0, expected a ratio other than 0")
    return gear


def _driven(joint: SourceJoint, actuator: Element, gear: float) -> SourceJoint:
    properties = dict(joint.properties)
    for own, value in (actuator.damping() | {"armature": actuator.number("armature", 0.0)}).items():
        if value:
            properties[own] = properties.get(own, 0.0) + value * abs(gear) ** POWERS.get(own, 2)
    effort = joint.effort
    limited = actuator.attributes.get("forcelimited", "auto") != "false"
    if effort is None and limited and "forcerange" in actuator.attributes:
        effort = float(np.abs(actuator.vector("forcerange", 2)).max() * abs(gear)) or None
    alone = [own for own in (_push(actuator), _lag(actuator)) if own]
    gain = actuator.numbers("gainprm")[0] if actuator.tag == "general" and _fixed(actuator) else 1.0
    most = _most(actuator)
    if effort is None and gear == gain == 1.0 and joint.lever is None:
        effort = most  # input and effort are the same
    return replace(
        joint,
        properties=properties,
        reduction=gear,
        effort=effort,
        gain=gain or 1.0,
        most=most,
        alone=tuple(alone),
    )


def _most(actuator: Element) -> float | None:
    """The largest input that is a current or an effort; None where it is a set point, or has no limits."""
    feedback = actuator.attributes.get("biastype", "none") != "none" and not _push(actuator)
    given = actuator.attributes
    if "ctrlrange" not in given or given.get("ctrllimited") == "false" or feedback:
        return None
    if actuator.tag != "motor" and not (actuator.tag == "general" and _fixed(actuator)):
        return None
    return float(np.abs(actuator.vector("ctrlrange", 2)).max()) or None


def _push(actuator: Element) -> dict[str, float]:
    """A constant force against the input."""
    if actuator.tag != "general" or actuator.attributes.get("biastype") != "affine":
        return {}
    first, *others = actuator.numbers("biasprm")
    return {"force": -first} if first and not any(others) else {}


def _lag(actuator: Element) -> dict[str, float]:
    """A filter of the first order."""
    if actuator.tag != "general" or actuator.attributes.get("dyntype") not in ("filter", "filterexact"):
        return {}
    return {"lag": actuator.numbers("dynprm")[0]}


def _fixed(actuator: Element) -> bool:
    """Whether its force is a gain times the input."""
    return "gainprm" in actuator.attributes and actuator.attributes.get("gaintype", "fixed") == "fixed"
