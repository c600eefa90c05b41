"""C of every shipped arm: no warning, the values of NumPy and CasADi, the operations that it states."""

from collections.abc import Callable
from functools import cache
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from arms_support import ARMS, EVERY_ARM, VARIANTS, c_text, inputs, library, model
from c_support import (
    C_COMPILERS,
    CXX_COMPILERS,
    WARNINGS,
    Library,
    counted,
    evaluated,
    flat,
    flat_c,
    one_source,
    run,
    shared_library,
    write,
)

from modelgen.backends import Provenance, c_files, casadi_files
from modelgen.functions import Function, Model

PROVENANCE = Provenance("modelgen test", "0" * 64)
EPSILON = {"double": np.finfo(np.float64).eps, "float": np.finfo(np.float32).eps}
TOLERANCE = {"double": 1e-12, "float": 1e-4}
SAMPLES = 10


@cache
def files(name: str, variant: str = "default") -> dict[str, str]:
    return c_text(name) if variant == "default" else c_files(model(name, variant), PROVENANCE)


Compiled = Callable[..., dict[str, Library]]


@pytest.fixture(scope="session")
def compiled(tmp_path_factory: pytest.TempPathFactory) -> Compiled:
    """The libraries of an arm, float and double; each is compiled once."""

    @cache
    def call(name: str, variant: str = "default") -> dict[str, Library]:
        made = model(name, variant)
        if variant == "default":
            return {real: Library(library(name, real, tmp_path_factory), made, real) for real in TOLERANCE}
        folder = tmp_path_factory.mktemp(name)
        write(files(name, variant), folder)
        return {real: Library(shared_library(folder, name, real), made, real) for real in TOLERANCE}

    return call


def casadi_functions(made: Model) -> dict[str, object]:
    (text,) = casadi_files(made, PROVENANCE).values()
    module = ModuleType("generated")
    exec(text, module.__dict__)  # noqa: S102 - the text under test
    functions: dict[str, object] = module.functions()
    return functions


def conditions(made: Model, function: Function, samples: list[list[np.ndarray]]) -> np.ndarray:
    """Condition numbers of the mass matrix at the inputs of a forward dynamics."""
    suffix = function.name.removeprefix("forward_dynamics").removeprefix("_derivatives")
    (mass,) = [f for f in made.functions if f.name == f"mass_matrix{suffix}"]
    names = [a.name for a in function.arguments]
    n = len(made.arm.coordinates)
    given = [[x[names.index(a.name)] for a in mass.arguments] for x in samples]
    return np.asarray(np.linalg.cond(evaluated(mass, given).reshape(-1, n, n)))


def check_values(name: str, variant: str, libraries: dict[str, Library]) -> None:
    made = model(name, variant)
    casadi = casadi_functions(made)
    assert list(casadi) == [f"{name}_{f.name}" for f in made.functions]
    rng = np.random.default_rng(11)
    for f in made.functions:
        samples = [inputs(made, f, rng) for _ in range(SAMPLES)]
        dynamics = f.name.startswith("forward_dynamics")
        factors = conditions(made, f, samples) if dynamics else np.zeros(SAMPLES)
        expected = evaluated(f, samples)
        assert np.isfinite(expected).all(), f.name
        for x, right, factor in zip(samples, expected, factors, strict=True):
            by_casadi = flat(f, casadi[f"{name}_{f.name}"](*x))  # type: ignore[operator]
            allowed = max(TOLERANCE["double"], 50 * EPSILON["double"] * factor)
            assert np.linalg.norm(by_casadi - right) <= allowed * np.linalg.norm(right), f.name
        for real, built in libraries.items():
            # What float cannot hold of the inputs is no error of the code.
            rounded = [[v.astype(built.type).astype(float) for v in x] for x in samples]
            references = evaluated(f, rounded)
            for x, reference, factor in zip(rounded, references, factors, strict=True):
                status, result = built.call(f.name, *x)
                assert status == 0, f.name
                allowed = max(TOLERANCE[real], 50 * EPSILON[real] * factor)
                error = np.linalg.norm(flat_c(result) - reference)
                assert error <= allowed * np.linalg.norm(reference), (f.name, real)


@pytest.mark.parametrize("name", EVERY_ARM)
def test_c_casadi_and_numpy_agree(name: str, compiled: Compiled) -> None:
    check_values(name, "default", compiled(name))


