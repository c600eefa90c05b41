"""What MJCF says once for the whole model: the compiler's settings, and defaults by class."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from modelgen.importing.poses import from_axis_angle, from_quaternion, pose, rotation
from modelgen.importing.rounded import Rounding
from modelgen.importing.xml_text import Element
from modelgen.numeric import Array

ACTUATORS = (
    "general",
    "motor",
    "position",
    "velocity",
    "intvelocity",
    "damper",
    "cylinder",
    "muscle",
    "adhesion",
    "dcmotor",
    "pid",
)
MAIN = "main"  # the class that holds for all


@dataclass
class Compiler:
    """Settings of <compiler>, as MuJoCo has them where the file says nothing."""

    rounding: Rounding
    degrees: bool = True
    autolimits: bool = True
    eulerseq: str = "xyz"
    from_geoms: str = "auto"

    def read(self, root: Element) -> None:
        """Take over what the file says. Raises InputError for settings that would change the masses."""
        for element in root.all("compiler"):
            given = element.attributes
            self.degrees = given.get("angle", "degree" if self.degrees else "radian") != "radian"
            self.autolimits = given.get("autolimits", "true" if self.autolimits else "false") != "false"
            self.eulerseq = given.get("eulerseq", self.eulerseq)
            self.from_geoms = given.get("inertiafromgeom", self.from_geoms)
            if len(self.eulerseq) != 3 or set(self.eulerseq.lower()) - set("xyz"):
                raise element.error(f"<compiler eulerseq>: found '{self.eulerseq[:10]}', expected xyz, say")
            for name in ("settotalmass", "boundmass", "boundinertia"):
                if element.number(name, 0.0) > 0:
                    raise element.error(f"<compiler {name}> changes the masses, which is not imported")

    def angle(self, element: Element, name: str, default: float = 0.0) -> float:
        """An angle [rad]."""
        return float(self.angles(element, name, 1)[0]) if name in element.attributes else default

    def angles(self, element: Element, name: str, size: int) -> Array:
        """Angles [rad]."""
        if self.degrees:
            return element.vector(name, size) * (math.pi / 180)
        return element.angles(name, size, self.rounding)

    def pose(self, element: Element) -> Array:
        """Pose (4, 4) of an element in what holds it."""
        return pose(self._turn(element), element.vector("pos", 3, np.zeros(3)))

    def _turn(self, element: Element) -> Array:
        given = element.attributes
        if "quat" in given:
            return from_quaternion(_direction(element, "quat", 4))
        if "axisangle" in given:
            values = element.vector("axisangle", 4)
            angle = values[3] * math.pi / 180 if self.degrees else values[3]
            if not np.linalg.norm(values[:3]) > 0:
                raise element.error(f"<{element.tag} axisangle>: its axis is zero, expected a direction")
            return from_axis_angle(values[:3], angle)
        if "euler" in given:
            turn = np.eye(3)
            for letter, angle in zip(self.eulerseq, self.angles(element, "euler", 3), strict=True):
                single = rotation("xyz".index(letter.lower()), angle)
                turn = turn @ single if letter.islower() else single @ turn
            return turn
        if "xyaxes" in given:
            x, y = np.split(element.vector("xyaxes", 6), 2)
            x = x / np.linalg.norm(x)
            y = y - (x @ y) * x
            y = y / np.linalg.norm(y)
            return np.column_stack([x, y, np.cross(x, y)])
        if "zaxis" in given:
            return along_z(_direction(element, "zaxis", 3))
        return np.eye(3)


def along_z(direction: Array) -> Array:
    """The least turn (3, 3) that takes z to a direction."""
    z = direction / np.linalg.norm(direction)
    axis = np.array([-z[1], z[0], 0.0])
    sine = float(np.linalg.norm(axis))
    if sine < 1e-15:
        return np.eye(3) if z[2] > 0 else rotation(0, math.pi)
    return from_axis_angle(axis, math.atan2(sine, z[2]))


def _direction(element: Element, name: str, size: int) -> Array:
    value = element.vector(name, size)
    if not np.linalg.norm(value) > 0:
        raise element.error(f"<{element.tag} {name}>: found zeros, expected a direction")
    return value


@dataclass
class Defaults:
    """Attributes by class and tag, those of the class above included. All actuators share a tag."""

    classes: dict[str, dict[str, dict[str, str]]] = field(default_factory=lambda: {MAIN: {}})

    def read(self, root: Element) -> None:
        """Take over the <default> elements of the file."""
        for element in root.all("default"):
            self._read(element, element.attributes.get("class", MAIN), {})

    def _read(self, element: Element, name: str, above: dict[str, dict[str, str]]) -> None:
        own = {tag: dict(attributes) for tag, attributes in (self.classes.get(name) or above).items()}
        for child in element.children:
            if child.tag != "default":
                own.setdefault(_tag(child), {}).update(child.attributes)
        self.classes[name] = own
        for child in element.all("default"):
            self._read(child, child.text("class"), own)

    def complete(self, element: Element, inherited: str | None) -> Element:
        """The element with the attributes that its class, or the inherited one, gives it."""
        name = element.attributes.get("class", inherited or MAIN)
        if name not in self.classes:
            raise element.error(f"<{element.tag}>: there is no default class '{name}'")
        attributes = self.classes[name].get(_tag(element), {}) | element.attributes
        return Element(element.tag, attributes, element.file, element.line, element.children)


def _tag(element: Element) -> str:
    return "actuator" if element.tag in ACTUATORS else element.tag
