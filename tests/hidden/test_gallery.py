"""docs/gallery.md has every effect of the catalogue, as its class and its records say."""

import json
from xml.etree import ElementTree

import pytest
from made_up_effects import in_the_catalogue

from hidden.effects import EFFECTS
from hidden.gallery import DOCS, kept, page, picture, shown
from hidden.tallies import measured
from modelgen.charts import sheet
from modelgen.effects import CATALOGUE, Effect, Family, InputEffect

SVG = "{http://www.w3.org/2000/svg}"


def test_the_page_is_that_of_the_classes_and_of_what_was_kept() -> None:
    """One that is added without its records is missed by name."""
    lines, run = kept(), measured()
    assert (DOCS / "gallery.md").read_text(encoding="utf-8") == page(lines, run)
    assert list(lines) == list(CATALOGUE)
    with in_the_catalogue() as added:
        name = next(iter(added))
        with pytest.raises(KeyError, match=name):
            page(lines, run)
        like = lines[next(iter(lines))] | {"effect": name}
        known = page(lines | dict.fromkeys(added, like), run)
        assert all(f"\n## {effect}\n" in known for effect in added)


def test_every_effect_of_the_catalogue_can_be_hidden() -> None:
    assert set(CATALOGUE) == {name for name, effect in EFFECTS.items() if not effect.outside}


@pytest.mark.parametrize("effect", CATALOGUE)
def test_pictures_are_there_with_text_and_units(effect: str) -> None:
    said = kept()[effect]["texts"]
    for part in ("law", "residual"):
        root = ElementTree.fromstring((DOCS / picture(effect, part)).read_text(encoding="utf-8"))
        (chart,) = [e for e in root.iter(f"{SVG}svg") if e.get("class") == "chart"]
        assert chart.attrib["aria-label"] == said[part]
        labels = [e.text or "" for e in chart.iter(f"{SVG}text") if e.get("class") == "label"]
        assert len(labels) == 2
        assert all(label.endswith("]") for label in labels)


def test_a_law_is_drawn_over_what_it_is_a_law_of() -> None:
    """What passes over time, what repeats over the motor; over a stretch of the record what remembers or has
    to do with other joints, and nothing that the joint's own motion makes.
    """
    stretches = []
    for name, line in kept().items():
        over = line["texts"]["law"].partition(" over ")[2].partition(",")[0]
        effect = CATALOGUE[name]
        assert (over == "time") == (effect.seen_over == "time"), name
        assert (over == "motor position") == effect.periodic, name
        if over.endswith("of the record"):
            stretches.append(name)
            others = not issubclass(effect, Effect | InputEffect) or effect.coupled(effect.shown) is not None
            assert effect.states or others, name
    # none of these follows from where the drive is and how it moves now
    assert {name for name, effect in CATALOGUE.items() if effect.family is Family.ELASTIC} <= {*stretches}


def test_the_gallery_is_small() -> None:
    files = [*(DOCS / "gallery").glob("*.svg"), *(DOCS / "effects").glob("*.svg"), DOCS / "gallery.md"]
    assert len(files) == 3 * len(CATALOGUE) + 1
    assert sum(file.stat().st_size for file in files) < 1_500_000


def test_what_is_kept_is_found_again() -> None:
    """The records are made and diagnosed anew, for the effect that takes least time."""
    name = "coulomb_friction"
    line, charts = shown(name)
    before = kept()[name]
    assert json.loads(json.dumps(line)).keys() == before.keys()
    for key in ("effect", "arm", "joint", "encoder", "found", "place", "unit", "texts"):
        assert line[key] == before[key]
    for key in ("size", "whole", "before", "after"):
        assert float(line[key]) == pytest.approx(float(before[key]), rel=0.02)
    assert [x["effect"] for x in line["lookalikes"]] == [x["effect"] for x in before["lookalikes"]]
    assert all(sheet([chart], 1).count("<path") > 5 for chart in charts.values())
