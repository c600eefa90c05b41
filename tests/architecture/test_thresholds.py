"""A number on which a decision of the diagnosis depends is an entry of its thresholds.

Any other number stands here with the reason why it decides nothing.
"""

import ast
from collections.abc import Iterator
from pathlib import Path

from architecture.house import ROOT

DIAGNOSIS = ROOT / "modelgen" / "diagnosis"
ENTRIES = DIAGNOSIS / "options" / "thresholds"

ACCURACY = "how finely something is computed: another value changes digits"
PRINTED = "what is printed in place of a figure that says no more"
BUDGET = "how long a search goes on: a longer one finds what this one found"
START = "where a search begins: its end is elsewhere"
ROUNDING = "what is smaller is rounding of floating-point arithmetic"
SEED = "of a random generator, so that answers repeat"
MEASURED = "a distribution that was measured"
FORMULA = "part of a formula"
SPLIT = "where a band is cut in two: another cut parts it as well"
OPEN = "a deviation beyond all that can be: what it is of may be anything"
TEXT = "how many digits or items a text shows"
SAID = "the sentence that describes the test says it in words"

CONSTANTS = {
    "adequacy/distinguishable.py": {"SEED": SEED},
    "adequacy/encoder_errors.py": {"SIZE": ACCURACY},
    "adequacy/explained.py": {"NEIGHBOURS": ACCURACY},
    "adequacy/figures_said.py": {"CLEAR": PRINTED, "HARDLY": PRINTED},
    "adequacy/null_distribution.py": {"NULLS": MEASURED},
    "adequacy/motion_functions.py": {"EVEN": ACCURACY, "MEMORIES": ACCURACY, "WAYS": ACCURACY},
    "adequacy/smooth_functions.py": {
        "POINTS": ACCURACY,
        "SAMPLES": ACCURACY,
        "SIZES": ACCURACY,
        "SPREAD": ROUNDING,
    },
    "adequacy/verdict.py": {"LARGER_PART": "the larger part of something is more than half of it"},
    "adequacy/free_form.py": {"SLOW_ROWS": SPLIT},
    "adequacy/log_delay.py": {"ROUNDS": ACCURACY, "NARROWER": ACCURACY},
    "candidates/candidate.py": {"NEAR": ACCURACY},
    "candidates/columns.py": {"TAIL": ROUNDING},
    "candidates/periodogram.py": {"MANY": BUDGET, "PLACES": ACCURACY},
    "candidates/search.py": {
        "REFINEMENTS": ACCURACY,
        "GOLDEN": FORMULA,
        "REACH": START,
        "FAR": START,
        "SECTIONS": ACCURACY,
        "ROUNDS": BUDGET,
        "HALVINGS": ACCURACY,
        "SECANTS": ACCURACY,
        "SETTLED": BUDGET,
    },
    "equations/band.py": {"TURNS": BUDGET, "CLOSE": ACCURACY},
    "equations/effort_errors.py": {"SEED": SEED, "HALVINGS": ACCURACY},
    "equations/position_errors.py": {"SEED": SEED, "THIRD": FORMULA},
    "equations/prior.py": {"NOTHING": ROUNDING},
    "evidence/likelihood.py": {
        "TURNS": BUDGET,
        "SETTLED": ACCURACY,
        "OPEN": ROUNDING,
        "NEGLIGIBLE": ROUNDING,
    },
    "experiment/bench_tests.py": {"PAYLOAD": SAID},
    "experiment/trajectory.py": {
        "SCALES": START,
        "DRAWS": BUDGET,
        "STEPS": BUDGET,
        "BEST": BUDGET,
        "FIRST_STEP": START,
        "GROWTH": FORMULA,
        "DECAY": FORMULA,
    },
    "extended/cause_values.py": {"ROUNDING": ROUNDING},
    "extended/drive_inertia.py": {"SOFTER": START},
    "extended/elastic_doubt.py": {"STEP": ACCURACY},
    "extended/extended_model.py": {
        "HALVES": BUDGET,
        "WHOLES": BUDGET,
        "SHORTER": BUDGET,
        "TOUCH": ACCURACY,
        "LEAST": ACCURACY,
    },
    "extended/test_errors.py": {"DRAWS": ACCURACY, "SEED": SEED},
    "selection/compliance.py": {
        "STARTS": START,
        "FIRST": ACCURACY,
        "SETTLING": ACCURACY,
        "TURNS": ACCURACY,
        "EDGE": START,
        "MOST": BUDGET,
        "FINE": ACCURACY,
        "EVEN": ACCURACY,
        "SINGULAR": ROUNDING,
        "LEAST": ROUNDING,
    },
    "selection/deviations.py": {"STEP": ACCURACY, "LEAST": ACCURACY, "OPEN": ROUNDING},
    "selection/hidden_weight.py": {"UNKNOWN": OPEN},
    "selection/refit.py": {"TURNS": BUDGET, "CLOSE": ACCURACY, "NEAR": ACCURACY, "WORSE": ROUNDING},
    "selection/pairs.py": {"REFITTED": BUDGET},
    "selection/refit_by_load.py": {
        "TURNS": BUDGET,
        "HALVINGS": BUDGET,
        "LEAST_GAIN": ACCURACY,
        "TOUCH": ACCURACY,
        "LEAST": ACCURACY,
    },
    "selection/elastic_fit.py": {
        "STEPS": BUDGET,
        "CLOSE": ACCURACY,
        "TOUCH": ACCURACY,
        "LEAST": ACCURACY,
        "ASTRAY": "a misfit that no comparison exceeds",
    },
    "selection/refit_elastic.py": {"TURNS": BUDGET, "CLOSE": ACCURACY, "LEAST": BUDGET, "MOST": BUDGET},
    "validation/agreement.py": {"DRAWS": ACCURACY, "SEED": SEED},
}
LITERALS: dict[str, dict[float, str]] = {
    "adequacy/free_form.py": {3: "of two records a size in each is the size in one of them"},
    "adequacy/distinguishable.py": {
        400: ACCURACY,
        0.01: "the sampling period of a made-up motion",
        1e-5: ROUNDING,
    },
    "candidates/candidate.py": {0.95: "the size of a motion, from which a search begins"},
    "candidates/periodogram.py": {
        3: "a wave needs some turns within the range to be one",
        8: ACCURACY,
        4000: BUDGET,
        200: "how much memory is used at once",
    },
    "equations/checks.py": {3: TEXT},
    "equations/free_motion.py": {1.4826: FORMULA},
    "equations/position_errors.py": {3: FORMULA},
    "experiment/bench_tests.py": {5: "how steep a speed is reversed, as the docstring says"},
    "experiment/experiment.py": {4: TEXT},
    "extended/extended_model.py": {4: "a window has samples to be simulated at"},
    "extended/elastic_doubt.py": {4: FORMULA},
    "extended/test_errors.py": {5: "a number of columns"},
    "result/reported.py": {3: TEXT},
    "selection/compliance.py": {1e6: "a misfit that no comparison exceeds"},
}
# Zero, one, two, a half, hundred per cent; what guards a division; sorts of nothing.
PLAIN = {0, 1, 2, 0.5, 100}
TINY = 1e-6


