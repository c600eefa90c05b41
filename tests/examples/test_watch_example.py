"""The example of a watch beside a controller: it is quiet, sees what happens, and the board sees the same."""

import importlib.util
import json
import sys
from pathlib import Path
from types import ModuleType

import pytest

FOLDER = Path(__file__).resolve().parents[2] / "examples" / "watch"
pytestmark = pytest.mark.xdist_group("ariane4")


@pytest.fixture(scope="module")
def example() -> ModuleType:
    sys.path.insert(0, str(FOLDER))
    spec = importlib.util.spec_from_file_location("watch_run", FOLDER / "run.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_it_is_quiet_and_sees_what_happens(example: ModuleType, tmp_path: Path) -> None:
    found = example.figures(0.05, tmp_path)
    assert found["quiet"]["alarms"] == 0
    assert 0 < found["friction"]["detected_after_s"] < 3600
    assert found["friction"]["monitor"] in (1, 2, 3)  # friction of joint 2, and nothing else
    assert 0 < found["payload"]["detected_after_s"] < 60
    assert 0 < found["end_stop"]["detected_after_s"] < 0.5
    assert found["end_stop"]["observer"] & 1  # joint 1
    assert all(found[event]["board"] for event in ("friction", "payload", "end_stop"))
    assert found["instructions"]["observer_and_monitor"] < 3500


def test_the_page_states_the_figures_of_the_last_run() -> None:
    found = json.loads((FOLDER / "watch.json").read_text(encoding="utf-8"))
    text = (FOLDER / "README.md").read_text(encoding="utf-8")
    assert found["quiet"] == {"hours": 24.0, "alarms": 0}
    for event in ("friction", "payload", "end_stop"):
        assert f"| {found[event]['detected_after_s']:.3g} s |" in text, event
    for figure in ("observer", "observer_and_monitor"):
        assert f"{found['instructions'][figure]} instructions" in text
