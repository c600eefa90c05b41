"""The model of an arm: base parameters, nominal values, functions over samples."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from typing import Any

from modelgen.api.description import an_arm
from modelgen.api.results import Named, Shown, Table, as_html
from modelgen.backends import NumpyFunction
from modelgen.base_parameters import BaseParameter, for_reading
from modelgen.description import Arm
from modelgen.errors import InputError
from modelgen.functions import Model as Functions
from modelgen.functions import build_model as build
from modelgen.functions import nominal_base
from modelgen.options import ModelOptions, changed

COST = "operations (mul + add + neg)"
KINDS = ("mul", "add", "neg", "div", "sqrt", "trig", "other")


class Model(Shown):
    """The dynamic model of an arm with n coordinates and p base parameters.

    Parameters
    ----------
    built : modelgen.functions.Model
        The functions as programs, as `modelgen.functions.build_model` gives them.

    Attributes
    ----------
    arm : Arm
        The arm as described.
    functions : mapping of str to NumpyFunction
        The emitted functions by name. Arrays hold one sample, (n,), or N samples, (N, n); inputs are given
        by name or in the order of the C code, in its units.
    base_parameters : sequence of BaseParameter
        The p base parameters: name, expression in the standard parameters, unit.
    nominal : Named or None
        Base values (p,) that the description's links and effects give, None where some have none.
    """

    def __init__(self, built: Functions) -> None:
        self.built = built
        self.arm = built.arm
        self.functions: Mapping[str, NumpyFunction] = _Functions(built)
        self.base_parameters: Sequence[BaseParameter] = built.grouping.base

    @cached_property
    def nominal(self) -> Named[float] | None:
        """Base values (p,) that the description's links and effects give, None where some have none."""
        try:
            return Named(nominal_base(self.built))
        except InputError:
            return None

    def to_json(self) -> dict[str, Any]:
        """Plain data: what `modelgen show --json` prints.

        Returns
        -------
        dict
            Arm, coordinates, standard and base parameters, operation counts, notes.
        """
        arm, model = self.arm, self.built
        return {
            "arm": arm.name,
            "joints": len(arm.coordinates),
            "coordinates": arm.coordinate_names,
            "standard_parameters": [p.name for p in model.standard],
            "base_parameters": [
                {"name": p.name, "expression": p.expression, "unit": p.unit} for p in model.grouping.base
            ],
            "nominal": None if self.nominal is None else dict(self.nominal),
            "without_effect": [model.standard[i].name for i in model.grouping.without_effect],
            "functions": {f.name: dict(f.operations) for f in model.functions},
            "notes": [*arm.notes, *model.remarks],
        }

    def shown(self) -> Sequence[str | Table]:
        """Lines and tables of `modelgen show`.

        Returns
        -------
        sequence of str or Table
            In the order in which they are printed.
        """
        arm, model = self.arm, self.built
        names, base, nominal = arm.coordinate_names, model.grouping.base, self.nominal
        parts: list[str | Table] = [
            f"{arm.name}: {len(names)} joint{'s' if len(names) > 1 else ''} ({', '.join(names)})"
        ]
        if arm.source:
            parts.append(f"source: {' '.join(arm.source.split())}")
        parts += [f"note: {note}" for note in (*arm.notes, *model.remarks)]
        known = {} if nominal is None else {"nominal": "right"}
        rows = [
            [str(i), _equation(p), *([f"{nominal[p.name]:z.6g}"] if nominal else []), p.unit]
            for i, p in enumerate(base)
        ]
        columns = {"": "right", "base parameter": "left", **known, "unit": "left"}
        title = f"{len(model.standard)} standard parameters, {len(base)} base parameters"
        counts = costs({f.name: f.operations for f in model.functions})
        return [
            *parts,
            Table(title, columns, rows),
            Table(
                f"{COST}, by the parameters that the function has",
                {"function": "left", "base": "right", "standard": "right"},
                [[name, *map(str, pair)] for name, *pair in counts],
            ),
        ]

    def details(self) -> Sequence[Table]:
        """Tables that `modelgen show --verbose` prints besides.

        Returns
        -------
        sequence of Table
            Standard parameters without effect, operations by kind.
        """
        model, parts = self.built, list[Table]()
        without = [model.standard[i].name for i in model.grouping.without_effect]
        if without:
            heading = {"standard parameters": "left"}
            parts.append(Table("without effect on the input", heading, [[", ".join(without)]]))
        counts = [
            [f.name, str(total(f.operations)), *(str(f.operations.get(kind, 0)) for kind in KINDS)]
            for f in model.functions
        ]
        kinds = {"function": "left", "mul+add+neg": "right", **dict.fromkeys(KINDS, "right")}
        return [*parts, Table("operations by kind", kinds, counts)]

    def _repr_html_(self) -> str:
        return as_html([*self.shown(), *self.details()])

    def __repr__(self) -> str:
        built = self.built
        return (
            f"Model of {self.arm.name}: {len(self.arm.coordinates)} coordinates, "
            f"{len(built.standard)} standard and {len(built.grouping.base)} base parameters, "
            f"{len(built.functions)} functions"
        )


class _Functions(Mapping[str, NumpyFunction]):
    """The functions by name, made ready when they are asked for."""

    def __init__(self, built: Functions) -> None:
        self._programs = {f.name: f for f in built.functions}
        self._ready: dict[str, NumpyFunction] = {}

    def __getitem__(self, name: str) -> NumpyFunction:
        if name not in self._ready:
            self._ready[name] = NumpyFunction(self._programs[name])
        return self._ready[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._programs)

    def __len__(self) -> int:
        return len(self._programs)

    def __repr__(self) -> str:
        return f"functions: {', '.join(self)}"


def build_model(arm: Arm, options: ModelOptions | None = None, **changes: Any) -> Model:
    """Build the dynamic model of an arm.

    Parameters
    ----------
    arm : Arm
        As `load_arms` gives it.
    options : ModelOptions, optional
        How the functions are made.
    **changes
        Fields of the options, by name.

    Returns
    -------
    Model
        Base parameters, nominal values, and functions that take arrays: joint coordinates [rad, m] and
        their derivatives, inputs [A for a driven joint, N m or N for another].

    Raises
    ------
    InputError
        For an effect that lacks a value and an unknown link of the Jacobian.

    References
    ----------
    Khalil and Dombre, Modeling, Identification and Control of Robots, 2002.
    """
    an_arm(arm)
    return Model(build(arm, changed(options or ModelOptions(), changes)))


def total(operations: Mapping[str, int]) -> int:
    """Multiplications, additions and negations."""
    return sum(operations[kind] for kind in ("mul", "add", "neg"))


def costs(operations: Mapping[str, Mapping[str, int]]) -> Iterator[tuple[str, int | str, int | str]]:
    """Name and operations of each function, and those of its twin for the standard parameters, or ""."""
    for name, counts in operations.items():
        plain = name.removesuffix("_standard")
        if plain != name and plain in operations:
            continue
        twin = operations.get(f"{name}_standard")
        yield name, total(counts), "" if twin is None else total(twin)


def _equation(parameter: BaseParameter) -> str:
    """MX2R = MX2 + d3 (M3 + M4), or the name alone where it stands for itself."""
    if parameter.expression == parameter.name:
        return parameter.name
    return f"{parameter.name} = {for_reading(parameter.expression)}"
