"""An arm with further effects, as objects and as YAML that `modelgen generate` accepts."""

from __future__ import annotations

import io
from collections.abc import Mapping, Sequence
from typing import Any

from ruamel.yaml import YAML
from ruamel.yaml.comments import CommentedMap, CommentedSeq

from modelgen.description import Arm
from modelgen.effects.placement import Found, admitted, extended_arm
from modelgen.errors import InputError

__all__ = ["Found", "extended_arm", "extended_yaml", "with_torque_constants"]


def extended_yaml(arm: Arm, causes: Sequence[Found]) -> str:
    """The arm's part of its description with the causes' effects; comments and order stay.

    Where an effect stands there already, its values are replaced.
    """
    whole, entry = _read(arm)
    for effect, joint, values in causes:
        added: Any = effect
        given = admitted(effect, values)
        if given:
            added = CommentedMap({effect: CommentedMap(given)})
            added[effect].fa.set_flow_style()
            added.fa.set_flow_style()
        if joint is None:
            owner, uses = entry, arm.effects
        else:
            index = arm.coordinates[joint - 1]
            owner, uses = entry["joints"][index], arm.joints[index].effects
        present = [use.name for use in uses]
        listed = _listed(owner, present)
        if effect in present:
            listed[present.index(effect)] = added
        else:
            listed.append(added)
    return _written(whole, arm, entry)


def with_torque_constants(arm: Arm, values: Mapping[int, float]) -> str:
    """The arm's part of its description with other torque constants, by number of the coordinate."""
    whole, entry = _read(arm)
    for number, value in values.items():
        joint = entry["joints"][arm.coordinates[number - 1]]
        # the drive may be that of other joints as well: this one gets its own
        own = CommentedMap(joint["drive"])
        if joint["drive"].fa.flow_style():
            own.fa.set_flow_style()
        own["torque_constant"] = float(f"{value:.9g}")
        joint["drive"] = own
    return _written(whole, arm, entry)


def _read(arm: Arm) -> tuple[CommentedMap, CommentedMap]:
    """The description, and the arm's part of it. Raises InputError for an arm that has none."""
    if not arm.document:
        raise InputError(
            f"{arm.name}: found an arm without the text of a description, into which what is found is "
            "written; expected one that load_arms has read"
        )
    whole = _yaml().load(arm.document)
    return whole, whole["arms"][arm.name]


def _yaml() -> YAML:
    yaml = YAML()
    yaml.width = 110
    return yaml


def _written(whole: CommentedMap, arm: Arm, entry: CommentedMap) -> str:
    document = CommentedMap()
    for key in ("schema", "convention"):
        document[key] = whole[key]
    document["arms"] = CommentedMap({arm.name: entry})
    out = io.StringIO()
    _yaml().dump(document, out)
    return out.getvalue()


def _listed(owner: CommentedMap, present: Sequence[str]) -> CommentedSeq:
    """The list of effects, written out where it was left to its default."""
    if owner.get("effects") is None:
        made = CommentedSeq(present)
        made.fa.set_flow_style()
        owner["effects"] = made
    found: CommentedSeq = owner["effects"]
    if found.anchor.value is not None:
        # the list is that of other joints as well: this one gets its own
        own = CommentedSeq(list(found))
        if found.fa.flow_style():
            own.fa.set_flow_style()
        owner["effects"] = found = own
    return found
