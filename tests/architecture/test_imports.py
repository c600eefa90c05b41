"""Data flows one way: a module of modelgen imports only what stands below it, and there are no circles."""

import pytest

from architecture.house import circles, file_graph, files, floors, imports, rooms

# Lowest first. Each name is a module or a package.
ORDER = (
    "version",
    "errors",
    "extras",
    "thresholds",
    "numeric",
    "progress",
    "files",
    "options",
    "resources",
    "jobs",
    "figures",
    "charts",
    "graph",
    "native",
    "symbolic",
    "transmission",
    "description",
    "geometry",
    "effects",
    "model",
    "base_parameters",
    "functions",
    "backends",
    "packaging",
    "generation",
    "importing",
    "drawing",
    "dataset",
    "evaluation",
    "regression",
    "excitation",
    "calibration",
    "simulation",
    "identification",
    "exporting",
    "diagnosis",
    "report",
    "api",
    "fleet",
    "__init__",
    "cli",
    "__main__",
)
# The same of the diagnosis.
STAGES = (
    "__init__",
    "options",
    "equations",
    "evidence",
    "candidates",
    "validation",
    "selection",
    "adequacy",
    "decision",
    "extended",
    "experiment",
    "result",
    "pipeline",
)
ROOMS, FLOORS = 12, 10  # of the diagnosis, at most: what a reader can take in at a glance


def layer(module: str, order: tuple[str, ...] = ORDER, package: str = "modelgen") -> str:
    """Name of the order that a dotted module name belongs to."""
    own = module.removeprefix(package).lstrip(".").split(".")[0]
    return own if own in order else "__init__"


def upward(source: str, module: str, *, package: bool = False) -> list[str]:
    """One line per import that runs up, naming both sides."""
    found = []
    for order, above in ((ORDER, "modelgen"), (STAGES, "modelgen.diagnosis")):
        if not module.startswith(above):
            continue
        own = layer(module, order, above)
        found += [
            f"{module}:{i.line} ({own}) imports {i.target}, which stands above it"
            for i in imports(source, module, package=package)
            if i.target.startswith(f"{above}.")
            and order.index(layer(i.target, order, above)) > order.index(own)
            and not (package and above != "modelgen" and module == above)
        ]
    return found


def test_no_import_runs_up() -> None:
    wrong = [
        line
        for name, path in files().items()
        for line in upward(path.read_text(encoding="utf-8"), name, package=path.stem == "__init__")
    ]
    assert not wrong, "\n".join(wrong)


def test_no_files_import_each_other_in_a_circle() -> None:
    assert circles(file_graph()) == []


def test_the_diagnosis_is_seen_at_a_glance() -> None:
    inside = rooms("modelgen.diagnosis", file_graph())
    assert set(inside) == set(STAGES) - {"__init__"}
    assert len(inside) <= ROOMS
    assert max(floors(inside).values()) <= FLOORS
    assert circles(inside) == []


def test_a_circle_is_seen() -> None:
    graph = {"a": frozenset("b"), "b": frozenset("cd"), "c": frozenset("a"), "d": frozenset()}
    assert circles({name: frozenset(targets) for name, targets in graph.items()}) == [["a", "b", "c"]]
    assert floors(graph) == {"a": 2, "b": 2, "c": 2, "d": 1}


def test_every_module_has_its_place_in_the_order() -> None:
    present = {name.split(".")[1] for name in files() if "." in name}
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
        ("modelgen.transmission", "from .description import Arm"),
        ("modelgen.errors", "def f():\n    from modelgen import graph"),
        ("modelgen.model", "if TYPE_CHECKING:\n    from modelgen.generation import write"),
        ("modelgen.model", "importlib.import_module('modelgen.backends.c')"),
        ("modelgen.api.model", "from modelgen import build_model"),
        ("modelgen.diagnosis.evidence.noise", "from modelgen.diagnosis.selection import stepwise"),
        ("modelgen.diagnosis.equations.rows", "from ..pipeline import diagnose"),
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
        ("modelgen.graph", "from modelgen.version import __version__"),
        ("modelgen", "from modelgen.api.model import build_model"),
        ("modelgen.graph", "from modelgen_extras.cli import main"),
    ],
)
def test_an_import_that_runs_down_or_sideways_is_free(module: str, source: str) -> None:
    assert upward(source, module) == []
