"""MJCF, the format of MuJoCo: levers as spatial tendons, gears in the transmissions of actuators."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from modelgen.errors import InputError
from modelgen.exporting.account import Format
from modelgen.exporting.machine import POWERS, Axis, Coupling, Link, Machine, Properties
from modelgen.exporting.xml_lines import any_figure, comment, element, figure, figures, places
from modelgen.importing.bodies import doubt
from modelgen.importing.poses import to_quaternion
from modelgen.numeric import Array

STEP = 0.001  # s
# Two steps, the shortest time in which MuJoCo lets dry friction stop a joint: at rest it then creeps least.
STICKING = f"{2 * STEP:g} 1"
LEAST = 1e-12  # kg, kg m^2; MuJoCo moves no body without mass or inertia
THICK = 0.04  # of a link's length, of the capsule that shows it


def write_mjcf(machine: Machine, table: Sequence[str]) -> str:
    """The text of the file. Raises InputError for an inertia that MuJoCo refuses."""
    length = max((float(np.linalg.norm(link.pose[:3, 3])) for link in machine.links), default=0.0)
    bodies = [line for i in machine.carried(None) for line in _body(machine, i, machine.base, length)]
    anchors = [line for i in machine.carried(None) for line in _anchor(machine.links[i], machine.base)]
    tendons = _tendons(machine)
    actuators = [line for link in machine.moving for line in _actuator(link)]
    inside = [
        *comment(table),
        *element("compiler", angle="radian", autolimits="true"),
        *element("option", gravity=places(machine.gravity), timestep=figure(STEP), integrator="implicitfast"),
        *element("default", [*element("geom", contype="0", conaffinity="0", mass="0", rgba="0.5 0.6 0.7 1")]),
        *element("worldbody", [*anchors, *bodies]),
        *(element("tendon", tendons) if tendons else []),
        *element("actuator", [*actuators, *(line for link in machine.moving for line in _alone(link))]),
    ]
    return "\n".join(element("mujoco", inside, model=machine.name)) + "\n"


def _body(machine: Machine, index: int, before: Array, length: float) -> list[str]:
    """A body with all that it carries. before: pose (4, 4) of what it is given in, in its element's."""
    link = machine.links[index]
    place = before @ link.pose
    inside = [*_inertial(link), *_joint(link)]
    for tool in machine.tools:
        if tool.link == index:
            inside += element("site", name=tool.name, **_pose(tool.frame))
    if link.axis is not None and link.axis.lever is not None:
        inside += element("site", name=f"{link.name}_actuator_end", pos=places(link.axis.lever.tip))
    for i in machine.carried(index):
        inside += _anchor(machine.links[i], np.eye(4)) + _shown(machine.links[i], length)
    for i in machine.carried(index):
        inside += _body(machine, i, np.eye(4), length)
    # the ground has this name
    name = f"{link.name}_" if link.name == "world" else link.name
    return element("body", inside, name=name, **_pose(place))


def _pose(frame: Array) -> dict[str, str | None]:
    turn = to_quaternion(frame[:3, :3])
    return {
        "pos": places(frame[:3, 3]) if np.abs(frame[:3, 3]).max() > 0 else None,
        "quat": None if turn[0] == 1.0 else places(turn),
    }


def _anchor(link: Link, before: Array) -> list[str]:
    """Where the actuator of a lever stands, on the link before."""
    if link.axis is None or link.axis.lever is None:
        return []
    place = before @ np.append(link.axis.lever.base, 1.0)
    return element("site", name=f"{link.name}_actuator_base", pos=places(place[:3]))


def _shown(link: Link, length: float) -> list[str]:
    """A capsule from a joint to the next, for the eye alone."""
    place = link.pose[:3, 3]
    if float(np.linalg.norm(place)) <= 1e-3 * length:
        return []
    return element("geom", type="capsule", size=f"{THICK * length:.3g}", fromto=f"0 0 0 {places(place)}")


def _inertial(link: Link) -> list[str]:
    """Mass, centre and inertia; a little is added where MuJoCo would refuse to move the body."""
    body = link.body
    if doubt(body):
        raise InputError(
            f"link {link.name}: {doubt(body)}, which MuJoCo refuses; correct it, or give --parameters, for "
            "which bodies that could exist are found"
        )
    if body.mass == 0.0 and link.axis is None:
        return []
    mass, tensor = body.mass or LEAST, body.inertia
    low, middle, high = np.linalg.eigvalsh(tensor)
    # rounding alone makes MuJoCo refuse a thin body
    if min(low, low + middle - high) < LEAST * max(1.0, high):
        tensor = tensor + LEAST * max(1.0, high) * np.eye(3)
    six = (tensor[0, 0], tensor[1, 1], tensor[2, 2], tensor[0, 1], tensor[0, 2], tensor[1, 2])
    return element("inertial", pos=figures(body.com), mass=figure(mass), fullinertia=figures(six))


def _joint(link: Link) -> list[str]:
    axis = link.axis
    if axis is None:
        return []
    here = axis.at_joint if axis.lever is not None else axis.joined()
    return element(
        "joint",
        name=link.name,
        type="slide" if link.kind == "prismatic" else None,
        axis="0 0 1",
        range=None if link.position is None else figures(link.position),
        actuatorfrcrange=None if link.effort is None else figures((-link.effort, link.effort)),
        springref=any_figure(here.get("rest")) if here.get("stiffness") else None,
        **_resistance(here),
    )


def _resistance(here: Properties) -> dict[str, str | None]:
    """The attributes that joints and tendons have alike."""
    terms = [here.get(name, 0.0) for name in ("damping", "quadratic", "cubic")]
    while terms and not terms[-1]:
        terms.pop()
    friction = any_figure(here.get("friction"))
    return {
        "stiffness": any_figure(here.get("stiffness")),
        "damping": figures(terms) if terms else None,
        "armature": any_figure(here.get("armature")),
        "frictionloss": friction,
        "solreffriction": STICKING if friction else None,
    }


