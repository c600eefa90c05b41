"""C of hand-made functions: it compiles without a warning, is right, and says when it cannot be."""

import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from backends_support import UNARY, calls_function, planar_model
from c_support import (
    C_COMPILERS,
    CXX_COMPILERS,
    WARNINGS,
    Library,
    counted,
    flat,
    flat_c,
    run,
    shared_library,
    sources,
    tokens,
    write,
)

from modelgen.backends import NumpyFunction, Provenance, c_files
from modelgen.backends.c.dialect import arrays, literal
from modelgen.functions.objects import STATUS_INPUT, STATUS_PIVOT, STATUS_STROKE, Function

MODEL = planar_model(extra=(calls_function(),))
FUNCTIONS = {f.name: f for f in MODEL.functions}
FILES = c_files(MODEL, Provenance("modelgen test", "0" * 64))
MAIN = r"""
#include <stdio.h>
#include "planar.h"
int main(void) {
    unsigned k;
    printf("%d %d %d", PLANAR_N_JOINTS, PLANAR_N_LINKS, PLANAR_N_PARAMETERS);
    printf(" %d %d", PLANAR_N_STANDARD_PARAMETERS, PLANAR_N_PACKED);
    printf(" %d %d", (int)PLANAR_PARAMETER_MX1R, (int)PLANAR_STANDARD_M2);
    for (k = 0; k < PLANAR_N_PACKED; ++k) {
        printf(" %d,%d", planar_regressor_rows[k], planar_regressor_columns[k]);
    }
    return 0;
}
"""
TOLERANCE = {"double": 1e-12, "float": 1e-4}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("c")
    write(FILES, path)
    return path


@pytest.fixture(scope="module", params=["double", "float"])
def library(request: pytest.FixtureRequest, folder: Path) -> Library:
    return Library(shared_library(folder, "planar", request.param), MODEL, request.param)


def inputs(f: Function, rng: np.random.Generator) -> list[np.ndarray]:
    """Positive masses: the first link's inertia outweighs what the second adds."""
    values = [rng.uniform(-1, 1, a.size) for a in f.arguments]
    for argument, value in zip(f.arguments, values, strict=True):
        if argument.name == "parameters":
            value[:2] = rng.uniform(6, 7), rng.uniform(1, 2)
    return values


@pytest.mark.parametrize("real", ["double", "float"])
@pytest.mark.parametrize("optimise", ["-O0", "-O2"])
@pytest.mark.parametrize("compiler", C_COMPILERS)
def test_c99_without_a_warning(folder: Path, tmp_path: Path, compiler: str, optimise: str, real: str) -> None:
    flags = ["-std=c99", *WARNINGS, optimise, f"-DPLANAR_REAL={real}", "-I", str(folder / "include")]
    for source in sources(folder):
        run([compiler, *flags, "-c", source, "-o", str(tmp_path / f"{Path(source).stem}.o")])


@pytest.mark.parametrize("real", ["double", "float"])
@pytest.mark.parametrize("compiler", CXX_COMPILERS)
def test_cxx_without_a_warning(folder: Path, tmp_path: Path, compiler: str, real: str) -> None:
    flags = ["-x", "c++", *(w for w in WARNINGS if w != "-Wmissing-prototypes"), "-Wmissing-declarations"]
    for source in sources(folder):
        out = ["-c", source, "-o", str(tmp_path / f"{Path(source).stem}.o")]
        run([compiler, *flags, f"-DPLANAR_REAL={real}", "-I", str(folder / "include"), *out])


def test_every_literal_of_float_code_is_a_float(folder: Path, tmp_path: Path) -> None:
    flags = ["-std=c99", *WARNINGS, "-Wunsuffixed-float-constants", "-DPLANAR_REAL=float"]
    for source in sources(folder):
        run(
            [C_COMPILERS[0], *flags, "-I", str(folder / "include"), "-c", source, "-o", str(tmp_path / "x.o")]
        )


@pytest.mark.parametrize("real", ["double", "float"])
def test_no_allocation_no_state_and_one_precision(folder: Path, tmp_path: Path, real: str) -> None:
    double = {name if name != "abs" else "fabs" for name in (*UNARY, "atan2", "pow") if name != "sign"}
    allowed = double if real == "double" else {f"{name}f" for name in double}
    called = set()
    for source in sources(folder):
        out = tmp_path / f"{Path(source).stem}.o"
        run(
            [
                C_COMPILERS[0],
                "-std=c99",
                f"-DPLANAR_REAL={real}",
                "-I",
                str(folder / "include"),
                "-c",
                source,
                "-o",
                str(out),
            ]
        )
        for line in run(["nm", "-P", str(out)]).splitlines():
            name, kind = line.split()[:2]
            assert kind.upper() not in "BDCSG", f"{out.name}: {name} is writable data"
            called |= {name} if kind == "U" else set()
    assert called <= allowed | {"planar_sincos", "planar_sincos_float"}
    assert not {"sin", "cos", "sinf", "cosf"} & called


