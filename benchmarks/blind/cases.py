"""Sets of cases: families, kinds and seeds; one to work on, one that is looked at once."""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import cast

import blind
from blind.case import FREE_PLAY, Case, Family, case_name

SIZES = (1.05, 1.10, 1.30)
SHA_DIGITS = 7  # of a commit's hash that make a seed
STRIDE = 1000  # seeds of a set, at most


@dataclass(frozen=True)
class Entry:
    """A case that is not made yet: the arguments of a family's `make`."""

    family: str
    seed: int
    kind: str
    size: float | None
    setting: str

    @property
    def name(self) -> str:
        """Folder of the case."""
        return case_name(self.family, self.seed, self.kind, self.size, self.setting)

    def make(self) -> Case:
        """The case."""
        return family(self.family).make(self.seed, self.kind, size=self.size, setting=self.setting)


def families() -> tuple[str, ...]:
    """Letters of the families that are there: packages or modules family_<letter> beside this one."""
    found = (m.name for m in pkgutil.iter_modules(blind.__path__))
    return tuple(sorted(n.removeprefix("family_") for n in found if n.startswith("family_")))


def family(letter: str) -> Family:
    """Module of a family. Raises ValueError for one that is not there."""
    if letter not in families():
        raise ValueError(f"no family {letter!r}: there are {', '.join(families())}")
    return cast("Family", importlib.import_module(f"blind.family_{letter}"))


def first_seed(which: str) -> int:
    """Seed that a set begins with: 0 for "working", far from it for a commit's hash (the untouched set).

    Raises ValueError for what is neither.
    """
    if which == "working":
        return 0
    try:
        return STRIDE * (1 + int(which[:SHA_DIGITS], 16))
    except ValueError:
        raise ValueError(f"{which!r} is neither 'working' nor a commit's hash") from None


def chosen(
    letter: str,
    which: str = "working",
    *,
    count: int = 1,
    kinds: Sequence[str] = (),
    sizes: Sequence[float] = SIZES,
    settings: Sequence[str] = ("four",),
) -> list[Entry]:
    """Entries of a set, those of one seed after those of the one before.

    letter: of the family. which: "working", or the hash of a commit. count: seeds of every combination.
    kinds: of the family, all by default; "one" stands for all single effects, "outside" for all outside the
    catalogue, "lost" for lost motion. Cases of "nothing" and of the setting "lost_motion" have no size.
    """
    known = family(letter).KINDS
    groups = {
        "one": [k for k in known if k != "nothing" and not k.startswith("outside:")],
        "outside": [k for k in known if k.startswith("outside:")],
        "lost": [k for k in known if k in FREE_PLAY],
    }
    wanted = [k for name in kinds or known for k in groups.get(name, [name])]
    for kind in wanted:
        if kind not in known:
            raise ValueError(f"family {letter} has no kind {kind!r}: {', '.join(known)}")
    for setting in settings:
        if setting not in family(letter).SETTINGS:
            raise ValueError(
                f"family {letter} has no setting {setting!r}: {', '.join(family(letter).SETTINGS)}"
            )
    begin = first_seed(which)
    return [
        Entry(letter, begin + k, kind, size, setting)
        for k in range(count)
        for setting in settings
        for kind in wanted
        for size in _sizes(kind, setting, sizes)
    ]


def _sizes(kind: str, setting: str, sizes: Iterable[float]) -> tuple[float | None, ...]:
    return (None,) if kind == "nothing" or setting == "lost_motion" else tuple(sizes)