def _tendons(machine: Machine) -> list[str]:
    lines: list[str] = []
    for link in machine.moving:
        assert link.axis is not None
        if link.axis.lever is not None:
            lines += _lever(link, link.axis)
    for coupling in machine.couplings:
        lines += _coupling(machine, coupling)
    return lines


def _lever(link: Link, axis: Axis) -> list[str]:
    """The actuator as a tendon between its ends, whose length is the motor coordinate but for the scale."""
    assert axis.lever is not None
    scale = axis.lever.per_length
    here = {
        name: value * abs(scale) ** POWERS[name] for name, value in axis.at_motor.items() if name in POWERS
    }
    ends = [f"{link.name}_actuator_base", f"{link.name}_actuator_end"]
    sites = [line for end in ends for line in element("site", site=end)]
    rest = axis.lever.length(axis.at_motor["rest"]) if here.get("stiffness") else None
    return element(
        "spatial", sites, name=f"{link.name}_actuator", springlength=any_figure(rest), **_resistance(here)
    )


def _coupling(machine: Machine, coupling: Coupling) -> list[str]:
    parts = [(machine.links[coupling.link].name, 1.0), (machine.links[coupling.other].name, coupling.ratio)]
    joints = [line for name, ratio in parts for line in element("joint", joint=name, coef=figure(ratio))]
    return element("fixed", joints, name=coupling.name, **_resistance(coupling.properties))


def _actuator(link: Link) -> list[str]:
    """The drive: its force is gain times input, and acts at the motor coordinate."""
    axis = link.axis
    assert axis is not None
    if axis.lever is not None:
        where, gear = {"tendon": f"{link.name}_actuator"}, axis.lever.per_length
    else:
        where, gear = {"joint": link.name}, axis.ratio
    most = axis.current if axis.driven else link.effort
    given: dict[str, str | None] = {
        "name": link.name,
        **where,
        "gear": None if gear == 1.0 else figure(gear),
        "ctrlrange": None if most is None else figures((-most, most)),
    }
    push, lag = axis.push(), axis.input.get("lag")
    if axis.gain == 1.0 and not push and not lag:
        return element("motor", **given)
    return element(
        "general",
        **given,
        gainprm=figure(axis.gain),
        biastype="affine" if push else None,
        biasprm=f"{figure(-push)} 0 0" if push else None,
        dyntype="filterexact" if lag else None,
        dynprm=any_figure(lag),
    )


def _alone(link: Link) -> list[str]:
    """What acts without an input: cogging, and bristles that bend before they slide (LuGre as Dahl 1968)."""
    axis = link.axis
    assert axis is not None
    lines: list[str] = []
    for k, (place, here) in enumerate(axis.alone, 1):
        # of the coordinate x at its place: x = slope times that of the transmission, and shift
        where, slope, shift = {"joint": link.name}, 1.0, 0.0
        if place == "motor" and axis.lever is not None:
            where, slope = {"tendon": f"{link.name}_actuator"}, axis.lever.per_length
            shift = -slope * axis.lever.zero
        elif place == "motor":
            slope, shift = axis.ratio, axis.middle[1] - axis.ratio * axis.middle[0]
        if "bristle" in here:
            friction = here["friction"]
            law = {"lugre": figures((friction / here["bristle"], 0.0, friction, friction, 1.0))}
        else:
            wave, sine, cosine = here["wave"], here["sine"], here["cosine"]
            # it opposes the input, where the simulator's adds to it
            phase = math.remainder(wave * shift + math.atan2(cosine, sine) + math.pi, math.tau)
            law = {"cogging": figures((math.hypot(sine, cosine) / wave, 1.0, phase))}
            slope *= wave
        passive = {"motorconst": "0 0", "resistance": "1", "input": "none"}
        name, gear = f"{link.name}_alone{k}", figure(slope)
        lines += element("dcmotor", name=name, **where, gear=gear, **passive, **law)
    return lines


def remarks(machine: Machine) -> list[str]:
    """What the format cannot say of a machine besides the laws of effects."""
    fast = [link.name for link in machine.moving if link.velocity is not None]
    found = ["contacts are switched off: the description has no shapes"]
    dry = any("friction" in p for p in machine.properties())
    if dry:
        found.append(
            "MuJoCo's solver keeps frictionloss: exact while a joint slides; at rest, where the largest "
            "error is, it creeps"
        )
    if any({"quadratic", "cubic"} & set(p) for p in machine.properties()):
        found.append("damping has several coefficients, which MuJoCo 4.0 reads and older releases do not")
    if any(link.axis is not None and link.axis.alone for link in machine.moving):
        found.append("dcmotors without input, which MuJoCo 4.0 reads and older releases do not")
    if fast:
        found.append(f"limits of speed are left out: MuJoCo has none ({', '.join(fast)})")
    return found


_LAWS: Mapping[str, str] = {
    "damping": "damping",
    "quadratic": "damping, second coefficient",
    "cubic": "damping, third coefficient",
    "friction": "frictionloss",
    "armature": "armature",
    "stiffness": "stiffness",
    "force": "constant force of the actuator",
    "lag": "filter of the actuator",
    "sine": "cogging of a dcmotor",
    "cosine": "cogging of a dcmotor",
    "bristle": "lugre of a dcmotor",
}
MJCF = Format(
    name="mjcf",
    title="MJCF",
    laws=_LAWS,
    solved=frozenset({"friction"}),
    levers=True,
    pairs=True,
    write=write_mjcf,
    remarks=remarks,
)