@pytest.mark.parametrize("name", sorted(FUNCTIONS))
def test_c_gives_what_numpy_gives(library: Library, name: str) -> None:
    f = FUNCTIONS[name]
    rng = np.random.default_rng(5)
    tolerance = TOLERANCE["float" if library.type == np.float32 else "double"]
    for _ in range(50):
        x = [v.astype(library.type).astype(float) for v in inputs(f, rng)]
        if name == "calls":
            x[0][1] = abs(x[0][1])  # what has a square root and a logarithm
        status, result = library.call(name, *x)
        expected = flat(f, NumpyFunction(f)(*x))
        assert status == 0
        difference = np.linalg.norm(flat_c(result) - expected)
        assert difference <= tolerance * max(1.0, np.linalg.norm(expected))


def test_the_sign_of_zero_is_zero(library: Library) -> None:
    _, result = library.call("calls", [0.0, 0.5])
    assert result["out"][UNARY.index("sign")] == 0


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf, 1.1e6, -2e7])
@pytest.mark.parametrize("name", [n for n in sorted(FUNCTIONS) if n != "calls"])
def test_an_input_that_is_not_finite_or_too_large_gives_zeros(
    library: Library, name: str, bad: float
) -> None:
    f = FUNCTIONS[name]
    good = inputs(f, np.random.default_rng(6))
    for i, argument in enumerate(f.arguments):
        for element in {0, argument.size - 1}:
            x = [v.copy() for v in good]
            x[i][element] = bad
            status, result = library.call(name, *x)
            assert status & STATUS_INPUT
            assert not flat_c(result).any()


def test_the_bound_is_on_the_norm(library: Library) -> None:
    inside, outside = 0.999e6 / np.sqrt(6), 1.001e6 / np.sqrt(6)
    assert library.call("gravity", [0, 0], [inside] * 6)[0] == 0
    assert library.call("gravity", [0, 0], [outside] * 6)[0] == STATUS_INPUT


def test_outside_its_range_a_function_gives_zeros(library: Library) -> None:
    p = [3.0, 0.5, 1, 0, 0.4, 0]
    assert library.call("inverse_dynamics", [0, 2.49], [0, 0], [0, 0], p)[0] == 0
    for q2 in (2.51, -2.51):
        status, result = library.call("inverse_dynamics", [0, q2], [0, 0], [0, 0], p)
        assert status == STATUS_STROKE
        assert not flat_c(result).any()
    status, _ = library.call("inverse_dynamics", [0, 2.51], [np.nan, 0], [0, 0], p)
    assert status == STATUS_STROKE | STATUS_INPUT


@pytest.mark.parametrize("p", [[1, 0, 0, 0, 0, 0], [1, -0.5, 0, 0, 0, 0], [0.1, 0.5, 0, 0, 3, 0], [0] * 6])
def test_a_mass_matrix_that_is_not_positive_gives_zeros(library: Library, p: list[float]) -> None:
    """Determinants 0, negative, negative by the coupling, and no mass at all."""
    status, result = library.call("forward_dynamics", [0.1, 0.2], [0, 0], [1, 1], p)
    assert status == STATUS_PIVOT
    assert not flat_c(result).any()


def test_a_result_that_overflows_gives_zeros(library: Library) -> None:
    tiny = 1e-30
    status, result = library.call(
        "forward_dynamics", [0.1, 0.2], [0, 0], [1e5, 1e5], [tiny, tiny, 0, 0, 0, 0]
    )
    assert status == STATUS_PIVOT
    assert not flat_c(result).any()


@pytest.mark.parametrize("name", sorted(FUNCTIONS))
def test_the_operations_are_those_of_the_text(name: str) -> None:
    text = FILES[f"src/planar_{name}.c"]
    counts = counted(text, "planar")
    assert counts == dict(FUNCTIONS[name].operations)
    total = counts["mul"] + counts["add"] + counts["neg"]
    stated = f"Operations: {total} ({counts['mul']} mul, {counts['add']} add, {counts['neg']} neg)"
    assert stated in text
    assert stated in FILES["include/planar.h"]


def test_the_count_of_operations_sees_what_it_should() -> None:
    text = """a_status_t a_f(const r x[], r out[]) {
        const r t0 = -x[0] * A_C(-2.0) - x[1] / -A_SIN(x[0]);
        out[0] = a_sign(t0);
        return A_OK; }"""
    counts = counted(text, "a")
    assert counts == {"mul": 1, "add": 1, "neg": 2, "div": 1, "sqrt": 0, "trig": 1, "other": 1}


