"""Functions at the nearest point of the strokes, where encoder noise leads beyond their ends."""

import ctypes
import shutil
from pathlib import Path

import numpy as np
import pytest
from arms_support import ARMS, inputs
from c_support import C_COMPILERS, WARNINGS, one_source, run, write
from safety.eva import Claim, run_eva

from modelgen.backends.c.dialect import arrays
from modelgen.functions import Function, Model, Options, build_model
from modelgen.functions.objects import STATUS_INPUT, STATUS_STROKE
from modelgen.generation.arm import print_model

pytestmark = pytest.mark.xdist_group("c_nearest")

ARM = "ariane4"
Built = tuple[Model, ctypes.CDLL, Path]


def ranged(made: Model) -> list[Function]:
    return [f for f in made.functions if any(r.status == STATUS_STROKE for r in f.ranges)]


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Built:
    """A library in which the inline functions have an address."""
    made = build_model(ARMS[ARM], Options(derivatives=False))
    folder = tmp_path_factory.mktemp("nearest")
    write(print_model(made, ARMS[ARM], {}).files, folder)
    lines = [f'#include "{one_source(folder)}"', "typedef void (*any_t)(void);", "any_t called(int k);"]
    lines += ["any_t called(int k)", "{", "    switch (k) {"]
    lines += [f"    case {k}: return (any_t)&{ARM}_{f.name}_nearest;" for k, f in enumerate(ranged(made))]
    lines += ["    default: return 0;", "    }", "}", ""]
    (folder / "callable.c").write_text("\n".join(lines), encoding="utf-8")
    warnings = [w for w in WARNINGS if w != "-Wextra"]  # casts among types of functions
    flags = ["-std=c99", *warnings, "-O1", "-ffp-contract=off", "-fPIC", "-shared", f"-I{folder}/include"]
    run([C_COMPILERS[0], *flags, str(folder / "callable.c"), "-o", str(folder / "nearest.so"), "-lm"])
    library = ctypes.CDLL(str(folder / "nearest.so"))
    library.called.restype = ctypes.c_void_p
    return made, library, folder


def call(built: Built, function: Function, nearest: bool, given: list[np.ndarray]) -> tuple[int, np.ndarray]:
    made, library, _ = built
    outputs = [np.full(size, np.nan) for size in arrays(function).values()]
    every = [np.ascontiguousarray(x, dtype=float) for x in [*given, *outputs]]
    pointers = [ctypes.c_void_p(x.ctypes.data) for x in every]
    if nearest:
        address = library.called(ranged(made).index(function))
        status = ctypes.CFUNCTYPE(ctypes.c_uint, *[ctypes.c_void_p] * len(pointers))(address)(*pointers)
    else:
        status = getattr(library, f"{ARM}_{function.name}")(*pointers)
    return status, np.concatenate(every[len(given) :])


def test_beyond_an_end_they_give_what_is_true_at_the_end(built: Built) -> None:
    rng = np.random.default_rng(1)
    for f in ranged(built[0]):
        given = inputs(built[0], f, rng)
        k = next(i for i, a in enumerate(f.arguments) if a.name in ("q", "q_m"))
        assert call(built, f, True, given)[0] == 0
        np.testing.assert_array_equal(call(built, f, True, given)[1], call(built, f, False, given)[1])
        for beyond in (1e-9, 0.3):
            at, out = given[k].copy(), given[k].copy()
            for r in f.ranges:
                if r.status == STATUS_STROKE:
                    low = rng.random() < 0.5
                    at[r.index] = r.low if low else r.high
                    out[r.index] = at[r.index] + (-1 if low else 1) * beyond * max(1.0, abs(at[r.index]))
            moved = [*given[:k], out, *given[k + 1 :]]
            status, found = call(built, f, False, moved)
            assert status == STATUS_STROKE
            assert not found.any(), f.name
            status, found = call(built, f, True, moved)
            expected = call(built, f, False, [*given[:k], at, *given[k + 1 :]])[1]
            assert status == STATUS_STROKE
            np.testing.assert_array_equal(found, expected)
            assert np.isfinite(found).all()


@pytest.mark.parametrize("bad", [np.nan, np.inf, -1e5])
def test_what_is_not_finite_or_beyond_its_bound_stays_zeros(bad: float, built: Built) -> None:
    for f in ranged(built[0]):
        if f.arguments[0].name == "q":
            given = inputs(built[0], f, np.random.default_rng(2))
            given[0][1] = bad
            status, found = call(built, f, True, given)
            assert status & STATUS_INPUT, f.name
            assert not found.any(), f.name


def test_an_arm_without_strokes_has_none_of_them() -> None:
    made = build_model(ARMS["gravity_arm"], Options(derivatives=False))
    files = print_model(made, ARMS["gravity_arm"], {}).files
    assert not [name for name in files if "strokes" in name]
    assert "nearest" not in files["include/gravity_arm.h"]


@pytest.mark.xdist_group("safety_proof")
@pytest.mark.skipif(shutil.which("frama-c") is None, reason="needs frama-c (Debian: frama-c-base)")
@pytest.mark.parametrize("real", ["float", "double"])
def test_whatever_finite_number_comes_in_what_comes_out_is_within(real: str, built: Built) -> None:
    """So that what is proven of the other functions over the whole of the strokes holds for these ones."""
    made, _, folder = built
    (gravity,) = [f for f in made.functions if f.name == "gravity"]
    suffix = "f" if real == "float" else ""
    lines = ['#include "__fc_builtin.h"', f'#include "{ARM}_onto_strokes.c"', "", "int main(void)", "{"]
    lines.append(f"    {real} q[3], nearest[3];")
    lines += [f"    q[{i}] = Frama_C_{real}_interval(-5e3{suffix}, 5e3{suffix});" for i in range(3)]
    lines += [f"    {ARM}_status_t status = {ARM}_onto_strokes(q, nearest);"]
    lines += [
        f"    //@ assert {r.low - 1e-6!r} <= nearest[{r.index}] <= {r.high + 1e-6!r};" for r in gravity.ranges
    ]
    text = "\n".join([*lines, "    return (int)status;", "}", ""])
    proof = run_eva(ARM, "onto_strokes", Claim(real, finite=True), text, folder)
    assert proof.alarms == 0, proof.log[-3000:]
    assert "Assertions        3 valid     0 unknown     0 invalid" in proof.log