def sources() -> Iterator[tuple[str, ast.Module]]:
    for path in sorted(DIAGNOSIS.rglob("*.py")):
        if ENTRIES not in path.parents:
            yield path.relative_to(DIAGNOSIS).as_posix(), ast.parse(path.read_text(encoding="utf-8"))


def numbers(node: ast.AST) -> set[float]:
    """Numbers written anywhere below a node."""
    return {
        n.value
        for n in ast.walk(node)
        if isinstance(n, ast.Constant) and isinstance(n.value, int | float) and not isinstance(n.value, bool)
    }


def constants(tree: ast.Module) -> dict[str, ast.stmt]:
    """Assignments of numbers to names in capitals at the top of a module."""
    found = {}
    for statement in tree.body:
        targets: list[ast.expr] = []
        if isinstance(statement, ast.Assign):
            targets = statement.targets
        elif isinstance(statement, ast.AnnAssign):
            targets = [statement.target]
        if targets and statement.value is not None and numbers(statement.value):  # type: ignore[attr-defined]
            names = [n for t in targets for n in ast.walk(t) if isinstance(n, ast.Name)]
            found |= {n.id: statement for n in names if n.id.isupper()}
    return found


def bare(tree: ast.Module) -> set[float]:
    """Numbers of a module that may decide something: neither plain, nor tiny, nor a constant's."""
    named = set(map(id, constants(tree).values()))
    rest = [s for s in tree.body if id(s) not in named]
    return {x for s in rest for x in numbers(s) if x not in PLAIN and x > TINY}


def test_every_constant_of_the_diagnosis_has_a_reason_to_be_none_of_its_thresholds() -> None:
    found = {name: set(constants(tree)) for name, tree in sources()}
    assert {name: names for name, names in found.items() if names} == {
        name: set(reasons) for name, reasons in CONSTANTS.items()
    }


def test_every_number_in_the_code_of_the_diagnosis_has_a_reason_to_be_none_of_its_thresholds() -> None:
    found = {name: bare(tree) for name, tree in sources()}
    assert {name: values for name, values in found.items() if values} == {
        name: set(reasons) for name, reasons in LITERALS.items()
    }


def test_a_bare_number_is_seen() -> None:
    tree = ast.parse(
        "LIMIT: float = 7.0\nA, B = 3, (4.0, 5.0)\n\n\ndef f(x):\n    return x > 0.3 or x < 1e-9\n"
    )
    assert set(constants(tree)) == {"LIMIT", "A", "B"}
    assert bare(tree) == {0.3}


def test_no_function_of_the_diagnosis_has_thresholds_by_default() -> None:
    """A caller who forgets them would decide by others than the user's. The options alone have usual ones."""
    for name, tree in sources():
        if Path(name).parts[0] == "options":
            continue
        for node in ast.walk(tree):
            if isinstance(node, ast.FunctionDef):
                given = [*node.args.defaults, *(d for d in node.args.kw_defaults if d is not None)]
            elif isinstance(node, ast.ClassDef):
                given = [s.value for s in node.body if isinstance(s, ast.AnnAssign) and s.value is not None]
            else:
                continue
            used = {n.id for g in given for n in ast.walk(g) if isinstance(n, ast.Name)}
            assert not any(u == "USUAL" or u.endswith("Thresholds") for u in used), f"{name}: {node.name}"
