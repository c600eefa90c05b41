"""The options of the commands: those of dataclasses as Typer wants them, and what several commands share."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable, Mapping, Sequence
from dataclasses import MISSING, Field, fields, is_dataclass
from enum import StrEnum
from pathlib import Path
from typing import Annotated, Any

import typer

from modelgen.options.field import KEY, Option

Arms = Annotated[
    Path | None,
    typer.Argument(
        metavar="ARMS",
        help="Description in YAML. Default: arms.yaml here, else the shipped arms.",
        show_default=False,
    ),
]
OneArm = Annotated[
    str,
    typer.Option("--arm", metavar="NAME", help="The arm; not needed where there is one.", show_default=False),
]
Train = Annotated[
    list[str], typer.Option(metavar="LOG", help="A training record, FILE or FILE@t0:t1 [s]; repeatable.")
]
Folder = Annotated[Path, typer.Option("--out", metavar="DIR", help="Folder to write into.")]
Parameters = Annotated[
    Path | None,
    typer.Option(metavar="FILE", help="<arm>_parameters.yaml of modelgen identify.", show_default=False),
]
Jobs = Annotated[
    int | None,
    typer.Option(
        "-j", "--jobs", metavar="N", min=1, help="Processes. Default: one per processor.", show_default=False
    ),
]
Dask = Annotated[
    str | None,
    typer.Option(
        "--dask",
        metavar="ADDRESS",
        help="Scheduler of a Dask cluster that has the work: tcp://host:8786.",
        show_default=False,
    ),
]
Verbose = Annotated[bool, typer.Option("--verbose", help="Every remark on the logs too.")]
Json = Annotated[bool, typer.Option("--json", help="Print machine-readable data.")]


def with_options(
    before: Mapping[str, Sequence[str]] | None = None,
) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """A decorator for commands: a parameter whose type is a dataclass becomes its fields, one option each.

    before: names of the command's own parameters by the field that they come before in the help; the
    others keep their places beside the dataclass.
    """

    def decorated(command: Callable[..., None]) -> Callable[..., None]:
        own = inspect.signature(command, eval_str=True).parameters
        owners: dict[str, Any] = {name: p.annotation for name, p in own.items() if is_dataclass(p.annotation)}
        placed = {name for names in (before or {}).values() for name in names}
        order: list[inspect.Parameter] = []
        for name, parameter in own.items():
            if name in owners:
                for f in fields(owners[name]):
                    order += [own[other] for other in (before or {}).get(f.name, ())]
                    if KEY in f.metadata:
                        order.append(_parameter(f))
            elif name not in placed:
                order.append(parameter)

        @functools.wraps(command)
        def call(**given: Any) -> None:
            for name, owner in owners.items():
                known = [f for f in fields(owner) if KEY in f.metadata]
                given[name] = owner(**{f.name: _value(f, given.pop(f.name)) for f in known})
            command(**given)

        keyword = inspect.Parameter.KEYWORD_ONLY
        call.__signature__ = inspect.Signature([p.replace(kind=keyword) for p in order])  # type: ignore[attr-defined]
        call.__annotations__ = {p.name: p.annotation for p in order}
        del call.__wrapped__
        return call

    return decorated


def _parameter(f: Field[Any]) -> inspect.Parameter:
    """A field as a parameter of a command."""
    known: Option = f.metadata[KEY]
    kind: Any = _kind(f, known)
    default: Any = f.default
    if known.choices:
        words = StrEnum(f.name.capitalize(), {word.upper(): word for word in known.choices})  # type: ignore[misc]
        kind, default = words, words(default)
    elif not isinstance(default, bool | int | float | str):
        default = "" if kind is str else None
    more: dict[str, Any] = {} if known.metavar is None else {"metavar": known.metavar}
    if known.least is not None:
        more["min"] = known.least
    if known.quiet or default is None or (kind is str and not default):
        more["show_default"] = False
    flags = known.flags
    if kind is bool and not flags:
        flags = (f"--{f.name.replace('_', '-')}",)
    if known.inverted:
        default = not default
    annotation = Annotated[kind, typer.Option(*flags, help=known.text, **more)]
    return inspect.Parameter(f.name, inspect.Parameter.KEYWORD_ONLY, default=default, annotation=annotation)


def _kind(f: Field[Any], known: Option) -> Any:
    """The type of the text on the command line."""
    if known.kind is not None:
        return list[str] | None if known.kind == list[str] else known.kind
    kind = {"bool": bool, "int": int, "float": float, "str": str}.get(str(f.type))
    if kind is not None:
        return kind
    optional = {"int | None": int | None, "float | None": float | None, "str | None": str | None}
    return optional.get(str(f.type), list[str] | None)


def _value(f: Field[Any], given: Any) -> Any:
    """Convert a value of Typer's to the one that the dataclass takes."""
    known: Option = f.metadata[KEY]
    if known.inverted:
        return not given
    if isinstance(given, StrEnum):
        return str(given)
    if isinstance(given, list):
        return tuple(given)
    return f.default if given is None and f.default is not MISSING else given
