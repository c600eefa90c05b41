"""URDF: links, joints, limits, damping, friction and gears. It says nothing of gravity: z points up."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from modelgen.exporting.account import Format
from modelgen.exporting.machine import Link, Machine
from modelgen.exporting.xml_lines import angles, any_figure, comment, element, figure, figures, places
from modelgen.importing.mjcf.settings import along_z
from modelgen.importing.poses import inverse, pose, to_rpy
from modelgen.importing.robot import Body
from modelgen.importing.urdf import UNLIMITED
from modelgen.numeric import Array

ROOT = "base_link"
EARTH = 9.81  # m/s^2, what simulators take along -z
LEVEL = 1e-9  # of gravity's direction, that is arithmetic


def write_urdf(machine: Machine, table: Sequence[str]) -> str:
    """The text of the file."""
    inside = [*comment(table), *element("link", name=ROOT)]
    root = upright(machine) @ machine.base
    for i in machine.order:
        link = machine.links[i]
        inside += element("link", _inertial(link.body), name=_name(link))
        inside += _joint(machine, link, root if link.before is None else np.eye(4))
    taken = {ROOT, *map(_name, machine.links)}
    for tool in machine.tools:
        name = f"{tool.name}_" if tool.name in taken else tool.name
        ends = [
            *_origin(tool.frame),
            *element("parent", link=_name(machine.links[tool.link])),
            *element("child", link=name),
        ]
        inside += element("link", name=name)
        inside += element("joint", ends, name=f"{name}_joint", type="fixed")
    for link in machine.moving:
        inside += _transmission(link)
    return "\n".join(['<?xml version="1.0"?>', *element("robot", inside, name=machine.name)]) + "\n"


def upright(machine: Machine) -> Array:
    """World with z up <- the arm's world (4, 4): the least turn."""
    if not np.linalg.norm(machine.gravity) > 0:
        return np.eye(4)
    return inverse(pose(along_z(-machine.gravity), np.zeros(3)))


def _name(link: Link) -> str:
    return f"{link.name}_link"


def _origin(frame: Array) -> list[str]:
    rpy = to_rpy(frame[:3, :3])
    if not (np.abs(frame[:3, 3]).max() > 0 or np.abs(rpy).max() > 0):
        return []
    return element("origin", xyz=places(frame[:3, 3]), rpy=angles(rpy))


def _inertial(body: Body) -> list[str]:
    if body.mass == 0.0:
        return []
    names = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
    six = body.inertia[np.triu_indices(3)].tolist()
    inside = [
        *element("origin", xyz=figures(body.com)),
        *element("mass", value=figure(body.mass)),
        *element("inertia", **{name: figure(value) for name, value in zip(names, six, strict=True)}),
    ]
    return element("inertial", inside)


def _joint(machine: Machine, link: Link, before: Array) -> list[str]:
    parent = ROOT if link.before is None else _name(machine.links[link.before])
    inside = [
        *_origin(before @ link.pose),
        *element("parent", link=parent),
        *element("child", link=_name(link)),
    ]
    if link.axis is None:
        return element("joint", inside, name=link.name, type="fixed")
    kind = "continuous" if link.kind == "revolute" and link.position is None else link.kind
    inside += element("axis", xyz="0 0 1")
    if kind != "continuous" or link.effort is not None or link.velocity is not None:
        low, high = link.position or (None, None)
        inside += element(
            "limit",
            lower=None if low is None else figure(low),
            upper=None if high is None else figure(high),
            effort=figure(_effort(link)),
            velocity=figure(link.velocity or UNLIMITED),
        )
    here = link.axis.joined()
    if here.get("damping") or here.get("friction"):
        inside += element(
            "dynamics", damping=any_figure(here.get("damping")), friction=any_figure(here.get("friction"))
        )
    return element("joint", inside, name=link.name, type=kind)


def _effort(link: Link) -> float:
    """The limit of the effort, else the drive's at its largest current."""
    axis = link.axis
    assert axis is not None
    if link.effort is not None:
        return link.effort
    if axis.current is None or axis.lever is not None:
        return UNLIMITED
    return abs(axis.current * axis.gain * axis.ratio)


def _transmission(link: Link) -> list[str]:
    """The gear of a motor that turns with the joint."""
    axis = link.axis
    assert axis is not None
    if axis.varies or axis.ratio == 1.0:
        return []
    interface = element("hardwareInterface", "hardware_interface/EffortJointInterface")
    inside = [
        *element("type", "transmission_interface/SimpleTransmission"),
        *element("joint", interface, name=link.name),
        *element("actuator", element("mechanicalReduction", figure(axis.ratio)), name=f"{link.name}_motor"),
    ]
    return element("transmission", inside, name=f"{link.name}_transmission")


def remarks(machine: Machine) -> list[str]:
    """What the format cannot say of a machine besides the laws of effects."""
    found = []
    size = float(np.linalg.norm(machine.gravity))
    if size > 0 and np.abs(machine.gravity / size - [0, 0, -1]).max() > LEVEL:
        x, y, z = machine.gravity
        found.append(
            f"{ROOT} is turned upright, since URDF has no gravity; the description's is {x:g}, {y:g}, "
            f"{z:g} m/s^2"
        )
    if abs(size - EARTH) > LEVEL:
        found.append(f"URDF has no gravity, and simulators take {EARTH:g} m/s^2: here it is {size:g} m/s^2")
    open_ended = [link.name for link in machine.moving if link.kind == "prismatic" and link.position is None]
    if open_ended:
        found.append(f"no range is known of {', '.join(open_ended)}: lower and upper are missing")
    some = [link.name for link in machine.moving if _effort(link) == UNLIMITED or link.velocity is None]
    if some:
        found.append(f"{UNLIMITED:g} is a limit of effort or speed that is not known ({', '.join(some)})")
    moved = [link.name for link in machine.moving if link.axis is not None and link.axis.varies]
    if moved:
        found.append(f"the linkages of {', '.join(moved)} are left out: efforts act at the joints")
    return found


_LAWS: Mapping[str, str] = {"damping": "damping", "friction": "friction"}
URDF = Format(
    name="urdf",
    title="URDF",
    laws=_LAWS,
    solved=frozenset(),
    levers=False,
    pairs=False,
    write=write_urdf,
    remarks=remarks,
)
