"""`import modelgen`: light, complete, and the same for a type checker."""

import ast
import inspect
import subprocess
import sys
from pathlib import Path

import pytest

import modelgen

HEAVY = ("numpy", "scipy", "sympy", "casadi", "matplotlib", "pydantic", "pandas", "polars", "pyarrow")


def test_importing_modelgen_imports_no_library() -> None:
    code = f"import sys, modelgen; print([name for name in {HEAVY!r} if name in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_every_name_resolves_and_is_listed() -> None:
    for name in modelgen.__all__:
        assert getattr(modelgen, name) is not None
        assert name in dir(modelgen)


def test_a_name_that_there_is_not_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match="no_such_name"):
        _ = modelgen.no_such_name


def test_type_checkers_see_the_names_that_are_imported_lazily() -> None:
    tree = ast.parse(Path(inspect.getfile(modelgen)).read_text("utf-8"))
    (block,) = (
        node for node in tree.body if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING"
    )
    seen = {
        alias.name: node.module
        for node in block.body
        if isinstance(node, ast.ImportFrom)
        for alias in node.names
    }
    assert seen == modelgen._HOME
    assert sorted({*seen, "InputError", "__version__"}) == sorted(modelgen.__all__)


@pytest.mark.parametrize(
    ("given", "found"),
    [("arms.yaml", r"the text 'arms.yaml'.*load_arms\('arms.yaml'\)\[NAME\]"), ({}, "0 arms"), (3, "int")],
)
def test_what_is_no_arm_is_told_from_one(given: object, found: str) -> None:
    """In every function that is about one."""
    calls = {
        "identify": (["a.csv"], ["b.csv"]),
        "diagnose": (["a.csv", "b.csv"], "c.csv"),
        "simulate": (),
        "excite": (),
        "calibrate": (1, "a.csv"),
        "refine": ("a.csv",),
        "draw": (),
        "build_model": (),
    }
    for name, more in calls.items():
        with pytest.raises(modelgen.InputError, match=f"arm: found {found}"):
            getattr(modelgen, name)(given, *more)
    with pytest.raises(modelgen.InputError, match=f"arm: found {found}"):
        modelgen.export(given, to="urdf")
    if isinstance(given, str):
        with pytest.raises(modelgen.InputError, match=f"arm: found {found}"):
            modelgen.generate(given, "nowhere")
