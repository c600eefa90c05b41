"""Functions over many states: what the function itself gives in each, whatever the width of the vectors."""

import ctypes
import platform
from dataclasses import replace
from functools import cache
from pathlib import Path

import mpmath
import numpy as np
import pytest
from arms_support import ARMS, inputs, model
from c_support import C_COMPILERS, CXX_COMPILERS, WARNINGS, one_source, run, write
from peers import growing

from modelgen.backends import Provenance, c_files
from modelgen.backends.c.batch import SHARED
from modelgen.backends.c.dialect import arrays
from modelgen.errors import InputError
from modelgen.functions import Function, Model, Options, build_model

PROVENANCE = Provenance("modelgen test", "0" * 64)
# Levered with a locked joint, sliding, a tree, turning alone; then what options and effects add.
KINDS = [
    pytest.param(name, variant, marks=pytest.mark.xdist_group(name))
    for name, variant in (
        ("ariane4", "default"),
        ("scara", "default"),
        ("two_fingers", "default"),
        ("ur10e", "default"),
        ("ariane4", "effects"),
        ("scara", "effects"),
        ("ariane4", "row_wise"),
        ("ariane4", "runtime_geometry"),
        ("scara", "sincos"),
    )
]
# One of every form: vectors, matrices, several outputs, stacked ones, guards, ranges, states.
SOME = (
    "inverse_dynamics",
    "inverse_dynamics_standard",
    "inverse_dynamics_derivatives",
    "gravity",
    "mass_matrix",
    "forward_dynamics",
    "forward_dynamics_standard",
    "regressor",
    "energy",
    "forward_kinematics",
    "motor_from_joint",
    "joint_from_motor",
    "drive_gain",
)
AGREEMENT = {"double": 1e-12, "float": 1e-5}
# Processors whose vectors have 16, 32 and 64 bytes, and none.
TARGETS = [[], ["-march=x86-64-v3"], ["-march=x86-64-v4"]] if platform.machine() == "x86_64" else [[]]
COUNTS = (0, 1, 5, 23)
vectors = pytest.mark.skipif(
    platform.machine() not in ("x86_64", "AMD64", "aarch64", "arm64"), reason="a processor without vectors"
)


@cache
def batched(name: str, variant: str) -> Model:
    made = model(name, variant)
    few = tuple(f for f in made.functions if f.name in SOME or f.name.endswith("_step"))
    return replace(made, functions=few, batch=tuple(f.name for f in few))


_written: dict[tuple[str, str], Path] = {}


def written(name: str, variant: str, folders: pytest.TempPathFactory) -> Path:
    """Folder of an arm's files, which no test changes."""
    if (name, variant) not in _written:
        folder = folders.mktemp(f"{name}-{variant}")
        write(c_files(batched(name, variant), PROVENANCE), folder)
        _written[name, variant] = folder
    return _written[name, variant]


@cache
def library(folder: Path, name: str, real: str, width: int, *more: str) -> ctypes.CDLL:
    out = folder / f"{real}{width}{''.join(more)}.so"
    macros = [f"-D{name.upper()}_REAL={real}", f"-D{name.upper()}_LANE_BYTES={width}"]
    flags = [
        "-O0",
        "-ffp-contract=off",
        "-Wno-psabi",
        "-std=c99",
        "-fPIC",
        "-shared",
        "-I",
        f"{folder}/include",
    ]
    run([C_COMPILERS[0], *macros, *flags, *more, one_source(folder), "-o", str(out), "-lm"])
    return ctypes.CDLL(str(out))


