"""MJCF: bodies, joints of one degree of freedom, what drives and resists them. Meshes are passed over."""

from __future__ import annotations

import numpy as np

from modelgen.importing.mjcf.bodies import GENERATED, WORLD, Bodies
from modelgen.importing.mjcf.couplings import closures_of, with_actuators
from modelgen.importing.mjcf.levers import with_levers
from modelgen.importing.mjcf.settings import Compiler, Defaults
from modelgen.importing.robot import Robot
from modelgen.importing.rounded import Rounding
from modelgen.importing.xml_text import Element

_UP = np.array([0.0, 0.0, -9.81])


def read_mjcf(root: Element, rounding: Rounding) -> Robot:
    """The model of a <mujoco> element. rounding: what is made of angles such as 1.5708.

    Raises InputError, with the line, at the first mistake.
    """
    for element in root.children:
        if element.tag in GENERATED:
            raise element.error(
                f"<{element.tag}> is not read: load the model in MuJoCo and save it, which writes it out"
            )
    compiler, defaults = Compiler(rounding), Defaults()
    compiler.read(root)
    defaults.read(root)
    bodies = Bodies(compiler, defaults)
    bodies.read(root)
    levers = with_levers(root, compiler, defaults, bodies.joints)
    joints, remarks = with_actuators(root, defaults, levers)
    gravity = _UP
    for option in root.all("option"):
        gravity = option.vector("gravity", 3, gravity)
        for name in ("density", "viscosity"):
            if option.number(name, 0.0) > 0:
                remarks.append(f"<option {name}>: MuJoCo's fluid forces are left out")
        for flag in option.all("flag"):
            if flag.attributes.get("gravity") == "disable":
                gravity = np.zeros(3)
    return Robot(
        name=root.attributes.get("model", "").strip(),
        form="MJCF",
        root=WORLD,
        links={name: link for name, link in bodies.links.items() if name not in levers.sites},
        joints=tuple(joints),
        gravity=gravity,
        closures=tuple(closures_of(root, defaults, levers.tendons.values())),
        remarks=(*bodies.remarks, *remarks),
    )
