"""Whatever the text: arms, or one clear line. Nothing else, and soon."""

import re
import time
from typing import Any

from hypothesis import given, settings
from hypothesis import strategies as st
from ruamel.yaml import YAML

from modelgen.description import Arm, loads, starter
from modelgen.errors import InputError

BASE = starter("arm")
TOKENS = r"""
: , - [ ] { } # & * ! | > ' " % @ ` ? << &a *a !!str ~ null true .nan .inf -.inf 1e999 0 -1 1e-320 9**9**9
pi deg mm "" '' [] {} ((( ))) ** / 1/0 d2 lambda __import__ j1 base shoulder levered fixed prismatic none
1:2 0x1F 0o7 1_0 yes
"""
ODD = [
    "\u00e9",
    "\u00ad",
    "\u2028",
    "\ufeff",
    "\x00",
    "\x07",
    "\U0001f916",
    "%YAML 1.1\n",
    "\n  arm:\n",
    "- - - ",
]
BREAKS = ["\n", "\n\n", "  ", "\t", "\r", "? ", "---\n", "...\n"]
PIECES = st.sampled_from([*TOKENS.split(), *ODD, *BREAKS])


def outcome(text: str) -> None:
    """Loads the text: good arms or a good message, within two seconds of CPU.

    The time is the least of three: the collector of a long run's garbage comes once, a document that takes
    long takes long every time.
    """
    for _ in range(3):
        start = time.thread_time()
        message = ""
        try:
            arms = loads(text)
        except InputError as error:
            message = str(error)
        else:
            assert arms
            assert all(isinstance(arm, Arm) and arm.coordinates for arm in arms.values())
        took = time.thread_time() - start
        if took < 2.0:
            break
    assert took < 2.0
    if message:
        assert re.match(r"arms\.yaml:[1-9][0-9]*:[1-9][0-9]*: ", message)
        assert message.isprintable()
        assert len(message) < 1000


@st.composite
def mutated(draw: st.DrawFn) -> str:
    text = BASE
    for _ in range(draw(st.integers(1, 4))):
        start = draw(st.integers(0, len(text)))
        length = draw(st.sampled_from([0, 1, 1, 2, 5, 20, 200]))
        action = draw(st.sampled_from(["insert", "replace", "delete", "repeat", "number"]))
        cut = text[start : start + length]
        if action == "number":
            digits = [i for i, c in enumerate(text) if c.isdigit()] or [0]
            start = digits[start % len(digits)]
            new, length = draw(st.sampled_from(["-", "0", "1e9", "e5", ".", "deg", " deg", "*"])), 1
        elif action == "delete":
            new = ""
        elif action == "repeat":
            new = cut * 3
        else:
            new = draw(PIECES)
        text = text[:start] + new + text[start + (0 if action == "insert" else length) :]
    return text


@settings(max_examples=400)
@given(mutated())
def test_mutated_text(text: str) -> None:
    outcome(text)


@settings(max_examples=150)
@given(st.text(max_size=200) | st.lists(PIECES, max_size=30).map("".join))
def test_any_text(text: str) -> None:
    outcome(text)


SCALARS: st.SearchStrategy[Any] = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(-3, 3),
    st.integers(),
    st.floats(width=32),
    st.sampled_from(
        ["j1", "base", "90 deg", "5 mm", "pi/2", "d3", "levered", "direct", "none", "fixed", "x"]
    ),
    st.text(max_size=5),
)
VALUES = st.recursive(
    SCALARS,
    lambda inner: (
        st.lists(inner, max_size=3)
        | st.dictionaries(
            st.sampled_from(["j1", "name", "type", "d", "d3", "x"]) | st.text(max_size=3), inner, max_size=3
        )
    ),
    max_leaves=6,
)


Fields = dict[str, st.SearchStrategy[Any]]