class Called:
    """A function of a library in single states and in many."""

    def __init__(self, of: ctypes.CDLL, arm: str, function: Function, real: str) -> None:
        self.function, self.type = function, np.dtype(real)
        suffix = "_float" if real == "float32" else ""
        self.single = getattr(of, f"{arm}_{function.name}{suffix}")
        self.many = getattr(of, f"{arm}_{function.name}_batch{suffix}")

    def one(self, given: list[np.ndarray]) -> tuple[int, np.ndarray]:
        """Status and outputs, one after the other."""
        outputs = [np.full(size, np.nan, self.type) for size in arrays(self.function).values()]
        every = [np.ascontiguousarray(x, self.type) for x in given] + outputs
        status = self.single(*(ctypes.c_void_p(x.ctypes.data) for x in every))
        return status, np.concatenate(outputs)

    def none(self, given: list[np.ndarray]) -> int:
        """What no state at all gives: no array is touched but the parameters."""
        every = zip(given, self.function.arguments, strict=True)
        kept = [np.ascontiguousarray(x, self.type) if a.name in SHARED else None for x, a in every]
        pointers = [None if x is None else ctypes.c_void_p(x.ctypes.data) for x in kept]
        status: int = self.many(ctypes.c_size_t(0), *pointers, *[None] * (len(arrays(self.function)) + 1))
        return status

    def all(self, states: list[list[np.ndarray]]) -> tuple[int, np.ndarray, np.ndarray]:
        """What is returned, every state's status, outputs of every state in a row."""
        n = len(states)
        every = []
        for k, a in enumerate(self.function.arguments):
            shared = a.name in SHARED
            table = states[0][k] if shared else np.array([given[k] for given in states]).T
            every.append(np.ascontiguousarray(table, self.type))
        outputs = [np.full((size, n), np.nan, self.type) for size in arrays(self.function).values()]
        status = np.full(n, 99, np.uint32)
        pointers = [ctypes.c_void_p(x.ctypes.data) for x in [*every, *outputs, status]]
        returned = self.many(ctypes.c_size_t(n), *pointers)
        return returned, status, np.concatenate(outputs).T


def spoilt(f: Function, given: list[np.ndarray], k: int) -> list[np.ndarray]:
    """A state with something wrong: not finite, beyond a bound, beyond an end of a stroke."""
    own = [i for i, a in enumerate(f.arguments) if a.size and a.name not in SHARED]
    i = own[k % len(own)]
    changed = [x.copy() for x in given]
    changed[i][k % changed[i].size] = (np.nan, np.inf, 2 * f.arguments[i].bound)[k % 3]
    if f.ranges and k % 2:
        (r, *_), names = f.ranges, [a.name for a in f.arguments]
        changed = [x.copy() for x in given]
        changed[names.index(r.argument)][r.index] = r.high + 1e-3 * (r.high - r.low)
    return changed


@vectors
@pytest.mark.parametrize(("name", "variant"), KINDS)
def test_every_state_has_what_the_function_gives(
    name: str, variant: str, tmp_path_factory: pytest.TempPathFactory
) -> None:
    made, folder = batched(name, variant), written(name, variant, tmp_path_factory)
    rng = np.random.default_rng(3)
    builds = [("double", 32)]
    if (name, variant) == ("two_fingers", "default"):
        builds += [("double", 64), ("double", 16), ("double", 0), ("float", 32)]
    for real, width in builds:
        built = library(folder, name, real, width)
        for f in made.functions:
            called = Called(built, name, f, {"double": "float64", "float": "float32"}[real])
            for n in COUNTS if (real, width) == ("double", 32) else COUNTS[-1:]:
                states = [inputs(made, f, rng) for _ in range(n)]
                for i, a in enumerate(f.arguments):
                    for given in states:
                        given[i] = states[0][i] if a.name in SHARED else given[i]
                wrong = [9, 10] if n > 20 else []
                for k in wrong:
                    states[k] = spoilt(f, states[k], k)
                if n:
                    _compare(called, states, wrong, AGREEMENT[real])
                else:
                    assert called.none(inputs(made, f, rng)) == 0


def _compare(called: Called, states: list[list[np.ndarray]], wrong: list[int], allowed: float) -> None:
    returned, status, found = called.all(states)
    union = 0
    for k, given in enumerate(states):
        expected_status, expected = called.one(given)
        assert status[k] == expected_status, (called.function.name, k)
        assert (expected_status != 0) == (k in wrong), (called.function.name, k)
        error = np.linalg.norm(found[k] - expected)
        assert error <= allowed * np.linalg.norm(expected), (called.function.name, k)
        union |= expected_status
    assert returned == union


@vectors
def test_every_row_of_a_long_arms_regressor_is_found(tmp_path: Path) -> None:
    made = build_model(growing.arm("chain", 18), Options(derivatives=False, watch=False))
    (f,) = [f for f in made.functions if f.name == "regressor"]
    made = replace(made, functions=(f,), batch=(f.name,))
    write(c_files(made, PROVENANCE), tmp_path)
    called = Called(library(tmp_path, made.arm.name, "double", 32), made.arm.name, f, "float64")
    _compare(called, [inputs(made, f, np.random.default_rng(5)) for _ in range(9)], [], AGREEMENT["double"])


