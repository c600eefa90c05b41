"""The tree of MJCF's bodies: one link each, its joints one after the other, its sites as links too."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from modelgen.importing.bodies import body_of, together
from modelgen.importing.mjcf.geoms import geom_body
from modelgen.importing.mjcf.settings import Compiler, Defaults
from modelgen.importing.robot import Body, SourceJoint, SourceLink
from modelgen.importing.xml_text import Element
from modelgen.numeric import Array

KINDS = {"hinge": "revolute", "slide": "prismatic", "ball": "ball", "free": "free"}
WORLD = "world"
# What would add bodies or joints that are not written in the file.
GENERATED = ("include", "replicate", "attach", "composite", "flexcomp")


@dataclass(frozen=True)
class Placed:
    """An element of a body, with the pose (4, 4) of the frames around it there and the class it inherits."""

    element: Element
    frame: Array
    inherited: str | None


@dataclass
class Bodies:
    """Links and joints as they are found."""

    compiler: Compiler
    defaults: Defaults
    links: dict[str, SourceLink] = field(default_factory=dict)
    joints: list[SourceJoint] = field(default_factory=list)
    remarks: list[str] = field(default_factory=list)

    def read(self, root: Element) -> None:
        """All bodies of the file. Raises InputError, with the line, at the first mistake."""
        self.links[WORLD] = SourceLink(WORLD)
        # depth first, in the order of the file: a body, its parent's link, and the frame it is given there
        stack: list[tuple[str, Placed]] = []
        for world in root.all("worldbody"):
            stack += [(WORLD, child) for child in self._inside(world, None) if child.element.tag == "body"]
        stack.reverse()
        while stack:
            parent, body = stack.pop()
            name, inside = self._body(parent, body)
            stack += [(name, child) for child in reversed(inside) if child.element.tag == "body"]

    def _inside(
        self, element: Element, inherited: str | None, frame: Array | None = None
    ) -> Iterator[Placed]:
        """What a body holds, frames opened."""
        frame = np.eye(4) if frame is None else frame
        inherited = element.attributes.get("childclass", inherited)
        for child in element.children:
            if child.tag in GENERATED:
                raise child.error(
                    f"<{child.tag}> is not read: load the model in MuJoCo and save it, which writes it out"
                )
            if child.tag == "frame":
                yield from self._inside(child, inherited, frame @ self.compiler.pose(child))
            else:
                yield Placed(child, frame, inherited)

    def _body(self, parent: str, body: Placed) -> tuple[str, list[Placed]]:
        """Add a body; its name and what it holds."""
        element = body.element
        name = self._name(element, element.attributes.get("name") or f"body{len(self.links)}", "bodies")
        inside = list(self._inside(element, body.inherited))
        self.links[name] = SourceLink(name, self._inertial(element, name, inside), element.line)
        if element.number("gravcomp", 0.0) != 0.0:
            self.remarks.append(f"body {name}: gravcomp is left out, its weight counts whole")
        place = body.frame @ self.compiler.pose(element)
        found = [child for child in inside if child.element.tag in ("joint", "freejoint")]
        if not found:
            self.joints.append(SourceJoint(f"{name}_fixed", "fixed", parent, name, place))
        for k, child in enumerate(found):
            # several joints in a body: links without mass between them
            last = k == len(found) - 1
            after = name if last else f"{name}/{k + 1}"
            if not last:
                self.links[after] = SourceLink(after)
            wished = f"{name}_joint{'' if len(found) == 1 else k + 1}"
            self.joints.append(self._joint(child, wished, parent, after, place if k == 0 else np.eye(4)))
            parent = after
        for child in inside:
            if child.element.tag == "site" and "name" in child.element.attributes:
                self._site(child, name)
        return name, inside

    def _name(self, element: Element, name: str, what: str) -> str:
        if name in self.links:
            raise element.error(f"two {what} are called '{name}'")
        return name

    def _site(self, placed: Placed, body: str) -> None:
        site = self.defaults.complete(placed.element, placed.inherited)
        name = site.text("name")
        name = f"{name}_site" if name in self.links else name
        self.links[name] = SourceLink(name)
        place = placed.frame @ self.compiler.pose(site)
        self.joints.append(SourceJoint(f"{name}_fixed", "fixed", body, name, place))

    # -- joints ---------------------------------------------------------------------------

    def _joint(self, placed: Placed, wished: str, parent: str, child: str, place: Array) -> SourceJoint:
        joint = self.defaults.complete(placed.element, placed.inherited)
        name = joint.attributes.get("name") or wished
        if any(other.name == name for other in self.joints):
            raise joint.error(f"two joints are called '{name}'")
        word = "free" if joint.tag == "freejoint" else joint.attributes.get("type", "hinge")
        if word not in KINDS:
            raise joint.error(f"joint {name}: found the type '{word}', expected one of {', '.join(KINDS)}")
        kind = KINDS[word]
        if kind not in ("revolute", "prismatic"):
            return SourceJoint(name, kind, parent, child, place, line=joint.line)
        axis = placed.frame[:3, :3] @ joint.vector("axis", 3, np.array([0.0, 0.0, 1.0]))
        length = float(np.linalg.norm(axis))
        if length < 1e-9:
            raise joint.error(f"joint {name}: its axis is zero, expected a direction")
        anchor = placed.frame @ np.append(joint.vector("pos", 3, np.zeros(3)), 1.0)
        if "springdamper" in joint.attributes and np.any(joint.vector("springdamper", 2)):
            raise joint.error(f"joint {name}: springdamper is not read, give stiffness and damping")
        return SourceJoint(
            name=name,
            kind=kind,
            parent=parent,
            child=child,
            pose=place,
            axis=axis / length,
            anchor=anchor[:3],
            reference=self._coordinate(joint, kind, "ref"),
            position=self._range(joint, kind),
            effort=_effort(joint),
            properties=self._properties(joint, kind, name),
            line=joint.line,
        )

    def _coordinate(self, joint: Element, kind: str, name: str) -> float:
        if kind == "prismatic":
            return joint.number(name, 0.0)
        return self.compiler.angle(joint, name)

    def _range(self, joint: Element, kind: str) -> tuple[float, float] | None:
        limited = joint.attributes.get("limited", "auto")
        if "range" not in joint.attributes or limited == "false":
            return None
        if limited == "auto" and not self.compiler.autolimits:
            return None
        ends = self.compiler.angles(joint, "range", 2) if kind == "revolute" else joint.vector("range", 2)
        if ends[0] > ends[1]:
            given = joint.attributes["range"]
            raise joint.error(f"<joint range>: found '{given}', expected the lower end first")
        return (float(ends[0]), float(ends[1])) if ends[0] < ends[1] else None

    def _properties(self, joint: Element, kind: str, name: str) -> dict[str, float]:
        named = {"friction": "frictionloss", "armature": "armature"}
        found = joint.damping() | {own: joint.number(theirs, 0.0) for own, theirs in named.items()}
        stiffness = joint.number("stiffness", 0.0)
        if stiffness:
            found |= {"stiffness": stiffness, "rest": self._coordinate(joint, kind, "springref")}
        for own, value in found.items():
            if value < 0 and own != "rest":
                raise joint.error(f"joint {name}: found {named.get(own, own)} {value:g}, expected 0 or more")
        return {own: value for own, value in found.items() if value}

    # -- inertia --------------------------------------------------------------------------

    def _inertial(self, body: Element, name: str, inside: list[Placed]) -> Body | None:
        given = body.first("inertial")
        if given is not None and self.compiler.from_geoms != "true":
            return self._explicit(given, name)
        if self.compiler.from_geoms == "false":
            return None
        geoms = [child for child in inside if child.element.tag == "geom"]
        found = [
            geom_body(self.defaults.complete(geom.element, geom.inherited), self.compiler, geom.frame)
            for geom in geoms
        ]
        bodies = [body for body in found if body is not None]
        return together(bodies) if bodies else None

    def _explicit(self, inertial: Element, name: str) -> Body:
        mass = inertial.number("mass")
        place = self.compiler.pose(inertial)
        if "fullinertia" in inertial.attributes:
            xx, yy, zz, xy, xz, yz = inertial.vector("fullinertia", 6)
            return body_of(mass, place, (xx, xy, xz, yy, yz, zz))
        if "diaginertia" in inertial.attributes:
            xx, yy, zz = inertial.vector("diaginertia", 3)
            return body_of(mass, place, (xx, 0.0, 0.0, yy, 0.0, zz))
        raise inertial.error(f"body {name}: <inertial> has neither diaginertia nor fullinertia")


def _effort(joint: Element) -> float | None:
    if "actuatorfrcrange" not in joint.attributes:
        return None
    if joint.attributes.get("actuatorfrclimited", "auto") == "false":
        return None
    return float(np.abs(joint.vector("actuatorfrcrange", 2)).max()) or None
