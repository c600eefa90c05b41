"""docs/thresholds.md says what the entries say."""

from architecture.house import ROOT

from modelgen.diagnosis.options import Thresholds
from modelgen.report.thresholds import page


def test_the_page_of_thresholds_is_current() -> None:
    """`python -m modelgen.report.thresholds > docs/thresholds.md` writes it."""
    assert (ROOT / "docs" / "thresholds.md").read_text(encoding="utf-8") == page()


def test_the_page_has_every_threshold_with_all_that_is_known_of_it() -> None:
    text = page()
    for e in Thresholds().entries():
        assert e.unit
        assert e.source
        (line,) = [row for row in text.splitlines() if row.startswith(f"| `{e.name}` |")]
        assert e.meaning in line
        assert e.meaning.endswith(".")
        assert not e.meaning.startswith(("The same", "So is"))