@vectors
@pytest.mark.slow
@pytest.mark.xdist_group("two_fingers")
def test_states_near_every_bound_at_once_are_states(tmp_path_factory: pytest.TempPathFactory) -> None:
    """Each input within its bound and all together beyond the sum of squares that a block is tested by."""
    made, folder = batched("two_fingers", "default"), written("two_fingers", "default", tmp_path_factory)
    (f,) = [f for f in made.functions if f.name == "inverse_dynamics"]
    called = Called(library(folder, "two_fingers", "double", 32), "two_fingers", f, "float64")
    rng = np.random.default_rng(4)
    states = [inputs(made, f, rng) for _ in range(9)]
    for given in states:
        given[-1] = states[0][-1]
    for i, a in enumerate(f.arguments):
        if a.name not in SHARED:
            states[5][i] = states[5][i] / np.linalg.norm(states[5][i]) * 0.9 * a.bound
    _compare(called, states, [], AGREEMENT["double"])
    for i, a in enumerate(f.arguments):
        if a.name not in SHARED:
            wrong = [x.copy() for x in states[5]]
            wrong[i] *= 1.2
            _compare(called, [*states[:5], wrong, *states[6:]], [5], AGREEMENT["double"])


@vectors
@pytest.mark.xdist_group("ariane4")
def test_parameters_that_cannot_be_used_are_every_states(tmp_path_factory: pytest.TempPathFactory) -> None:
    made, folder = batched("ariane4", "default"), written("ariane4", "default", tmp_path_factory)
    (f,) = [f for f in made.functions if f.name == "gravity"]
    called = Called(library(folder, "ariane4", "double", 32), "ariane4", f, "float64")
    states = [inputs(made, f, np.random.default_rng(1)) for _ in range(9)]
    parameters = states[0][1]
    parameters[3] = np.nan
    returned, status, found = called.all(states)
    assert returned == 4
    assert (status == 4).all()
    assert not found.any()
    trusting = library(folder, "ariane4", "double", 64, "-DARIANE4_PARAMETERS_CHECKED")
    parameters[3] = 0.0
    assert Called(trusting, "ariane4", f, "float64").all(states)[0] == 0


@pytest.mark.xdist_group("two_fingers")
def test_a_state_that_is_wrong_leaves_its_neighbours(tmp_path_factory: pytest.TempPathFactory) -> None:
    """In a block of four, what a vanishing pivot divides by is not what the other states divide by."""
    made, folder = batched("two_fingers", "default"), written("two_fingers", "default", tmp_path_factory)
    (f,) = [f for f in made.functions if f.name == "forward_dynamics_standard"]
    called = Called(library(folder, "two_fingers", "double", 32), "two_fingers", f, "float64")
    states = [inputs(made, f, np.random.default_rng(1)) for _ in range(8)]
    states[0][-1][:] = 0.0  # nothing has mass, in any state
    returned, status, found = called.all(states)
    assert returned == 2
    assert (status == 2).all()
    assert not found.any()


@vectors
@pytest.mark.parametrize(
    ("name", "real"), [("ariane4", "double"), ("scara", "float"), ("two_fingers", "double")]
)
def test_no_warning_in_c_and_cxx_at_any_width(name: str, real: str, tmp_path: Path) -> None:
    write(c_files(batched(name, "default"), PROVENANCE), tmp_path)
    source, include = one_source(tmp_path), ["-I", str(tmp_path / "include"), "-fsyntax-only"]
    cxx = [w for w in WARNINGS if w != "-Wmissing-prototypes"]
    for target in TARGETS:
        macros = [f"-D{name.upper()}_REAL={real}", *target]
        for compiler in C_COMPILERS:
            run([compiler, "-std=c99", *WARNINGS, *macros, *include, source])
        for compiler in CXX_COMPILERS:
            run([compiler, "-x", "c++", *cxx, *macros, *include, source])


PROBE = """
#include "ARM_lanes.h"
void many(const ARM_real_t x[], ARM_real_t s[], ARM_real_t c[], long n);
void many(const ARM_real_t x[], ARM_real_t s[], ARM_real_t c[], long n)
{
    long i;
    for (i = 0; i < n; i += MACRO_LANES) {
        ARM_lanes_t sine, cosine;
        ARM_lanes_sincos(ARM_lanes_load(x + i), &sine, &cosine);
        ARM_lanes_store(s + i, sine);
        ARM_lanes_store(c + i, cosine);
    }
}
"""


