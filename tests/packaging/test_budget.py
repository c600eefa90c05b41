"""Budgets of flash and stack: what exceeds them is named with its figure, and nothing is written."""

import os
import re
import shutil
import subprocess
from functools import cache
from pathlib import Path

import pytest
from arms_support import ARMS, generated
from command_support import Done, called

from modelgen.errors import InputError
from modelgen.functions import Options
from modelgen.generation import TARGETS, Budget, GeneratedArm, generate
from modelgen.generation.budget import Size, sizes

ARM = "ariane4"
pytestmark = pytest.mark.xdist_group(ARM)


@pytest.fixture(scope="module")
def made() -> GeneratedArm:
    return generated(ARM)


def installed(target: str) -> bool:
    return all(shutil.which(tool) for tool in (TARGETS[target].compiler, TARGETS[target].size))


@cache
def measured(target: str) -> dict[str, Size]:
    """Sizes of the arm's functions, compiled once."""
    return sizes(generated(ARM), TARGETS[target])


def command(tmp_path: Path, *options: str) -> Done:
    return called("generate", "--arm", ARM, "--out", tmp_path / "out", *options)


@pytest.mark.parametrize("target", list(TARGETS))
def test_the_figures_hold_for_what_they_are(target: str, made: GeneratedArm) -> None:
    """Larger functions take more; a cheap one takes less than a kilobyte and hardly any stack."""
    if not installed(target):
        pytest.skip(f"needs {TARGETS[target].compiler} (Debian: {TARGETS[target].package})")
    found = measured(target)
    assert set(found) == set(made.operations)
    assert found["forward_dynamics"].flash > found["bias"].flash > found["gravity"].flash > 200
    assert found["forward_dynamics"].stack > found["drive_gain"].stack
    assert all(0 <= size.stack < 4096 for size in found.values())
    assert all(size.flash < (30000 if "derivatives" in name else 20000) for name, size in found.items())


def test_flash_is_what_the_linker_would_count(made: GeneratedArm, tmp_path: Path) -> None:
    """For Cortex-M the object's text in Berkeley's format, code and constants, is the same figure."""
    target = TARGETS["cortex-m4f"]
    if not installed("cortex-m4f"):
        pytest.skip(f"needs {target.compiler} (Debian: {target.package})")
    for name, text in made.files.items():
        if name.endswith((".c", ".h")):
            (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
            (tmp_path / name).write_text(text, encoding="utf-8")
    flags = [*target.flags, "-std=c99", "-O2", f"-D{ARM.upper()}_REAL=float", f"-I{tmp_path}/include"]
    for function, size in measured("cortex-m4f").items():
        made_object = tmp_path / "x.o"
        source = tmp_path / f"src/{ARM}_{function}.c"
        subprocess.run([target.compiler, *flags, "-c", str(source), "-o", str(made_object)], check=True)
        told = subprocess.run([target.size, str(made_object)], capture_output=True, text=True, check=True)
        assert int(told.stdout.splitlines()[1].split()[0]) == size.flash, function


def test_beyond_the_budget_nothing_is_written(tmp_path: Path) -> None:
    if not installed("host"):
        pytest.skip("needs cc and size (Debian: build-essential)")
    within = command(tmp_path, "--max-flash", "100000", "--max-stack", "10000", "--target", "host")
    assert within.returncode == 0, within.stderr
    before = {p: p.read_bytes() for p in (tmp_path / "out").rglob("*") if p.is_file()}
    beyond = command(tmp_path, "--max-flash", "1000", "--target", "host", "--without", "effects")
    assert beyond.returncode == 1
    lines = beyond.stderr.splitlines()
    found = [re.fullmatch(rf"{ARM}_(\w+): (\d+) bytes of flash on host, budget 1000", x) for x in lines]
    assert any(match and match[1] == "forward_dynamics" for match in found), lines
    assert all(int(match[2]) > 1000 for match in found if match)
    assert lines[-1] == f"over budget: nothing is written under {tmp_path / 'out'}"
    assert {p: p.read_bytes() for p in (tmp_path / "out").rglob("*") if p.is_file()} == before


def test_a_target_that_does_not_exist(tmp_path: Path) -> None:
    done = command(tmp_path, "--max-flash", "1000", "--target", "cortex-m4")
    assert done.returncode == 2
    assert done.stderr.startswith("--target: found 'cortex-m4', did you mean 'cortex-m4f'?")
    assert not (tmp_path / "out").exists()


def test_a_compiler_that_is_missing_is_named_with_its_package(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    done = command(tmp_path, "--max-flash", "1000")
    assert done.returncode == 2
    assert done.stderr.splitlines() == [
        "found no arm-none-eabi-gcc, which measures the sizes; "
        "install it (Debian: gcc-arm-none-eabi libnewlib-arm-none-eabi)"
    ]
    assert not (tmp_path / "out").exists()


def test_a_compiler_that_fails_is_bad_input(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = tmp_path / "bin"
    folder.mkdir()
    for tool in ("cc", "size"):
        (folder / tool).write_text("#!/bin/sh\necho 'no licence' >&2\nexit 1\n", encoding="utf-8")
        (folder / tool).chmod(0o755)
    monkeypatch.setenv("PATH", f"{folder}:{os.environ['PATH']}")
    with pytest.raises(InputError, match="cc failed, so the sizes are unknown: no licence"):
        generate([ARMS[ARM]], tmp_path / "out", Options(), processes=1, budget=Budget("host", flash=1000))
    assert not (tmp_path / "out").exists()
