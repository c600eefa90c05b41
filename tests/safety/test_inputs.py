"""Any bits as inputs: no undefined behaviour, finite outputs, zeros with every status."""

import os
import shutil
import subprocess
from dataclasses import replace
from pathlib import Path

import pytest
from arms_support import model
from c_support import C_COMPILERS
from safety import exercise
from safety.eva import written
from safety.fuzz import ARMS, fuzz

from modelgen.functions import Model

REALS = ("float", "double")
CASES = [pytest.param(name, real, marks=pytest.mark.xdist_group(name)) for name in ARMS for real in REALS]


def built(made: Model, real: str, folder: Path, *flags: str) -> Path:
    source = exercise.write(made, real, folder)
    target = folder / f"exercise_{real}"
    command = [C_COMPILERS[0], "-std=c99", *flags, *exercise.flags(made, real, folder), str(source)]
    done = subprocess.run([*command, "-o", str(target), "-lm"], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[:3000]
    return target


def run(target: Path, rounds: int) -> "subprocess.CompletedProcess[str]":
    return subprocess.run([str(target), str(rounds)], capture_output=True, text=True, check=False)


@pytest.mark.parametrize(("name", "real"), CASES)
def test_whatever_the_bits_of_the_inputs_the_outputs_are_finite(name: str, real: str, tmp_path: Path) -> None:
    made = model(name)
    done = run(built(made, real, written(made, tmp_path), "-O1"), 20000)
    assert done.returncode == 0, done.stderr
    calls, computed = (int(word) for word in done.stdout.split() if word.isdigit())
    assert calls == 20000 * len(made.functions)
    assert computed > 0.3 * calls, "most calls are to reach the arithmetic"


@pytest.mark.parametrize(("name", "real"), [case for case in CASES if case.values[0] in ("ariane4", "scara")])
def test_sanitizers_find_nothing(name: str, real: str, tmp_path: Path) -> None:
    made = model(name)
    probe = tmp_path / "probe.c"
    probe.write_text("int main(void) { return 0; }\n", encoding="utf-8")
    flags = ["-g", exercise.SANITIZERS, "-fno-sanitize-recover=all"]
    command = [C_COMPILERS[0], *flags, str(probe), "-o", str(tmp_path / "probe")]
    if subprocess.run(command, capture_output=True, check=False).returncode != 0:
        pytest.skip(f"{C_COMPILERS[0]} has no sanitizers here")
    # Not optimised: nothing that a sanitizer looks for is gone before it looks, in a third of the time.
    done = run(built(made, real, written(made, tmp_path), "-O0", *flags), 5000)
    assert done.returncode == 0, done.stderr


@pytest.mark.xdist_group("ariane4")
@pytest.mark.parametrize(
    ("function", "promise", "broken", "message"),
    [
        ("inverse_dynamics", "status |= ARIANE4_STATUS_INPUT;", ";", "beyond its bound is accepted"),
        ("gravity", "status |= ARIANE4_STATUS_INPUT;", "status |= 8;", "beyond its bound is accepted"),
        ("energy", "        ariane4_zero(kinetic, 1);\n", "", "not finite"),
        (
            "forward_dynamics",
            "return ARIANE4_STATUS_OK;",
            "out[0] *= ARIANE4_C(1e300);\n return 0;",
            "not fin",
        ),
    ],
)
def test_a_function_that_breaks_a_promise_is_found(
    function: str, promise: str, broken: str, message: str, tmp_path: Path
) -> None:
    made = model("ariane4")
    folder = written(made, tmp_path)
    path = folder / f"src/ariane4_{function}.c"
    text = path.read_text(encoding="utf-8")
    if promise not in text:
        promise = "        ariane4_zero(out, 2);\n"
    assert promise in text
    path.write_text(text.replace(promise, broken), encoding="utf-8")
    for other in folder.glob("src/ariane4_*.c"):  # this function alone, with the sine and cosine it calls
        if other.stem not in (path.stem, "ariane4_sincos"):
            other.unlink()
    alone = replace(made, functions=tuple(f for f in made.functions if f.name == function))
    done = run(built(alone, "double", folder, "-O1"), 2000)
    assert done.returncode != 0
    assert f"{function}: " in done.stderr
    assert message in done.stderr


@pytest.mark.parametrize(("name", "real"), [case for case in CASES if case.values in (("ariane4", "float"),)])
def test_libfuzzer_finds_nothing(name: str, real: str, tmp_path: Path) -> None:
    if shutil.which("clang") is None:
        pytest.skip("needs clang with libFuzzer (Debian: clang libclang-rt-14-dev)")
    made = model(name)
    # It compiles in a third of the time, and makes more calls in 5 s than optimised in 3 s.
    seconds = int(os.environ.get("FUZZ_SECONDS", "5"))
    done = fuzz(made, real, seconds, written(made, tmp_path), "-O0")
    if "cannot find" in done.stderr and "libclang_rt.fuzzer" in done.stderr:
        pytest.skip("clang has no libFuzzer here (Debian: libclang-rt-14-dev)")
    assert done.returncode == 0, done.stderr[-3000:]
    assert "Done " in done.stderr
