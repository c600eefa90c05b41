"""Joints by their names, values in the units that people use, causes as clauses."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from modelgen.charts import number, sized
from modelgen.description import Arm
from modelgen.effects import CATALOGUE
from modelgen.effects.placement import joint_meant, titled

_LIMITED = {
    "q": "position",
    "dq": "speed",
    "ddq": "acceleration",
    "qm": "motor position",
    "dqm": "motor speed",
    "ddqm": "motor acceleration",
    "input": "input",
    "effort": "effort",
}
_BELOW = 1e-3  # of a deviation, of which two digits are printed
NOT_SEPARATE = "in the arm's parameters"
_DIGITS = 1e-12  # of a value, which a computation of doubles leaves of zero


class Said(float):
    """A value with its unit, as a sentence has it: angles in degrees, short times in ms, small lengths in mm.

    The format "%" makes percent of it.
    """

    unit: str

    def __new__(cls, value: float, unit: str) -> Said:
        """Make one of a value and its unit."""
        made = super().__new__(cls, value)
        made.unit = unit
        return made

    def __format__(self, spec: str) -> str:
        value = float(self)
        if spec == "%":
            return f"{number(100.0 * value, 2)} %"
        if self.unit == "rad":
            return f"{number(np.degrees(value), 2)} deg"
        if self.unit == "s" and abs(value) < 1.0:
            return f"{number(1e3 * value, 2)} ms"
        if self.unit == "m" and abs(value) < 0.1:
            return f"{number(1e3 * value, 2)} mm"
        return sized(value, self.unit, 2)


def joint_name(arm: Arm, number: int) -> str:
    """Name of a coordinate, which counts from 1."""
    return arm.coordinate_names[number - 1]


def place_of(arm: Arm, joint: int | None) -> str:
    """Where an effect acts: the joint's name, or the whole arm."""
    return "the whole arm" if joint is None else joint_name(arm, joint)


def legible(parameters: Mapping[str, Any]) -> Mapping[str, Any]:
    """Estimates by name, zero where a value is far below what is printed of its deviation.

    Where no deviation is known, below the digits of the largest value that has its unit.
    """
    found = {}
    for name, e in parameters.items():
        peers = max(abs(o.value) for o in parameters.values() if o.unit == e.unit)
        least = _BELOW * e.std if e.std > 0.0 else _DIGITS * peers
        found[name] = replace(e, value=0.0) if abs(e.value) < least else e
    return found


def value_said(arm: Arm, effect: str, name: str, e: Any, digits: int = 4, *, unit: bool = True) -> str:
    """The value of a cause's parameter: of a joint its name; one that the arm's own parameters hold has none.
    unit: whether that is said too.
    """
    if not e.separate:
        return NOT_SEPARATE
    plain = sized(e.value, e.unit, digits) if unit else f"{e.value:z.{digits}g}"
    return joint_meant(arm, effect, name, e.value) or plain


def finding(
    arm: Arm,
    effect: str,
    joint: int | None,
    parameters: Mapping[str, Any],
    records: Sequence[str] | None = None,
) -> str:
    """The clause that says what is there, with its values.

    parameters: value and unit by name. records: those that have it, None for all.
    """
    definition, place = CATALOGUE[effect], place_of(arm, joint)
    values = {
        name: joint_meant(arm, effect, name, e.value) or Said(e.value, e.unit)
        for name, e in legible(parameters).items()
    }
    drive = f"the drive of {place}"
    try:
        said = definition.finding.format(joint=place, place=place, drive=drive, **values)
    except KeyError:  # a form of it without that value
        said = f"{definition.text} acts at {place}"
    where = "" if records is None else f", in {listed(Path(r).name for r in records)} alone"
    return (said or titled(arm, effect, joint)) + where


def there(effect: str, place: str, other: str = "") -> str:
    """The clause that says what is there, without values: what arms have in common whose values differ.

    place: name of a joint, or "the whole arm"; other: that of a further joint that it has to do with.
    """
    definition = CATALOGUE[effect]
    said = re.sub(r":?(?: by)? \{(?!joint|place|drive|other)[^}]*\}(?: of it)?", "", definition.finding)
    where = {"joint": place, "place": place, "drive": f"the drive of {place}", "other": other}
    return said.format(**where) or f"{definition.text} acts at {place}"


def sentence(clause: str) -> str:
    """With a capital letter, unless a name of the catalogue comes first, and a full stop or its own end."""
    first = clause[:1] if "_" in clause.partition(" ")[0] else clause[:1].upper()
    return f"{first}{clause[1:]}{'' if clause.endswith(('.', '?', ':')) else '.'}"


def listed(words: Iterable[str]) -> str:
    """Words with commas and an "and"."""
    every: Sequence[str] = list(words)
    return " and ".join([", ".join(every[:-1]), every[-1]] if len(every) > 1 else every)


def law(effect: str) -> str:
    """The law of an effect as its definition states it, empty where it states none."""
    definition = CATALOGUE[effect]
    for name in ("law", "force", "changed", "effective"):
        method = definition.__dict__.get(name) or getattr(definition, name, None)
        text = getattr(method, "__doc__", None)
        if text:
            first = text.strip().splitlines()[0]
            return first if first.endswith(".") else f"{first}."
    return ""


def limit_name(arm: Arm, key: str) -> str:
    """A limit of an excitation in words: "motor speed of elbow" for dqm2; a box as it is."""
    found = re.fullmatch(r"([a-z]+)(\d+)", key)
    if found is None or found[1] not in _LIMITED:
        return key
    return f"{_LIMITED[found[1]]} of {joint_name(arm, int(found[2]))}"
