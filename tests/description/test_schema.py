"""The JSON Schema for editors says what the loader says."""

import copy
import re
from pathlib import Path
from typing import Any

import jsonschema
import pytest
from ruamel.yaml import YAML

from modelgen.description import json_schema, starter
from modelgen.effects import effect_texts, known_effects

EFFECTS = {
    "viscous_friction": ["coefficient"],
    "coulomb_friction": ["magnitude"],
    "drive_inertia": ["inertia"],
}


@pytest.fixture(scope="module")
def document(checkout: Path) -> dict[str, Any]:
    read: dict[str, Any] = YAML(typ="safe", pure=True).load(
        (checkout / "arms.yaml").read_text(encoding="utf-8")
    )
    return copy.deepcopy(read)


def problems(document: Any, schema: dict[str, Any]) -> list[str]:
    return [error.message for error in jsonschema.Draft202012Validator(schema).iter_errors(document)]


def test_it_is_a_schema_of_the_2020_draft() -> None:
    for schema in (json_schema(), json_schema(EFFECTS)):
        assert schema["$schema"] == "https://json-schema.org/draft/2020-12/schema"
        jsonschema.Draft202012Validator.check_schema(schema)


@pytest.mark.parametrize("effects", [None, EFFECTS])
def test_the_shipped_arms_and_the_starter_file_are_valid(document: Any, effects: Any) -> None:
    schema = json_schema(effects)
    assert problems(document, schema) == []
    assert problems(YAML(typ="safe", pure=True).load(starter("my_arm")), schema) == []


@pytest.mark.parametrize(
    ("place", "key", "wrong"),
    [
        ([], "arms", "arm"),
        (["arms", "ariane4"], "gravity", "gravitiy"),
        (["arms", "ariane4", "joints", 0], "alpha", "aplha"),
        (["arms", "ariane4", "joints", 0, "drive"], "offset", "ofset"),
        (["arms", "ariane4", "joints", 0, "limits"], "position", "positions"),
        (["arms", "ariane4", "links", "j1"], "mass", "weight"),
        (["arms"], "ariane4", "ariane-4"),
    ],
)
def test_a_misspelt_key_is_marked(document: Any, place: list[str | int], key: str, wrong: str) -> None:
    changed = copy.deepcopy(document)
    node = changed
    for step in place:
        node = node[step]
    node[wrong] = node.pop(key)
    assert problems(changed, json_schema()) != []


@pytest.mark.parametrize(
    ("place", "value"),
    [
        (["schema"], 2),
        (["convention"], "denavit_hartenberg"),
        (["arms", "ariane4", "gravity"], [0, 0]),
        (["arms", "ariane4", "joints", 0, "drive", "rev"], 2),
        (["arms", "ariane4", "joints", 0, "drive", "type"], "lever"),
        (["arms", "ariane4", "joints", 0, "d"], [0.1]),
        (["arms", "ariane4", "joints", 0, "d"], True),
        (["arms", "ariane4", "joints"], []),
    ],
)
def test_a_wrong_value_is_marked(document: Any, place: list[str | int], value: Any) -> None:
    changed = copy.deepcopy(document)
    node = changed
    for step in place[:-1]:
        node = node[step]
    node[place[-1]] = value
    assert problems(changed, json_schema()) != []


def test_effects_are_checked_where_the_catalogue_is_known(document: Any) -> None:
    for entry in ("viscuous_friction", {"coulomb_friction": {"magnitud": 1}}, {"spring": {}}):
        changed = copy.deepcopy(document)
        for owner in (changed["arms"]["rx90"]["joints"][0], changed["arms"]["rx90"]):
            owner["effects"] = [entry]
            assert problems(changed, json_schema()) == []
            assert problems(changed, json_schema(EFFECTS)) != []
            del owner["effects"]


def test_an_editor_shows_text_and_unit_of_effects() -> None:
    schema = json_schema(known_effects(), effect_texts())
    for owner in ("JointModel", "ArmModel"):
        effects = schema["$defs"][owner]["properties"]["effects"]
        items = effects["items"] if "items" in effects else effects["anyOf"][0]["items"]
        names, values = items["anyOf"]
        assert {entry["const"] for entry in names["oneOf"]} == set(known_effects())
        assert all(entry["description"] for entry in names["oneOf"])
        for name, effect in values["properties"].items():
            assert effect["description"]
            for parameter in known_effects()[name]:
                assert re.search(r"\w.* \[.+\]", effect["properties"][parameter]["description"])
    properties = values["properties"]
    friction = properties["viscous_friction"]["properties"]["coefficient"]["description"]
    assert "[N m s/rad at the motor" in friction
    stiffness = properties["spring"]["properties"]["stiffness"]["description"]
    assert "[N m/rad; prismatic joint: N/m]" in stiffness


def test_every_field_is_described_and_every_quantity_has_its_unit() -> None:
    definitions = json_schema()["$defs"]
    fields = {
        f"{model}.{name}": field["description"]
        for model, definition in definitions.items()
        for name, field in definition["properties"].items()
    }
    assert len(fields) > 35
    quantities = {
        f"{model}.{name}"
        for model, definition in definitions.items()
        for name, field in definition["properties"].items()
        if '"number"' in str(field).replace("'", '"')
    }
    # An effect's unit depends on its parameter: in words.
    in_words = {"JointModel.effects", "ArmModel.effects"}
    without = {name for name in quantities if "[" not in fields[name]}
    assert without == in_words
