"""Figures of a drive are the values that its description gives, each with its unit and meaning."""

from __future__ import annotations

from dataclasses import dataclass


class FigureError(ValueError):
    """Figures that make no mechanism. at: the figure to blame, and the place in it where it is a pair."""

    def __init__(self, message: str, *at: str | int) -> None:
        super().__init__(message)
        self.at = at


@dataclass(frozen=True)
class Figure:
    """Annotation of a drive's field: `rod: Annotated[Scalar, Figure("length", "... [m].")]`.

    kind: "length" [m], "angle" [rad], "plain" (in the unit that `text` says) or "sign" (1 or -1). text: for
    the JSON Schema, with the unit in brackets. must: "positive", "nonzero" or "". pair: two values. symbolic:
    whether it may be an expression in the arm's symbols.
    """

    kind: str
    text: str
    must: str = ""
    pair: bool = False
    symbolic: bool = True
