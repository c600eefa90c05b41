"""Axes of time are made in one place, which takes off what the stamps count from."""

from architecture.house import ROOT


def test_no_chart_has_time_but_by_one_function() -> None:
    files = (ROOT / "modelgen" / "report").rglob("*.py")
    made = [p.name for p in files if '"time [s]"' in p.read_text(encoding="utf-8")]
    assert made == ["law_sketch.py"]  # of an example, which begins at zero
