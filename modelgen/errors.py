"""The one exception that a user's mistake raises, where in the file the mistake is, and what comes near."""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from dataclasses import dataclass


@dataclass(frozen=True)
class Location:
    """A place in a text file: name as the user gave it, line and column counted from 1."""

    file: str
    line: int
    column: int

    def __str__(self) -> str:
        return f"{self.file}:{self.line}:{self.column}"


class InputError(Exception):
    """Bad input: one clear line for the user, exit code 2, no traceback.

    Parameters
    ----------
    message : str
        What was found, what was expected, what is available and the likely fix.
    where : Location, optional
        The place in the description, where the mistake has one.
    """

    def __init__(self, message: str, where: Location | None = None) -> None:
        # Names of columns and words of libraries may hold ends of lines.
        self.message = " ".join(message.splitlines())
        self.where = where
        super().__init__(f"{where}: {self.message}" if where else self.message)


class DamagedFileError(InputError):
    """A file that began as one of its kind and cannot be read on."""


def nearest(name: str, options: Iterable[str]) -> str | None:
    """The name that exists and is most like this one, or begins most like it; None where none does."""
    known = list(options)
    near = difflib.get_close_matches(name, known, n=1)
    if near:
        return near[0]
    begun = {one[: len(name) + 1]: one for one in reversed(known)}
    near = difflib.get_close_matches(name, list(begun), n=1, cutoff=0.75)
    return begun[near[0]] if near else None


def suggest(name: str, options: Iterable[str], *, listed: bool = False) -> str:
    """The nearest of the names that exist; all if `listed`, where there are few or none comes near."""
    known = list(options)
    if not known:
        return ""
    near = difflib.get_close_matches(name, known, n=1, cutoff=0.6)
    if not near:
        near = [known_name for known_name in known if known_name.lower() == name.lower()]
    available = "available: " + ", ".join(known)
    if near:
        return f", did you mean '{near[0]}'?" + (f" ({available})" if listed or len(known) <= 12 else "")
    return f", {available}"
