"""The catalogue of effects."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from modelgen.api.results import Shown, Table
from modelgen.effects import CATALOGUE, Definition, Parameter


class Effects(Mapping[str, type[Definition]], Shown):
    """The classes of the effects by name; it shows as the table of `modelgen effects`.

    Parameters
    ----------
    catalogue : mapping of str to type
        The classes by name.
    """

    def __init__(self, catalogue: Mapping[str, type[Definition]]) -> None:
        self._catalogue = catalogue

    def __getitem__(self, name: str) -> type[Definition]:
        return self._catalogue[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._catalogue)

    def __len__(self) -> int:
        return len(self._catalogue)

    def to_json(self) -> list[dict[str, Any]]:
        """Plain data: what `modelgen effects --json` prints.

        Returns
        -------
        list of dict
            Names, texts, references, parameters with units and bounds.
        """
        return [_data(effect) for effect in self._catalogue.values()]

    def shown(self) -> Sequence[str | Table]:
        """Lines and tables of `modelgen effects`.

        Returns
        -------
        sequence of str or Table
            In the order in which they are printed.
        """
        rows = []
        for effect in self._catalogue.values():
            for i, parameter in enumerate(effect.accepted()):
                head = [effect.name, effect.side] if i == 0 else ["", ""]
                rows.append([*head, parameter.name, _unit(parameter), _bounds(parameter), parameter.text])
        columns = dict.fromkeys(("effect", "side", "parameter", "unit", "bounds", "meaning"), "left")
        return [
            Table("", columns, rows),
            "side: the coordinate x that the effect belongs to, of the motor or of the joint.",
            "units: x is that of the coordinate, q that of the joint's, F that of the force or torque on x.",
        ]

    def __repr__(self) -> str:
        return f"{len(self)} effects: {', '.join(self)}"


def _unit(parameter: Parameter) -> str:
    return parameter.unit.format(f="F", x="x", q="q")


def _bounds(parameter: Parameter) -> str:
    low, high = parameter.bounds
    if math.isinf(low) and math.isinf(high):
        return "any"
    if math.isinf(high):
        return f">= {low:g}"
    return f"{low:g} to {high:g}" if math.isfinite(low) else f"<= {high:g}"


def _data(effect: type[Definition]) -> dict[str, Any]:
    linear = {p.name for p in effect.linear}
    return {
        "name": effect.name,
        "text": effect.text,
        "reference": effect.reference,
        "scope": effect.scope,
        "side": effect.side,
        "confused_with": list(effect.confused_with),
        "experiment": effect.experiment,
        "states": list(effect.states),
        "parameters": [
            {
                "name": p.name,
                "unit": _unit(p),
                "text": p.text,
                "linear": p.name in linear,
                "symbol": p.symbol or None,
                "default": p.default,
                # null: no bound on this side
                "bounds": [bound if math.isfinite(bound) else None for bound in p.bounds],
            }
            for p in effect.accepted()
        ],
    }


EFFECTS = Effects(CATALOGUE)
