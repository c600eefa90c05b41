"""The one exception that a user's mistake raises, and where in the file the mistake is."""

from __future__ import annotations

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

    `message` says what was found, what was expected, what is available and the likely fix;
    `where` is the place in the description when the mistake has one.
    """

    def __init__(self, message: str, where: Location | None = None) -> None:
        self.message = message
        self.where = where
        super().__init__(f"{where}: {message}" if where else message)
