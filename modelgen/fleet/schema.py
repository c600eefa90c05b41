"""Structure of a fleet's file as pydantic models: which arms, and which records belong to which."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field

from modelgen.description.schema import Model, Number

PLACE = "{unit}"
UNIT_NAME = r"^[A-Za-z0-9][A-Za-z0-9._-]*$"
Text = Annotated[str, Field(min_length=1)]


def _listed(value: Any) -> Any:
    return [value] if isinstance(value, str) else value


Specs = Annotated[list[Text], BeforeValidator(_listed), Field(min_length=1)]


class Common(Model):
    """Keys that hold for all units, unless one says otherwise."""

    arms: Text | None = Field(default=None, description="Description of the arm in YAML.")
    arm: Text | None = Field(default=None, description="Which arm of it. Default: the only one.")
    mapping: Text | None = Field(default=None, description="Mapping file of foreign logs.")
    cutoff: Number | None = Field(default=None, description="Low-pass of effort and regressor [Hz].")
    period: Number | None = Field(default=None, description="Period of the excitation [s].")


class UnitModel(Common):
    """One unit."""

    name: Annotated[str, Field(pattern=UNIT_NAME)] = Field(description="Its name, and that of its folder.")
    train: Specs = Field(description="Training records: FILE or FILE@t0:t1 [s].")
    test: Specs = Field(description="The record for the final errors alone.")


class PatternModel(Common):
    """Units found among files: {unit} stands for the name, * and ? for anything within a name."""

    train: Specs = Field(description="Training records of a unit, logs/{unit}/train_*.csv say.")
    test: Specs = Field(description="Its test record, logs/{unit}/test.csv say.")


class Document(Common):
    """A fleet."""

    schema_: Literal[1] = Field(alias="schema", description="Version of this format.")
    units: list[UnitModel] = Field(default_factory=list, description="Units one by one.")
    patterns: list[PatternModel] = Field(default_factory=list, description="Units by the names of files.")


def fleet_json_schema() -> dict[str, Any]:
    """JSON Schema (draft 2020-12) of fleet files, for editors."""
    schema = Document.model_json_schema(by_alias=True)
    # One record may stand without a list.
    for name in ("UnitModel", "PatternModel"):
        for key in ("train", "test"):
            listed = schema["$defs"][name]["properties"][key]
            text = listed.pop("description")
            schema["$defs"][name]["properties"][key] = {
                "anyOf": [listed, {"type": "string", "minLength": 1}],
                "description": text,
            }
    head = {"$schema": "https://json-schema.org/draft/2020-12/schema", "title": "modelgen fleet"}
    return head | {key: value for key, value in schema.items() if key != "title"}