@vectors
@pytest.mark.parametrize("contraction", ["off", "fast"])
@pytest.mark.parametrize("real", ["double", "float"])
def test_sine_and_cosine_are_as_exact_as_is_stated(contraction: str, real: str, tmp_path: Path) -> None:
    """Against the C library in long double, the worst ones against twenty digits."""
    arm = "two_fingers"
    write(c_files(batched(arm, "default"), PROVENANCE), tmp_path)
    probe = tmp_path / "src" / "probe.c"
    probe.write_text(PROBE.replace("ARM", arm).replace("MACRO", arm.upper()))
    fused = ["-mfma"] if platform.machine() == "x86_64" and contraction == "fast" else []
    flags = ["-I", str(tmp_path / "include"), str(probe), "-o", str(tmp_path / "probe.so")]
    flags += [
        f"-D{arm.upper()}_REAL={real}",
        f"-D{arm.upper()}_LANE_BYTES=32",
        "-Wno-psabi",
        "-std=c99",
        *fused,
    ]
    run([C_COMPILERS[0], *flags, "-O2", f"-ffp-contract={contraction}", "-fPIC", "-shared", "-lm"])
    kind = {"double": np.float64, "float": np.float32}[real]
    for limit, allowed in (
        (2 * np.pi, {"double": 2e-16, "float": 1.2e-7}),
        (1e4, {"double": 2e-16, "float": 2e-7}),
        (1e5, {"double": 2e-16}),
    ):
        if real not in allowed:
            continue
        centres = (np.arange(-int(limit * 4 / np.pi), int(limit * 4 / np.pi) + 1) * np.pi / 4).astype(kind)
        near = (centres[:, None] + np.arange(-3, 4) * np.spacing(np.abs(centres))[:, None]).ravel()
        x = np.concatenate([np.linspace(-limit, limit, 1_000_001), near]).astype(kind)
        x = np.ascontiguousarray(x[: len(x) // 32 * 32])
        s, c = np.empty_like(x), np.empty_like(x)
        pointers = (ctypes.c_void_p(a.ctypes.data) for a in (x, s, c))
        ctypes.CDLL(str(tmp_path / "probe.so")).many(*pointers, ctypes.c_long(len(x)))
        exact = x.astype(np.longdouble)
        errors = np.maximum(np.abs(s - np.sin(exact)), np.abs(c - np.cos(exact)))
        assert errors.max() <= allowed[real]
        assert errors.max() > 0.0
        with mpmath.workdps(20):
            for k in np.argsort(errors)[-5:]:
                angle = mpmath.mpf(float(x[k]))
                assert abs(float(s[k]) - mpmath.sin(angle)) <= allowed[real]
                assert abs(float(c[k]) - mpmath.cos(angle)) <= allowed[real]


def test_only_what_is_asked_for_is_there() -> None:
    plain = build_model(ARMS["gravity_arm"], Options(derivatives=False, watch=False))
    files = c_files(plain, PROVENANCE)
    assert not [name for name in files if "batch" in name or "lanes" in name]
    assert "batch" not in files["include/gravity_arm.h"]
    some = Options(derivatives=False, watch=False, nominal=True, batch="gravity,mass_matrix_standard")
    made = build_model(ARMS["gravity_arm"], some)
    assert set(made.batch) == {"gravity", "gravity_standard", "gravity_nominal", "mass_matrix_standard"}
    assert {n for n in c_files(made, PROVENANCE) if n.endswith("_batch.c")} == {
        f"src/gravity_arm_{name}_batch.c" for name in made.batch
    }
    every = build_model(ARMS["gravity_arm"], Options(batch="all"))
    assert every.batch == tuple(f.name for f in every.functions)


def test_what_does_not_exist_is_said_with_what_does() -> None:
    with pytest.raises(InputError) as error:
        build_model(ARMS["gravity_arm"], Options(batch="gravity,inverse_dynamix"))
    text = str(error.value)
    assert text.startswith("--batch: found 'inverse_dynamix', did you mean 'inverse_dynamics'?")
    assert "forward_dynamics" in text
    assert "\n" not in text
