"""An option, written once: its default, its meaning, and how the command line spells it."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field, fields, replace
from inspect import cleandoc
from os import PathLike, fspath
from typing import Any, TypeVar

from modelgen.errors import InputError, suggest

T = TypeVar("T")

KEY = "option"


@dataclass(frozen=True)
class Option:
    """An option's properties beside its default.

    text: its meaning, as --help prints it. metavar: placeholder of its value. flags: spellings, by default
    the field's name. kind: type of the text on the command line, by default that of the field. choices: the
    words that are known. least: lowest number. inverted: the flag stands for False. unit: of its value.
    doc: its meaning in Python, where it differs. quiet: --help does not show the default.
    """

    text: str
    metavar: str | None = None
    flags: tuple[str, ...] = ()
    kind: Any = None
    choices: tuple[str, ...] = ()
    least: int | None = None
    inverted: bool = False
    unit: str = ""
    doc: str = ""
    quiet: bool = False


def option(
    default: Any,
    text: str,
    metavar: str | None = None,
    flags: Collection[str] = (),
    *,
    kind: Any = None,
    choices: Collection[str] = (),
    least: int | None = None,
    inverted: bool = False,
    unit: str = "",
    doc: str = "",
    quiet: bool = False,
) -> Any:
    """A field of an options dataclass; the arguments are those of Option."""
    known = Option(text, metavar, tuple(flags), kind, tuple(choices), least, inverted, unit, doc, quiet)
    return field(default=default, metadata={KEY: known})


def options_of(owner: Any) -> Mapping[str, Option]:
    """The options among a dataclass's fields, by name, in their order."""
    return {f.name: f.metadata[KEY] for f in fields(owner) if KEY in f.metadata}


def documented(*, fields_beside: Mapping[str, str] | None = None) -> Callable[[type[T]], type[T]]:
    """A decorator that appends the parameters of an options dataclass to its docstring, in NumPy form.

    fields_beside: the meaning of fields that are no options of the command line, by name.
    """

    def with_parameters(owner: type[T]) -> type[T]:
        known = options_of(owner)
        beside = fields_beside or {}
        lines = []
        for f in fields(owner):  # type: ignore[arg-type]
            text = known[f.name].doc or known[f.name].text if f.name in known else beside[f.name]
            unit = known[f.name].unit if f.name in known else ""
            # Text of the command line says "repeatable" where Python takes a sequence.
            text = text.replace("; repeatable", "")
            default = f", default {f.default!r}" if isinstance(f.default, str | int | float) else ", optional"
            lines += [f"{f.name} : {f.type}{default}", f"    {text}{f' Unit: {unit}.' if unit else ''}"]
        body = "\n".join(["", "", "Parameters", "----------", *lines, ""])
        owner.__doc__ = cleandoc(owner.__doc__ or "") + body
        return owner

    return with_parameters


def changed(options: T, changes: Mapping[str, Any]) -> T:
    """Options with other values; whole numbers become floats where the field is one, as on the command line.

    Raises InputError for a name that there is not.
    """
    known = [f.name for f in fields(options)]  # type: ignore[arg-type]
    for name in changes:
        if name not in known:
            raise InputError(f"found the option '{name}'{suggest(name, known)}")
    made = replace(options, **changes)  # type: ignore[type-var]
    whole = {
        f.name: float(value)
        for f in fields(made)  # type: ignore[arg-type]
        if f.type in ("float", "float | None") and type(value := getattr(made, f.name)) is int
    }
    return replace(made, **whole) if whole else made  # type: ignore[type-var]


def words_of(options: Any, names: Collection[str] | None = None) -> list[str]:
    """Options other than their defaults, as the command line spells them; of these names alone, if given.

    What no command line has, a table say, is left out.
    """
    words: list[str] = []
    known = options_of(options)
    for f in fields(options):
        value = getattr(options, f.name)
        if f.name not in known or (names is not None and f.name not in names) or value == f.default:
            continue
        flag = next(iter(known[f.name].flags[-1:]), f"--{f.name.replace('_', '-')}")
        if isinstance(value, bool):
            words.append(flag)
        elif isinstance(value, frozenset):
            words += [flag, ",".join(sorted(value))] if value else []
        elif isinstance(value, tuple | list):
            words += [word for each in value for word in (flag, str(each))]
        elif isinstance(value, float):
            words += [flag, f"{value:.12g}"]
        elif isinstance(value, str | int | PathLike):
            words += [flag, str(fspath(value) if isinstance(value, PathLike) else value)]
    return words