def mapping(required: Fields, optional: Fields) -> st.SearchStrategy[dict[str, Any]]:
    """The required keys and any of the others, each with its value or now and then with any other."""
    mostly = [
        {
            key: st.integers(0, 30).flatmap(lambda n, v=value: v if n else VALUES)
            for key, value in fields.items()
        }
        for fields in (required, optional)
    ]
    return st.fixed_dictionaries(mostly[0], optional=mostly[1])


NUMBER = st.one_of(st.floats(-2, 2), st.sampled_from([0, 1, -1, 0.3, "90 deg", "5 mm", "d3", "1/0"]))
LENGTH = st.one_of(st.floats(0.05, 0.5), st.sampled_from(["d3", "50 mm", "d3/2"]))
ANGLE = st.one_of(st.floats(-3, 3), st.sampled_from(["pi/2", "90 deg"]))
PAIR = st.lists(NUMBER, min_size=2, max_size=2)
NAME = st.sampled_from(["j1", "j2", "j3", "j4"])
DIRECT = mapping({"type": st.just("direct"), "ratio": NUMBER, "torque_constant": NUMBER}, {"current": NUMBER})
LEVERED = mapping(
    {
        "type": st.just("levered"),
        "l1": st.just(0.3),
        "l2": st.floats(0.05, 0.1),
        "length": st.lists(st.floats(0.25, 0.35), min_size=2, max_size=2),
        "motor": PAIR,
        "rev": st.sampled_from([1, -1]),
        "offset": ANGLE,
        "torque_constant": NUMBER,
    },
    {},
)
JOINT = mapping(
    {"name": NAME},
    {
        "type": st.sampled_from(["revolute", "revolute", "prismatic", "fixed"]),
        "alpha": ANGLE,
        "d": LENGTH,
        "antecedent": NAME | st.just("base"),
        "limits": mapping({}, {"position": PAIR.map(lambda x: sorted(x, key=str)), "velocity": LENGTH}),
        "drive": st.one_of(st.just({"type": "none"}), DIRECT, LEVERED),
        "effects": st.lists(st.sampled_from(["spring", "viscous_friction"]), max_size=2),
    },
)
LINK = mapping(
    {
        "mass": st.floats(0, 9),
        "com": st.lists(LENGTH, min_size=3, max_size=3),
        "inertia": st.sampled_from([[1, 0, 0, 1, 0, 1], [0, 0, 0, 0, 0, 0], [1, 0, 0, 1, 0, 3]]),
    },
    {},
)
ARM = mapping(
    {
        "symbols": st.just({"d3": 0.4}),
        "joints": st.lists(JOINT, min_size=1, max_size=3, unique_by=lambda joint: str(joint["name"])),
    },
    {"locked": st.dictionaries(NAME, ANGLE, max_size=1), "links": st.dictionaries(NAME, LINK, max_size=1)},
)
DOCUMENT = st.fixed_dictionaries(
    {
        "schema": st.just(1),
        "convention": st.just("khalil_kleinfinger"),
        "arms": st.dictionaries(st.sampled_from(["a", "b1", "A", "int"]), ARM, min_size=1, max_size=2),
    }
)


def flow(value: Any) -> str:
    """YAML flow text, independent of the reader under test."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{flow(key)}: {flow(item)}" for key, item in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(flow, value)) + "]"
    if isinstance(value, str):
        escaped = "".join(
            c if (c.isalnum() and c.isascii()) or c in " /_" else f"\\U{ord(c):08x}" for c in value
        )
        return f'"{escaped}"'
    words = {None: "null", True: "true", False: "false"}
    if value is None or isinstance(value, bool):
        return words[value]
    return {"nan": ".nan", "inf": ".inf", "-inf": "-.inf"}.get(repr(value), repr(value))


@settings(max_examples=400)
@given(DOCUMENT)
def test_structured_documents(document: dict[str, Any]) -> None:
    outcome(flow(document))


def test_the_mutations_reach_both_outcomes() -> None:
    """The fuzzing means something: the text before the mutation is a good one."""
    assert list(loads(BASE)) == ["arm"]
    assert list(loads(flow(YAML(typ="safe", pure=True).load(BASE)))) == ["arm"]
