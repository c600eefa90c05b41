"""Programs of benchmarks/ whose figures no other test makes: they load, and the diagnosis is timed."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from types import ModuleType

import pytest

FOLDER = Path(__file__).parents[2] / "benchmarks"
PROGRAMS = sorted(path.stem for path in FOLDER.glob("*.py"))


def loaded(name: str, monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    monkeypatch.syspath_prepend(str(FOLDER))
    spec = importlib.util.spec_from_file_location(name, FOLDER / f"{name}.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    monkeypatch.setitem(sys.modules, name, module)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("name", PROGRAMS)
def test_what_a_program_imports_is_there(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    assert loaded(name, monkeypatch).__doc__


def test_cpu_time_of_a_diagnosis_with_half_of_its_candidates(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    timed = loaded("diagnosis_scale", monkeypatch).timed
    every, samples, seconds = timed(tmp_path, "direct2", periods=2)
    half, *_ = timed(tmp_path, "direct2", periods=2, every=2)
    assert every > 30
    assert half == (every + 1) // 2
    assert samples > 10_000
    assert 0.0 < seconds < 600.0