def test_header_and_source_of_different_generations_do_not_meet(folder: Path, tmp_path: Path) -> None:
    for name in ("include/planar.h", "src/planar_private.h"):
        target = tmp_path / name
        target.parent.mkdir(exist_ok=True)
        text = (folder / name).read_text()
        number = text.split("PLANAR_GENERATION", 1)[1].lstrip(" !=").split()[0]
        target.write_text(text.replace(number, "0x1UL"))
    shutil.copy(folder / "src/planar_gravity.c", tmp_path / "src")
    source = str(tmp_path / "src/planar_gravity.c")
    done = subprocess.run(
        [
            C_COMPILERS[0],
            "-std=c99",
            "-I",
            str(tmp_path / "include"),
            "-c",
            source,
            "-o",
            str(tmp_path / "x.o"),
        ],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode
    assert "planar.h and planar_gravity.c are of different generations" in done.stderr


def test_another_type_is_refused(folder: Path, tmp_path: Path) -> None:
    source = str(folder / "src/planar_gravity.c")
    command = [
        C_COMPILERS[0],
        "-DPLANAR_REAL=int",
        "-I",
        str(folder / "include"),
        "-c",
        source,
        "-o",
        str(tmp_path / "x.o"),
    ]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode
    assert "PLANAR_REAL must be float or double" in done.stderr


def test_the_sine_of_the_target_may_be_plugged_in(folder: Path, tmp_path: Path) -> None:
    """A cosine in place of the sine shows in the result of the first pose."""
    library = tmp_path / "plugged.so"
    flags = ["-std=c99", "-fPIC", "-shared", "-DPLANAR_SIN=cos", "-I", str(folder / "include")]
    run([C_COMPILERS[0], *flags, *sources(folder), "-o", str(library), "-lm"])
    _, result = Library(library, MODEL, "double").call("forward_kinematics", [0.5, 0.0])
    assert result["out"][4] == np.cos(0.5)


def test_names_of_parameters_and_sizes_are_in_the_header(folder: Path, tmp_path: Path) -> None:
    program = tmp_path / "main.c"
    program.write_text(MAIN)
    binary = tmp_path / "main"
    flags = ["-std=c99", "-I", str(folder / "include"), "-o", str(binary)]
    run([C_COMPILERS[0], *flags, str(program), *sources(folder), "-lm"])
    packed = " ".join(f"{r},{c}" for r, c in zip(MODEL.packed.rows, MODEL.packed.columns, strict=True))
    assert run([str(binary)]) == f"2 2 6 20 9 2 19 {packed}"


def test_packed_values_are_the_non_zeros_of_the_matrix(library: Library) -> None:
    x = inputs(FUNCTIONS["regressor"], np.random.default_rng(8))
    matrix = library.call("regressor", *x)[1]["out"].reshape(2, 6)
    packed = library.call("regressor_packed", *x)[1]["out"]
    dense = np.zeros((2, 6), dtype=library.type)
    dense[MODEL.packed.rows, MODEL.packed.columns] = packed
    np.testing.assert_array_equal(matrix, dense)


def test_text_of_a_user_cannot_end_a_comment() -> None:
    header = FILES["include/planar.h"]
    assert "made up * / for the tests" in header
    assert list(tokens(header))  # what is left without comments is C


@pytest.mark.parametrize("value", [0.1, -9.81, 1e-5, 1.0, 1e12, 1 / 3, 123456789.0, 1e22, 5e-324 * 0])
def test_a_literal_gives_back_its_number(value: float) -> None:
    text = literal("a", value)
    assert float(text.removeprefix("A_C(").removesuffix(")")) == value
    assert "." in text or "e" in text  # a floating literal, to which f can be appended


@pytest.mark.parametrize("value", [1e39, -1e-39])
def test_a_constant_that_single_precision_cannot_hold_is_refused(value: float) -> None:
    with pytest.raises(ValueError, match="out of the range of single precision"):
        literal("a", value)


def test_one_file_for_each_function() -> None:
    assert set(FILES) == {
        "include/planar.h",
        "src/planar_private.h",
        "src/planar_check_parameters.c",
        "src/planar_onto_strokes.c",
        "src/planar_model.c",
        "src/planar_sincos.c",
        *(f"src/planar_{name}.c" for name in FUNCTIONS),
    }
    for name, f in FUNCTIONS.items():
        text = FILES[f"src/planar_{name}.c"]
        assert all(f"planar_real_t {a.name}[" in text for a in f.arguments)
        assert all(f"planar_real_t {array}[" in text for array in arrays(f))