@pytest.mark.parametrize("variant", [v for v in VARIANTS if v != "default"])
@pytest.mark.parametrize(
    "name", [pytest.param(n, marks=pytest.mark.xdist_group(n)) for n in ("ariane4", "scara", "two_fingers")]
)
def test_c_casadi_and_numpy_agree_whatever_the_options(name: str, variant: str, compiled: Compiled) -> None:
    if (name, variant) == ("two_fingers", "effects"):
        pytest.skip("an elastic joint needs a drive with inertia, which this arm has not")
    check_values(name, variant, compiled(name, variant))


@pytest.mark.parametrize("name", EVERY_ARM)
def test_no_warning_in_c_and_cxx_float_and_double(name: str, tmp_path: Path) -> None:
    write(files(name), tmp_path)
    source = one_source(tmp_path)
    include = ["-I", str(tmp_path / "include"), "-fsyntax-only"]
    cxx = [w for w in WARNINGS if w != "-Wmissing-prototypes"]
    for real in ("double", "float"):
        flag = f"-D{name.upper()}_REAL={real}"
        for compiler in C_COMPILERS:
            run([compiler, "-std=c99", *WARNINGS, flag, *include, source])
        for compiler in CXX_COMPILERS:
            run([compiler, "-x", "c++", *cxx, flag, *include, source])


@pytest.mark.parametrize("name", EVERY_ARM)
def test_the_operations_stated_are_those_of_the_text(name: str) -> None:
    for f in model(name).functions:
        text = files(name)[f"src/{name}_{f.name}.c"]
        counts = counted(text, name)
        assert counts == {"other": 0} | dict(f.operations), f.name
        total = counts["mul"] + counts["add"] + counts["neg"]
        stated = f"Operations: {total} ({counts['mul']} mul, {counts['add']} add, {counts['neg']} neg)"
        assert stated in text, f.name
        assert stated in files(name)[f"include/{name}.h"], f.name


@pytest.mark.parametrize("name", EVERY_ARM)
def test_no_input_gives_a_number_that_is_none(name: str, compiled: Compiled) -> None:
    """Every input at its bound, with random signs: the result is finite, or zeros and a status."""
    rng = np.random.default_rng(12)
    for f in model(name).functions:
        for _ in range(SAMPLES):
            x = inputs(model(name), f, rng)
            for i, a in enumerate(f.arguments):
                if a.name not in ("q", "q_m") or not f.ranges:
                    sign = rng.choice([-1.0, 1.0], a.size)
                    x[i] = 0.999 * a.bound / np.sqrt(max(a.size, 1)) * sign
            for built in compiled(name).values():
                status, result = built.call(f.name, *x)
                assert np.isfinite(flat_c(result)).all(), f.name
                assert status == 0 or not flat_c(result).any(), f.name


@pytest.mark.parametrize("name", EVERY_ARM)
def test_float_code_calls_nothing_double_and_has_no_state(name: str, compiled: Compiled) -> None:
    built = compiled(name)["float"]
    symbols = [line.split()[:2] for line in run(["nm", "-P", str(built.path)]).splitlines()]
    math = {"sin", "cos", "tan", "asin", "acos", "atan", "atan2", "sqrt", "exp", "log", "tanh", "fabs", "pow"}
    called = {symbol.split("@")[0] for symbol, kind in symbols if kind in "Uw"}
    assert not called & (math | {"sincos", "malloc", "calloc", "free"})
    own = {symbol: kind for symbol, kind in symbols if symbol.startswith(f"{name}_")}
    assert {f"{name}_{f.name}_float" for f in model(name).functions} <= set(own)
    assert set(own.values()) <= set("TtRr"), "code and constants"


def test_the_arms_live_in_one_program(tmp_path: Path) -> None:
    """All headers in one source file, C and C++."""
    flags = []
    for name in ARMS:
        header = tmp_path / "include" / f"{name}.h"
        header.parent.mkdir(exist_ok=True)
        header.write_text(files(name)[f"include/{name}.h"], encoding="utf-8")
    flags += ["-I", str(tmp_path / "include"), "-fsyntax-only", *WARNINGS]
    source = tmp_path / "all.c"
    source.write_text(
        "".join(f'#include "{name}.h"\n' for name in ARMS) + "int n(void);\nint n(void) { return 0; }\n"
    )
    run([C_COMPILERS[0], "-std=c99", *flags, str(source)])
