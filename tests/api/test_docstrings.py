"""The docstrings of the face are in NumPy form and agree with the signatures.

The form: https://numpydoc.readthedocs.io/en/latest/format.html
"""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterator
from typing import Any

import pytest

import modelgen as mg
from modelgen.api.results import Shown

ORDER = ("Parameters", "Attributes", "Returns", "Raises", "References")
HEADING = re.compile(r"^(\w+)\n(-+)$", re.MULTILINE)
ENTRY = re.compile(r"^(\*{0,2}\w+(?:, \w+)*)(?: : (.+))?$")
# An entry says in which unit or shape a measured quantity is.
QUANTITY = re.compile(r"\[[^\]]+\]|\((?:N|S|M|n|p)(?:,[^)]*)?\)|[Uu]nit")
PLAIN = (bool, int, float, str)


def documented() -> Iterator[tuple[str, Any, bool]]:
    """Name, object, and whether its parameters include self: the face, and public members of its results."""
    for name in mg.__all__:
        thing = getattr(mg, name)
        if isinstance(thing, str):
            continue
        thing = thing if callable(thing) else type(thing)
        yield name, thing, False
        if inspect.isclass(thing) and (issubclass(thing, Shown) or thing in (mg.Record,)):
            for member, value in vars(thing).items():
                if not member.startswith("_") and inspect.isfunction(value):
                    yield f"{name}.{member}", value, True


EVERY = list(documented())


def sections(text: str) -> dict[str, str]:
    """Text of each section by its heading."""
    found = list(HEADING.finditer(text))
    if not found:
        return {}
    ends = [m.start() for m in found[1:]] + [len(text)]
    return {m[1]: text[m.end() : end].strip("\n") for m, end in zip(found, ends, strict=True)}


def entries(section: str) -> dict[str, str]:
    """Text of each entry by its name, its type first."""
    result: dict[str, str] = {}
    names: list[str] = []
    for line in section.splitlines():
        if line.startswith(" "):
            assert names, f"a text without an entry: {line}"
            result |= {name: result[name] + " " + line.strip() for name in names}
        elif line.strip():
            match = ENTRY.match(line)
            assert match, f"no entry: {line}"
            names = match[1].split(", ")
            result |= dict.fromkeys(names, match[2] or "")
    return result


def parameters(thing: Any, method: bool) -> list[str]:
    given = list(inspect.signature(thing).parameters.values())[1 if method else 0 :]
    stars = {inspect.Parameter.VAR_KEYWORD: "**", inspect.Parameter.VAR_POSITIONAL: "*"}
    return [stars.get(p.kind, "") + p.name for p in given]


@pytest.mark.parametrize(("name", "thing", "method"), EVERY, ids=[name for name, *_ in EVERY])
def test_a_docstring_has_the_form_and_the_parameters_of_its_signature(
    name: str, thing: Any, method: bool
) -> None:
    text = inspect.getdoc(thing)
    assert text, name
    first = text.split("\n")[0]
    assert first.endswith("."), first
    assert text == first or text.startswith(f"{first}\n\n"), "a summary of one line, then an empty one"
    for heading, line in HEADING.findall(text):
        assert len(line) == len(heading)
    found = sections(text)
    assert list(found) == [heading for heading in ORDER if heading in found]
    wanted = parameters(thing, method)
    said = entries(found.get("Parameters", ""))
    assert list(said) == wanted
    for parameter, words in said.items():
        assert parameter.startswith("*") or words.split()[0], f"{parameter} has no type"
        assert words.endswith((".", ")")), f"{parameter}: {words}"
    if inspect.isfunction(thing) and inspect.signature(thing).return_annotation not in (None, "None"):
        assert found["Returns"].split("\n")[1].startswith("    ")
    if inspect.isfunction(thing) and not method:
        assert "InputError" in found["Raises"]


def test_what_functions_give_back_and_take_has_shapes_and_units() -> None:
    # Where numbers are measured: the classes that hold them, and the functions that take logs.
    for thing in (mg.Model, mg.Excitation, mg.Identification, mg.Diagnosis, mg.Simulation, mg.Record):
        found = sections(inspect.getdoc(thing) or "")
        assert QUANTITY.search(found["Attributes"]), thing
    for function in (mg.read_log, mg.identify, mg.diagnose, mg.simulate, mg.refine, mg.calibrate):
        assert QUANTITY.search(inspect.getdoc(function) or ""), function


def test_methods_with_estimates_and_optimisation_name_their_source() -> None:
    for function in (mg.build_model, mg.identify, mg.excite, mg.calibrate, mg.diagnose, mg.refine):
        assert "References" in sections(inspect.getdoc(function) or ""), function


@pytest.mark.parametrize(
    "text",
    [
        "No full stop",
        "A summary.\n\nParameters\n---\nx : int\n    A number.",
        "A summary.\n\nReturns\n-------\nint\n    One.\n\nParameters\n----------\nx : int\n    One.",
        "A summary.\n\nParameters\n----------\ny : int\n    Another name.",
        "A summary.\n\nParameters\n----------\nx : int\n    No full stop",
        "A summary.\n\nParameters\n----------\nx : int\n    A number.",
    ],
)
def test_a_docstring_of_another_form_is_seen(text: str) -> None:
    def function(x: int) -> int:
        return x

    function.__doc__ = text
    with pytest.raises((AssertionError, KeyError)):
        test_a_docstring_has_the_form_and_the_parameters_of_its_signature("function", function, False)
