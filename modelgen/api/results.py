"""Results: they print short, show as tables in a notebook, and write the files of the command."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from html import escape
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from modelgen.files import check_folder, write_together
from modelgen.numeric import Array

V = TypeVar("V")


@dataclass(frozen=True)
class Table:
    """Text in rows. columns: headings, each with the side "left" or "right" that its cells stand at. names:
    headings of columns whose words are not broken.
    """

    title: str
    columns: Mapping[str, str]
    rows: Sequence[Sequence[str]]
    names: Collection[str] = ()

    def filled(self) -> Table:
        """Without the columns in which every cell is empty."""
        kept = [k for k in range(len(self.columns)) if not self.rows or any(row[k] for row in self.rows)]
        columns = list(self.columns.items())
        rows = [[row[k] for k in kept] for row in self.rows]
        return Table(self.title, dict(columns[k] for k in kept), rows, self.names)

    def html(self) -> str:
        """The table as HTML."""
        head = "".join(f"<th>{escape(name)}</th>" for name in self.columns)
        sides = list(self.columns.values())
        body = "".join(
            "<tr>"
            + "".join(
                f'<td style="text-align: {side}">{escape(cell)}</td>'
                for side, cell in zip(sides, row, strict=True)
            )
            + "</tr>"
            for row in self.rows
        )
        caption = f"<caption>{escape(self.title)}</caption>" if self.title else ""
        return f"<table>{caption}<thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


def as_html(parts: Sequence[str | Table]) -> str:
    """Lines and tables as HTML."""
    return "\n".join(part.html() if isinstance(part, Table) else f"<p>{escape(part)}</p>" for part in parts)


class Shown(ABC):
    """Something that a command prints, as lines and tables."""

    @abstractmethod
    def shown(self) -> Sequence[str | Table]:
        """Lines and tables, in the order in which the command prints them."""

    @abstractmethod
    def to_json(self) -> Any:
        """Plain data: what the command prints with --json."""

    @abstractmethod
    def __repr__(self) -> str: ...

    def _repr_html_(self) -> str:
        return as_html(self.shown())


class Result(Shown):
    """Base of what functions find from an arm and its logs."""

    @abstractmethod
    def files(self, folder: Path | str = "") -> Mapping[str, str]:
        """Text of every file that the command writes.

        Parameters
        ----------
        folder : Path or str
            Where they will be, which the commands on the page need. Default: the current folder.

        Returns
        -------
        mapping of str to str
            Text by name.
        """

    @abstractmethod
    def next_steps(self, folder: Path | str = "") -> Sequence[tuple[str, str]]:
        """What the page says is to be done next.

        Parameters
        ----------
        folder : Path or str
            Where the files are, which the commands need. Default: the current folder.

        Returns
        -------
        sequence of tuple of str
            Each a sentence and the command for it, empty where there is none.
        """

    def write(self, folder: Path | str) -> None:
        """Write the files of the command into a folder, all of them or none.

        Parameters
        ----------
        folder : Path or str
            It is made where it does not exist.

        Raises
        ------
        InputError
            Where the folder cannot be written.
        """
        out = Path(folder)
        check_folder("--out", out)
        write_together(f"--out {out}", out, self.files(out))


class Named(Mapping[str, V]):
    """Values of parameters by name, in the model's order; NumPy takes them as a vector."""

    def __init__(self, values: Mapping[str, V]) -> None:
        self._values = dict(values)

    def __getitem__(self, name: str) -> V:
        return self._values[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> Array:
        return np.array([getattr(v, "value", v) for v in self._values.values()], dtype=dtype or float)

    def __repr__(self) -> str:
        return "\n".join(" ".join(row).rstrip() for row in self._rows())

    def _repr_html_(self) -> str:
        sides = dict.fromkeys(("parameter", "value", "std", "unit"), "right")
        return Table("", sides, self._rows()).html()

    def _rows(self) -> list[list[str]]:
        rows = []
        for name, value in self._values.items():
            std, unit = getattr(value, "std", None), getattr(value, "unit", "")
            number = float(getattr(value, "value", value))  # type: ignore[arg-type]
            rows.append([name, f"{number:z.6g}", "" if std is None else f"± {std:z.2g}", unit])
        return rows
