"""A fleet in sentences: which units lack what, in the words of the effects."""

from __future__ import annotations

from collections.abc import Sequence

from modelgen.diagnosis.result import VERDICTS
from modelgen.effects import CATALOGUE
from modelgen.fleet.store import Row
from modelgen.report.words import listed, there

FAILED = "failed"
# What a unit does, and several, by verdict, where nothing has a name.
_CLAUSES = {
    "named": ("lacks something", "lack something"),
    "suspected": ("may lack something", "may lack something"),
    "nothing_missing": (
        "lacks nothing that its records could show",
        "lack nothing that their records could show",
    ),
    "outside_catalogue": ("lacks something outside the catalogue", "lack something outside the catalogue"),
    "cannot_tell": ("gives no answer", "give no answer"),
    FAILED: ("could not be diagnosed", "could not be diagnosed"),
}
_PERHAPS = {"suspected": "perhaps "}  # before what is not sure
_GROUPS = 5  # units that lack the same, in a sentence each
_UNITS = 4  # of a group, by their names
_CAUSES = 3  # of a group, in words


def differences(rows: Sequence[Row]) -> list[str]:
    """Which units lack what, in sentences: most of them first, and in what others differ from these. Names of
    units are in backquotes.
    """
    groups: dict[tuple[str, tuple[str, ...]], list[str]] = {}
    for row in rows:
        what = titles(row) if row.get("causes") else row.get("suspects") or ()
        groups.setdefault((verdict(row), tuple(what)), []).append(row["unit"])
    order = sorted(groups, key=lambda key: -len(groups[key]))
    most = len(groups[order[0]]) if order else 0
    usual = 2 * most > len(rows) > 2
    said = []
    for k, (found, what) in enumerate(order[:_GROUPS]):
        units = groups[found, what]
        quoted = [f"`{unit}`" for unit in units[:_UNITS]]
        named = listed(quoted) + (f" and {len(units) - _UNITS} more" if units[_UNITS:] else "")
        one, many = _CLAUSES[found]
        clause = _PERHAPS.get(found, "") + _missing(what) if what else ""
        if usual and k == 0:
            count = f"all {most}" if most == len(rows) else f"{most} of {len(rows)}"
            said.append(f"In {count} units {clause}." if what else f"{_begun(count)} units {many}.")
        elif usual:
            verb = "differs" if len(units) == 1 else "differ"
            does = f"it {one}" if len(units) == 1 else f"they {many}"
            said.append(f"{named} {verb}: {clause or does}.")
        else:
            said.append(f"In {named} {clause}." if what else f"{named} {one if len(units) == 1 else many}.")
    left = len(order) - _GROUPS
    return said + ([f"{left} further group{'' if left == 1 else 's'}: see the table."] if left > 0 else [])


def _begun(text: str) -> str:
    return text[:1].upper() + text[1:]


def _missing(what: Sequence[str]) -> str:
    """What is named or suspected, in words; the first of many."""
    more = [f"{len(what) - _CAUSES} more, in the table"] if what[_CAUSES:] else []
    return listed([*(_words(title) for title in what[:_CAUSES]), *more])


def _words(title: str) -> str:
    """The clause for "effect at joint", "effect of the whole arm" or "effect at joint and other"."""
    effect, _, where = title.partition(" ")
    if effect not in CATALOGUE:
        return title
    joint, _, other = where.removeprefix("at ").partition(" and ")
    return there(effect, joint.removeprefix("of "), other)


def verdict(row: Row) -> str:
    """One of VERDICTS, or FAILED."""
    found = row.get("verdict")
    return found if found in VERDICTS else FAILED


def titles(row: Row) -> list[str]:
    """Causes with their joints."""
    named = zip(row.get("causes") or (), row.get("joint_names") or (), strict=True)
    return row.get("titles") or [e if j is None else f"{e} at {j}" for e, j in named]
