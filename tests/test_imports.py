"""Data flow one way: a module of modelgen imports only what stands below it."""

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

PACKAGE = Path(__file__).resolve().parent.parent / "modelgen"

# Lowest first. Each name is a module or a package; inside one package imports are free.
ORDER = (
    "__init__",
    "errors",
    "numeric",
    "resources",
    "jobs",
    "figures",
    "graph",
    "linkages",
    "description",
    "geometry",
    "transmission",
    "effects",
    "model",
    "base_parameters",
    "functions",
    "backends",
    "generation",
    "compiled",
    "probing",
    "dataset",
    "excitation",
    "calibration",
    "identification",
    "simulation",
    "extension",
    "diagnosis",
    "report",
    "fleet",
    "cli",
    "__main__",
)


def layer(module: str) -> str:
    """Top-level name under modelgen that a dotted module name belongs to."""
    parts = module.split(".")
    return parts[1] if len(parts) > 1 and parts[1] in ORDER else "__init__"


def imports(source: str, module: str, *, package: bool) -> Iterator[tuple[int, str]]:
    """Line and dotted name of everything of modelgen that the source of `module` imports, anywhere in it."""
    for node in ast.walk(ast.parse(source)):
        if not isinstance(node, ast.Import | ast.ImportFrom | ast.Call):
            continue
        found: list[str] = []
        if isinstance(node, ast.Import):
            found = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            base = node.module or ""
            if node.level:
                above = module.split(".")
                above = above[: len(above) - node.level + package]
                base = ".".join([*above, base] if base else above)
            found = [f"{base}.{alias.name}" for alias in node.names]
        elif ast.unparse(node.func).rpartition(".")[2] in {"import_module", "__import__"}:
            found = [str(arg.value) for arg in node.args if isinstance(arg, ast.Constant)]
        yield from ((node.lineno, name) for name in found if name.split(".")[0] == "modelgen")


def upward(source: str, module: str, *, package: bool = False) -> list[str]:
    """One line per import that runs up, naming both sides."""
    own = layer(module)
    return [
        f"{module}:{line} ({own}) imports {name} ({layer(name)}), which stands above it"
        for line, name in imports(source, module, package=package)
        if ORDER.index(layer(name)) > ORDER.index(own)
    ]


def dotted(path: Path) -> str:
    parts = path.relative_to(PACKAGE.parent).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def test_no_import_runs_up() -> None:
    wrong = [
        line
        for path in sorted(PACKAGE.rglob("*.py"))
        for line in upward(path.read_text(encoding="utf-8"), dotted(path), package=path.stem == "__init__")
    ]
    assert not wrong, "\n".join(wrong)


def test_every_module_has_its_place_in_the_order() -> None:
    present = {
        path.stem
        for path in PACKAGE.iterdir()
        if path.suffix == ".py" or (path.is_dir() and any(path.rglob("*.py")))
    }
    unknown = sorted(present - set(ORDER))
    assert not unknown, f"give these a place in ORDER: {unknown}"


@pytest.mark.parametrize(
    ("module", "source"),
    [
        ("modelgen.graph", "import modelgen.cli"),
        ("modelgen.graph.node", "from modelgen.description.objects import Arm"),
        ("modelgen.graph.node", "from modelgen import description"),
        ("modelgen.graph.node", "from ..description import objects"),
        ("modelgen.graph.node", "from .. import description"),
        ("modelgen.geometry", "from .transmission import lever"),
        ("modelgen.errors", "def f():\n    from modelgen import graph"),
        ("modelgen.model", "if TYPE_CHECKING:\n    from modelgen.generation import write"),
        ("modelgen.model", "importlib.import_module('modelgen.backends.c')"),
        ("modelgen", "from modelgen.errors import InputError"),
    ],
)
def test_an_import_that_runs_up_is_seen(module: str, source: str) -> None:
    assert len(upward(source, module)) == 1


def test_an_import_that_runs_up_is_seen_in_the_file_of_a_package() -> None:
    assert upward("from ..cli import main", "modelgen.graph", package=True)
    assert not upward("from .cli import main", "modelgen.graph", package=True)


@pytest.mark.parametrize(
    ("module", "source"),
    [
        ("modelgen.cli", "from modelgen.graph import Graph"),
        ("modelgen.backends.c", "from modelgen.backends.casadi import text"),
        ("modelgen.backends.c", "from . import casadi"),
        ("modelgen.graph", "import sympy\nfrom dataclasses import dataclass"),
        ("modelgen.graph", "from modelgen import __version__"),
        ("modelgen.graph", "from modelgen_extras.cli import main"),
    ],
)
def test_an_import_that_runs_down_or_sideways_is_free(module: str, source: str) -> None:
    assert upward(source, module) == []
