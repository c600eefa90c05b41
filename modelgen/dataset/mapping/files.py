"""A mapping file, read and checked: what a log's columns are, before any log is opened."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from pydantic import ValidationError

from modelgen.dataset.mapping import units
from modelgen.dataset.mapping.schema import Document, JointModel
from modelgen.dataset.objects import Layout
from modelgen.description.document import Node, Steps, parse, read_text
from modelgen.description.expressions import ExpressionError, evaluate
from modelgen.description.messages import describe, first_mistake, mistake
from modelgen.errors import InputError, suggest
from modelgen.numeric import Array

HOLDS = ("following", "previous", "instant")


@dataclass(frozen=True)
class Foreign:
    """The mapping of a foreign log: its document, and the tree that knows the places of its values."""

    document: Document
    root: Node

    def error(self, message: str, path: Steps, key: bool = False) -> InputError:
        """The InputError for the value at `path` of the mapping file."""
        return mistake(self.root, path, message, key)

    def number(self, raw: float | str, path: Steps) -> float:
        """Value of a number or an expression such as 2*pi/4096. Raises InputError."""
        try:
            return evaluate(raw, "plain").value
        except ExpressionError as error:
            raise self.error(f"found {describe(raw)}, expected a number: {error}", path) from None

    def positive(self, raw: float | str | None, path: Steps) -> float | None:
        """Read a number above zero; None where nothing is given."""
        value = None if raw is None else self.number(raw, path)
        if value is not None and value <= 0.0:
            raise self.error(f"found {describe(raw)}, expected a number above 0", path)
        return value

    def unit(self, name: str, known: Mapping[str, Any], path: Steps) -> Any:
        """Look up a unit. Raises InputError with the units that there are."""
        if name not in known:
            hint = ""
            if name == "counts" and "rev" in known:
                hint = "; with 4096 counts per revolution write unit: rev, scale: 1/4096"
            raise self.error(f"found the unit {describe(name)}{suggest(name, known)}{hint}", [*path, "unit"])
        return known[name]

    @property
    def joints(self) -> Sequence[JointModel] | None:
        """What the joints' columns are; None where the log has them by the names of docs/logs.md."""
        return self.document.joints

    @property
    def layout(self) -> Layout:
        """What the mapping says about the table in the file."""
        d = self.document
        return Layout(tuple(d.columns), d.delimiter, d.decimal, d.encoding, d.skip_lines)

    @property
    def hold(self) -> str | float:
        """One of HOLDS, or the delay [s] of the effort's samples after their stamps."""
        raw = self.document.hold
        if isinstance(raw, str) and raw in HOLDS:
            return raw
        try:
            return evaluate(raw, "plain").value
        except ExpressionError:
            expected = f"one of {', '.join(HOLDS)}, or a delay in seconds"
            raise self.error(f"found {describe(raw)}, expected {expected}", ["hold"]) from None

    def matrices(self, n: int) -> tuple[Array, Array] | None:
        """R (n, n) and the offset (n,) [rad, m] of the coupling; None without one. Raises InputError."""
        coupling = self.document.coupling
        if coupling is None:
            return None
        path: list[str | int] = ["coupling", "matrix"]
        shape = f"{len(coupling.matrix)} x {max(len(row) for row in coupling.matrix)}"
        if len(coupling.matrix) != n or any(len(row) != n for row in coupling.matrix):
            raise self.error(f"found {shape} numbers, expected {n} x {n}, a row per joint", path)
        matrix = np.array(
            [
                [self.number(x, [*path, i, j]) for j, x in enumerate(row)]
                for i, row in enumerate(coupling.matrix)
            ]
        )
        # Rows and columns may be in any units: they are scaled before the rank is judged.
        scaled = matrix / np.maximum(np.abs(matrix).max(axis=1, keepdims=True), 1e-300)
        if np.linalg.matrix_rank(scaled) < n:
            raise self.error("the matrix is singular, expected one that can be inverted", path)
        offsets = coupling.joint_offset or [0.0] * n
        where: list[str | int] = ["coupling", "joint_offset"]
        if len(offsets) != n:
            raise self.error(f"found {len(offsets)} numbers, expected {n}, one per joint", where)
        return matrix, np.array([self.number(x, [*where, i]) for i, x in enumerate(offsets)])


def load_mapping(path: Path | str) -> Foreign:
    """The mapping in a YAML file. Raises InputError with the place of the first mistake."""
    file = Path(path)
    if not file.exists():
        raise InputError(f"{file}: there is no such mapping file; docs/logs.md shows one")
    root = parse(read_text(file), str(file))
    if not isinstance(root.value, dict):
        found = describe(root.plain())
        raise InputError(f"found {found}, expected a mapping with `schema` and `joints`", root.where)
    if "arms" in root.value and "convention" in root.value:
        raise InputError("this is the description of an arm, expected a mapping file", root.where)
    try:
        document = Document.model_validate(root.plain())
    except ValidationError as error:
        raise first_mistake(root, error, Document) from None
    foreign = Foreign(document, root)
    _ = foreign.hold
    foreign.unit(document.time.unit, units.TIMES, ["time"])
    for i, joint in enumerate(foreign.joints or ()):
        if joint.effort is not None:
            foreign.unit(joint.effort.unit, units.EFFORTS, ["joints", i, "effort"])
    return foreign


def listed(names: Iterable[str], most: int = 30) -> str:
    """Names for a message, the first of them where there are many."""
    known = list(names)
    return ", ".join(known[:most]) + (f" and {len(known) - most} more" if len(known) > most else "")
