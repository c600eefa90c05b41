"""An arm as the text of an arms.yaml that reads as if written by hand."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from modelgen.description.document import one_line
from modelgen.description.plausible import MOST
from modelgen.importing.bodies import doubt
from modelgen.importing.frames import Parameters
from modelgen.importing.poses import to_rpy
from modelgen.importing.resistance import Entry
from modelgen.importing.robot import Body
from modelgen.importing.rounded import near_angle, near_zero, precise, shortest, written_angle
from modelgen.numeric import Array

_WORDS = {"null", "true", "false", "~"}  # which YAML reads as values
_FINE = 1e-13  # of what is written, relative to the largest figure beside it


@dataclass(frozen=True)
class JointText:
    """What is written of one joint. antecedent: None for the joint before; names are the arm's own."""

    name: str
    kind: str
    parameters: Parameters
    antecedent: str | None
    note: str = ""
    position: tuple[float, float] | None = None
    velocity: float | None = None
    effort: float | None = None
    drive: Mapping[str, Entry] = field(default_factory=dict)
    effects: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    body: Body | None = None
    body_note: str = ""


@dataclass(frozen=True)
class ToolText:
    """What is written of one tool: its link and its frame there (4, 4)."""

    name: str
    link: str
    frame: Array
    note: str = ""


@dataclass(frozen=True)
class ArmText:
    """What is written of an arm. base (4, 4), None where the base frame is the world's."""

    name: str
    heading: Sequence[str]
    source: str
    gravity: Array
    base: Array | None
    base_note: str
    joints: Sequence[JointText]
    tools: Sequence[ToolText]


def text_of(arm: ArmText) -> str:
    """The whole file."""
    lines = [f"# {line}" for line in arm.heading]
    lines += ["schema: 1", "convention: khalil_kleinfinger", "arms:", f"  {_word(arm.name)}:"]
    lines.append(f"    source: {_quoted(arm.source)}")
    gravity = [near_zero(value, 1e-12) for value in arm.gravity]
    lines.append(f"    gravity: {_list(map(shortest, gravity))}")
    if arm.base is not None:
        lines.append(_noted(f"    base: {_flow(_placed(arm.base))}", arm.base_note))
    lines.append("    joints:")
    for joint in arm.joints:
        lines += [f"      {line}" for line in _joint(joint)]
    if arm.tools:
        lines.append("    tools:")
        for tool in arm.tools:
            entries = {"link": _word(tool.link)} | _placed(tool.frame)
            lines.append(_noted(f"      {_word(tool.name)}: {_flow(entries)}", tool.note))
    if any(joint.body is not None for joint in arm.joints):
        lines.append("    links:")
        for joint in arm.joints:
            if joint.body is not None:
                line = f"      {_word(joint.name)}: {_flow(_body(joint.body))}"
                lines.append(_noted(line, joint.body_note))
    return "\n".join(lines) + "\n"


def _joint(joint: JointText) -> list[str]:
    p = joint.parameters
    entries: dict[str, str] = {} if joint.kind == "revolute" else {"type": joint.kind}
    if joint.antecedent is not None:
        entries["antecedent"] = _word(joint.antecedent)
    if p.gamma:
        entries["gamma"] = written_angle(p.gamma)
    if p.b:
        entries["b"] = _length(p.b)
    entries |= {"alpha": written_angle(p.alpha), "d": _length(p.d)}
    if p.theta:
        entries["theta"] = written_angle(p.theta)
    entries["r"] = _length(p.r)
    limits = _limits(joint)
    if limits:
        entries["limits"] = _flow(limits)
    if joint.drive:
        entries["drive"] = _flow({name: _entry(value) for name, value in joint.drive.items()})
    lines = [_noted(f"- name: {_word(joint.name)}", joint.note)]
    lines += [f"  {key}: {value}" for key, value in entries.items()]
    if joint.effects:
        lines.append("  effects:")
        for name, values in joint.effects.items():
            lines.append(f"    - {name}: {_flow({key: precise(v) for key, v in values.items()})}")
    elif joint.drive:
        lines.append("  effects: []")
    return lines


def _entry(value: Entry) -> str:
    if isinstance(value, str):
        return value
    return precise(value) if isinstance(value, float) else _list(map(precise, value))


def unlikely(joint: JointText) -> list[str]:
    """What looks as if it were in another unit than the source's m and rad; it is kept with its unit."""
    p, asked = joint.parameters, []
    longest = max((p.b, p.d, p.r), key=abs)
    ends = joint.position or (0.0, 0.0)
    slides = joint.kind == "prismatic"
    if abs(longest) > MOST["length"]:
        asked.append(f"joint {joint.name}: found a length of {longest:g} m: is the source in millimetres?")
    if max(map(abs, ends)) > MOST["length" if slides else "range"]:
        unit, other = ("m", "millimetres") if slides else ("rad", "degrees")
        found = f"limits of {ends[0]:g} to {ends[1]:g} {unit}"
        asked.append(f"joint {joint.name}: found {found}: is the source in {other}?")
    return asked


def _length(value: float) -> str:
    """In m; with its unit where a reader would ask for it."""
    return f"{shortest(value)} m" if abs(value) > MOST["length"] else shortest(value)


def _turn(value: float) -> str:
    """A joint's angle in rad; with its unit where a reader would ask for it."""
    return f"{shortest(value)} rad" if abs(value) > MOST["range"] else written_angle(value)


def _limits(joint: JointText) -> dict[str, str]:
    written = _length if joint.kind == "prismatic" else _turn
    entries = {}
    if joint.position is not None:
        entries["position"] = _list(map(written, joint.position))
    for name, value in (("velocity", joint.velocity), ("effort", joint.effort)):
        if value is not None:
            entries[name] = shortest(value)
    return entries


def _body(body: Body) -> dict[str, str]:
    scale = float(np.abs(body.inertia).max(initial=0.0))
    six = body.inertia[np.triu_indices(3)]
    entries = {
        "mass": shortest(body.mass),
        "com": _list(shortest(value) for value in body.com),
        "inertia": _list(shortest(value, _FINE * scale / max(1.0, abs(value))) for value in six),
    }
    if doubt(body):
        entries["as_given"] = "true"
    return entries


def _placed(frame: Array) -> dict[str, str]:
    """xyz and rpy, where they are not zero."""
    place = [near_zero(float(value), _FINE) for value in frame[:3, 3]]
    angles = [near_angle(float(value), 1e-14) for value in to_rpy(frame[:3, :3])]
    entries = {}
    if any(place):
        entries["xyz"] = _list(map(shortest, place))
    if any(angles):
        entries["rpy"] = _list(map(written_angle, angles))
    return entries


def _flow(entries: Mapping[str, str]) -> str:
    return "{" + ", ".join(f"{key}: {value}" for key, value in entries.items()) + "}"


def _list(values: Iterable[str]) -> str:
    return "[" + ", ".join(values) + "]"


def _noted(line: str, note: str) -> str:
    return f"{line}   # {one_line(note, 120)}" if note else line


def _word(name: str) -> str:
    return f'"{name}"' if name.lower() in _WORDS else name


def _quoted(text: str) -> str:
    shown = one_line(text, 200)
    return '"' + shown.replace("\\", "\\\\").replace('"', '\\"') + '"'
