"""The arms' own sine and cosine: accuracy over the bound of q, on the host and on a Cortex-M4F."""

import ctypes
from pathlib import Path

import mpmath
import numpy as np
import pytest
from arms_support import model
from c_support import C_COMPILERS, Library, run, shared_library, sources, write
from firmware.build import zig_program
from firmware.machine import Machine
from firmware.targets import M4F

from modelgen.backends import Provenance, c_files

ARM = "two_fingers"
BOUND = 1e4  # rad, of the joint coordinates
PROBE = f"""
#include "{ARM}_private.h"
int {ARM}_probe(const float x[], float out[]);
int {ARM}_probe(const float x[], float out[])
{{
    {ARM.upper()}_SINCOS(x[0], &out[0], &out[1]);
    return 0;
}}
void many(const float x[], float s[], float c[], long n);
void many(const float x[], float s[], float c[], long n)
{{
    long i;
    for (i = 0; i < n; ++i) {{
        {ARM.upper()}_SINCOS(x[i], &s[i], &c[i]);
    }}
}}
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("sincos")
    write(c_files(model(ARM), Provenance("modelgen test", "0" * 64)), path)
    (path / "src" / f"{ARM}_probe.c").write_text(PROBE)
    return path


def errors(folder: Path, contraction: str, x: np.ndarray) -> float:
    library = folder / f"{contraction}.so"
    if not library.exists():
        flags = [f"-D{ARM.upper()}_REAL=float", "-O2", f"-ffp-contract={contraction}", "-std=c99", "-fPIC"]
        files = [s for s in sources(folder) if s.endswith(("_probe.c", "_sincos.c"))]
        run([C_COMPILERS[0], *flags, "-shared", "-I", str(folder / "include"), *files, "-o", str(library)])
    x = np.ascontiguousarray(x, dtype=np.float32)
    s, c = np.empty_like(x), np.empty_like(x)
    arrays = (ctypes.c_void_p(a.ctypes.data) for a in (x, s, c))
    ctypes.CDLL(str(library)).many(*arrays, ctypes.c_long(x.size))
    exact = x.astype(float)
    return float(max(np.abs(s - np.sin(exact)).max(), np.abs(c - np.cos(exact)).max()))


def near_quarters(limit: float) -> np.ndarray:
    """Every multiple of pi/4 up to the limit, and the eight floats on either side of it."""
    centre = (np.arange(-int(limit * 4 / np.pi), int(limit * 4 / np.pi) + 1) * np.pi / 4).astype(np.float32)
    steps = np.arange(-8, 9) * np.spacing(np.abs(centre))[:, None]
    return (centre[:, None] + steps).astype(np.float32).ravel()


@pytest.mark.parametrize("contraction", ["off", "fast"])
@pytest.mark.parametrize(("limit", "allowed"), [(2 * np.pi, 1.2e-7), (BOUND, 2e-7)])
def test_the_error_stays_below_what_is_stated(
    folder: Path, contraction: str, limit: float, allowed: float
) -> None:
    """About one unit in the last place of 1."""
    x = np.concatenate([np.linspace(-limit, limit, 4_000_001), near_quarters(limit)])
    found = errors(folder, contraction, x)
    assert 1e-8 < found <= allowed


def test_small_angles_keep_their_relative_accuracy(folder: Path) -> None:
    x = np.concatenate([[0.0], np.geomspace(1e-30, 1e-3, 1000)])
    library = Library(shared_library(folder, ARM, "float", optimise="-O2"), model(ARM), "float").library
    probe = getattr(library, f"{ARM}_probe")
    for value in np.concatenate([x, -x]).astype(np.float32):
        given, out = np.array([value], np.float32), np.empty(2, np.float32)
        probe(ctypes.c_void_p(given.ctypes.data), ctypes.c_void_p(out.ctypes.data))
        assert abs(float(out[0]) - np.sin(float(value))) <= 1.2e-7 * abs(float(value))
        assert out[1] == np.float32(np.cos(float(value)))


def test_on_a_cortex_m4f_as_on_the_host(folder: Path) -> None:
    """With the fused operations of the target, against 40 digits."""
    _, program = zig_program(M4F, ARM, folder, folder / "objects")
    machine = Machine(program, M4F)
    rng = np.random.default_rng(2)
    x = np.concatenate([rng.uniform(-2 * np.pi, 2 * np.pi, 1000), rng.uniform(-BOUND, BOUND, 1000)])
    with mpmath.workdps(40):
        for value in x.astype(np.float32):
            _, (s, c) = machine.call(f"{ARM}_probe", [[value]], [2])
            exact = mpmath.mpf(float(value))
            assert abs(s - float(mpmath.sin(exact))) <= 2e-7
            assert abs(c - float(mpmath.cos(exact))) <= 2e-7


@pytest.mark.parametrize("contraction", ["off", "fast"])
def test_in_double_the_error_stays_below_what_is_stated(folder: Path, contraction: str) -> None:
    """Against the platform's extended precision, near multiples of pi/4 and small angles included."""
    if np.finfo(np.longdouble).eps > 1e-18:
        pytest.skip("long double is no more than double here")
    text = PROBE.replace("float", "double")
    (folder / "src" / f"{ARM}_probe_double.c").write_text(text)
    out = folder / f"double_{contraction}.so"
    flags = [f"-D{ARM.upper()}_REAL=double", "-O2", f"-ffp-contract={contraction}", "-std=c99", "-fPIC"]
    files = [s for s in sources(folder) if s.endswith(("_probe_double.c", "_sincos.c"))]
    run([C_COMPILERS[0], *flags, "-shared", "-I", str(folder / "include"), *files, "-o", str(out)])
    (folder / "src" / f"{ARM}_probe_double.c").unlink()
    rng = np.random.default_rng(5)
    quarters = np.arange(-12732, 12733) * np.pi / 4
    near = (quarters[:, None] + np.arange(-8, 9) * np.spacing(np.abs(quarters))[:, None]).ravel()
    small = np.geomspace(1e-300, 1e-3, 1000)
    x = np.concatenate([rng.uniform(-BOUND, BOUND, 1_000_000), rng.uniform(-7, 7, 1_000_000), near])
    x = np.concatenate([x[np.abs(x) <= BOUND], small, -small])
    s, c = np.empty_like(x), np.empty_like(x)
    arrays = (ctypes.c_void_p(a.ctypes.data) for a in (x, s, c))
    ctypes.CDLL(str(out)).many(*arrays, ctypes.c_long(x.size))
    exact = x.astype(np.longdouble)
    sine, cosine = np.abs(s - np.sin(exact)), np.abs(c - np.cos(exact))
    assert 1e-17 < max(sine.max(), cosine.max()) <= 2e-16
    assert (sine[-2000:] <= 2.3e-16 * np.abs(x[-2000:])).all()


PLUGGED = """
static void plugged(float x, float *s, float *c)
{
    (void)x;
    *s = 0.25f;
    *c = 0.75f;
}
"""


def test_the_target_s_own_takes_its_place(folder: Path, tmp_path: Path) -> None:
    header = tmp_path / "plugged.h"
    header.write_text(PLUGGED)
    flags = ["-std=c99", "-fPIC", "-shared", f"-D{ARM.upper()}_REAL=float", "-include", str(header)]
    flags += [f"-D{ARM.upper()}_SINCOS=plugged", "-Wno-unused-function", "-I", str(folder / "include")]
    out = tmp_path / "plugged.so"
    run([C_COMPILERS[0], *flags, *sources(folder), "-lm", "-o", str(out)])
    x, result = np.zeros(1, np.float32), np.empty(2, np.float32)
    probe = getattr(ctypes.CDLL(str(out)), f"{ARM}_probe")
    probe(ctypes.c_void_p(x.ctypes.data), ctypes.c_void_p(result.ctypes.data))
    assert result.tolist() == [0.25, 0.75]
