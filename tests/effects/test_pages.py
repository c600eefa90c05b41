"""docs/effects.md says what the catalogue says."""

from pathlib import Path
from xml.etree import ElementTree

from modelgen.effects import CATALOGUE
from modelgen.report.catalogue import pages

DOCS = Path(__file__).resolve().parents[2] / "docs"


def test_the_page_of_effects_is_current_and_every_effect_has_its_picture() -> None:
    made = pages()
    assert (DOCS / "effects.md").read_text(encoding="utf-8") == made["effects.md"]
    assert set(made) == {"effects.md"} | {f"effects/{name}.svg" for name in CATALOGUE}
    assert made == pages()  # the same bytes every time
    for name in CATALOGUE:
        picture = ElementTree.fromstring((DOCS / "effects" / f"{name}.svg").read_text(encoding="utf-8"))
        assert picture.tag.endswith("svg")
        assert ElementTree.fromstring(made[f"effects/{name}.svg"]).tag == picture.tag
