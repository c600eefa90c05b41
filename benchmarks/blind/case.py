"""What a family makes: the files that a diagnosis gets, and the truth that it does not."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]
Table = dict[str, Array]
TRUTH = "truth.json"
FREE_PLAY = (
    "joint_flexibility",
    "backlash",
    "presliding",
)  # causes of lost motion: a set of them may be answered


@dataclass(frozen=True)
class Truth:
    """What is hidden.

    effect: name in modelgen's catalogue; None: nothing is hidden; "outside": nothing that the catalogue has.
    joints: numbers that are right for its joint, None for the whole arm; several where either is meant.
    values: its true values, SI, motor coordinates in rad.
    text: the hidden law in words.
    size: RMSE of a fit without the effect over that of a fit with it, as measured; None: nothing is hidden.
    """

    effect: str | None
    joints: tuple[int | None, ...] = ()
    values: dict[str, float] = field(default_factory=dict)
    text: str = ""
    size: float | None = None


@dataclass(frozen=True)
class Case:
    """One arm and its records.

    arms: text of arms.yaml, the user's model without what is hidden.
    mapping: text of the mapping file, or None.
    tables: columns of each record; train, test: their names.
    facts: how the case was made, for whoever looks into a wrong answer.
    """

    family: str
    seed: int
    kind: str
    size: float | None
    setting: str
    arm: str
    arms: str
    mapping: str | None
    tables: dict[str, Table]
    train: tuple[str, ...]
    test: str
    truth: Truth
    facts: dict[str, object]

    @property
    def name(self) -> str:
        """Folder of the case, which says all that it is made from."""
        return case_name(self.family, self.seed, self.kind, self.size, self.setting)

    def write(self, folder: Path) -> None:
        """Write arms.yaml, mapping.yaml, the records as CSV, and truth.json, which also names the records."""
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "arms.yaml").write_text(self.arms)
        if self.mapping is not None:
            (folder / "mapping.yaml").write_text(self.mapping)
        for name, table in self.tables.items():
            (folder / f"{name}.csv").write_text(csv(table))
        said = {
            "family": self.family,
            "seed": self.seed,
            "kind": self.kind,
            "size": self.size,
            "setting": self.setting,
            "arm": self.arm,
            "mapping": self.mapping is not None,
            "train": list(self.train),
            "test": self.test,
            "truth": asdict(self.truth),
            "facts": self.facts,
        }
        (folder / TRUTH).write_text(json.dumps(said, indent=1) + "\n")


class Family(Protocol):
    """A module that makes cases: `make`, and the kinds and settings that it knows."""

    KINDS: tuple[str, ...]
    SETTINGS: tuple[str, ...]

    def make(self, seed: int, kind: str, *, size: float | None, setting: str) -> Case:
        """Case of this seed and kind; the same arguments give the same bytes."""
        ...


def case_name(family: str, seed: int, kind: str, size: float | None, setting: str) -> str:
    """Name of a case."""
    return f"{family}-{kind}-{seed}-{'any' if size is None else f'{size:.2f}'}-{setting}"


def csv(table: Table) -> str:
    """Text of a record: a line per sample, as many digits as a logger writes."""
    rows = np.column_stack(list(table.values()))
    lines = [",".join(table)] + [",".join(f"{x:.10g}" for x in row) for row in rows.tolist()]
    return "\n".join(lines) + "\n"
