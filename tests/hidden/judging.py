"""What a diagnosis is worth, once the label is open."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from hidden.cases import Label, kind

ARM_WIDE = {"base_tilt", "fluid_drag", "added_mass"}  # named without a joint
COMPLIANT = {"backlash", "joint_flexibility"}
FOUND, MISSED, WRONG = "found", "missed", "wrong"

Cause = tuple[str, int | None]


@dataclass(frozen=True)
class Outcome:
    """kind: null, single, pair or outside. verdict: as answered.

    result: found (for a null and an effect outside the catalogue: the right verdict), missed (nothing
    wrong was named, but the truth was not either) or wrong (something was named that is not there).
    by_class: as found, with backlash and flexibility taken for one. in_set: whether every truth is named,
    an alias, or ambiguous with what is. size: mean number of members of the ambiguity sets.
    recovered: share of the recoverable error on the test record that the extended model recovers, or None.
    """

    kind: str
    verdict: str
    result: str
    by_class: str
    in_set: bool
    size: float
    named: list[Cause]
    recovered: float | None


def _pair(entry: dict[str, Any]) -> Cause:
    joint = entry.get("joint")
    return str(entry["effect"]), None if joint is None else int(joint)


def truths(label: Label) -> list[set[Cause]]:
    """For each hidden effect, the names that say the same of it."""
    out = []
    arm_joints = len(label.floor)
    for hidden in label.case["hidden"]:
        effect, joint = hidden["effect"], int(hidden["joint"])
        names: set[Cause] = {(effect, joint)}
        if effect in ARM_WIDE or arm_joints == 1:
            names |= {(effect, None), (effect, 1)}
        if effect == "transmission_coupling":  # friction and inertia of a sum belong to both its joints
            names.add((effect, joint - 1 if joint > 1 else 2))
        if effect == "payload_change":
            names.add((effect, None))
        out.append(names)
    return out


def judge(answer: dict[str, Any], label: Label, reachable: list[float] | None = None) -> Outcome:
    """Compares a diagnosis.json with the label. reachable: RMSE (n,) on test without the effect."""
    causes = [
        (_pair(cause), {_pair(alias) for alias in cause.get("aliases", [])}, cause)
        for cause in answer["causes"]
    ]
    wanted, what = truths(label), kind(label)
    verdict = str(answer["verdict"])
    named = [name for name, _, _ in causes]
    sizes = [1 + len(cause.get("ambiguous_with", [])) for _, _, cause in causes]
    size = sum(sizes) / len(sizes) if sizes else 0.0
    if what in ("null", "outside"):
        right = "nothing_missing" if what == "null" else "outside_catalogue"
        result = WRONG if named else FOUND if verdict == right else MISSED
        return Outcome(what, verdict, result, result, not named, size, named, None)

    def compare(widen: bool) -> str:
        left, extra = list(range(len(wanted))), False
        for name, aliases, _ in causes:
            said = {name, *aliases}
            if widen and name[0] in COMPLIANT:
                said |= {(other, joint) for other in COMPLIANT for joint in range(1, len(label.floor) + 1)}
            hit = [k for k in left if wanted[k] & said]
            if hit:
                left.remove(hit[0])
            else:
                extra = True
        return WRONG if extra else MISSED if left else FOUND

    sets = [
        {name, *aliases, *(_pair(entry) for entry in cause.get("ambiguous_with", []))}
        for name, aliases, cause in causes
    ]
    in_set = all(any(names & members for members in sets) for names in wanted)
    result = compare(False)
    return Outcome(
        what, verdict, result, compare(True), in_set, size, named, _recovered(answer, reachable, result)
    )


def _recovered(answer: dict[str, Any], reachable: list[float] | None, result: str) -> float | None:
    """At the joint where the effect costs most."""
    if result != FOUND or reachable is None or not answer.get("error"):
        return None
    before, after = answer["error"]["before"], answer["error"]["after"]
    excess = [found / floor for found, floor in zip(before, reachable, strict=True)]
    j = excess.index(max(excess))
    recoverable = before[j] - reachable[j]
    return float((before[j] - after[j]) / recoverable) if recoverable > 0 else None
