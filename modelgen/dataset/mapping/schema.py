"""Structure of a mapping file as pydantic models: what the columns of a foreign log are."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field

from modelgen.description.schema import Model, Number

ColumnText = Annotated[str, Field(min_length=1)]


class TimeModel(Model):
    """The time axis."""

    column: ColumnText = Field(default="t", description="Column of the time stamps.")
    unit: str = Field(default="s", description="Unit of the stamps: s, ms, us, ns.")
    relative: bool = Field(default=False, description="Count time from the first sample of the file.")
    resample: Number | None = Field(
        default=None, description="Rate [Hz] of the uniform axis. Default: of the median period."
    )
    largest_gap: Number | None = Field(
        default=None, description="Longest time [s] without a sample. Default: ten periods."
    )


class ColumnModel(Model):
    """A signal: scale times the column plus the offset, in the unit."""

    column: ColumnText = Field(description="A column, or a formula over columns: load / 885 * vin.")
    unit: str = Field(description="Unit of scale times column plus offset.")
    scale: Number = Field(default=1.0, description="Factor of the column; a minus sign turns it round.")
    offset: Number = Field(default=0.0, description="Added to scale times column, in the unit.")
    bits: Annotated[int, Field(ge=2, le=52)] | None = Field(
        default=None,
        description="Of a counter whose negative values were logged as unsigned: 16 where -1 is 65535.",
    )


class PlacedModel(ColumnModel):
    """A position or an effort: at the joint, or at the motor coordinate of its drive."""

    side: Literal["joint", "motor"] = Field(default="joint", description="joint: q; motor: q_m.")


class TemperatureModel(ColumnModel):
    """A temperature, of the motor or the gear."""

    unit: str = Field(default="degC", description="degC.")


class PositionModel(PlacedModel):
    """A position; a sensor that starts anew after a turn is made continuous."""

    wrap: Number | None = Field(
        default=None, description="Range after which the sensor starts anew, in the unit: 360, 2*pi."
    )


class JointModel(Model):
    """One joint's signals."""

    position: PositionModel = Field(description="Where the joint is.")
    effort: PlacedModel | None = Field(
        default=None,
        description="What drives it, none for a free motion: A, mA; N m, N mm, kN m, N, kN; duty, % (of the "
        "duty cycle); V, mV.",
    )
    velocity: ColumnModel | None = Field(default=None, description="Measured dq.")
    acceleration: ColumnModel | None = Field(default=None, description="Measured ddq.")
    temperature: TemperatureModel | None = Field(default=None, description="Of the motor or the gear.")


class CouplingModel(Model):
    """A coupled transmission: logged positions are R q, joint efforts are R' times the logged ones."""

    matrix: Annotated[list[list[Number]], Field(min_length=1)] = Field(description="R, by rows.")
    joint_offset: list[Number] | None = Field(
        default=None, description="Added to q [rad, m]: q = R^-1 logged + joint_offset."
    )


class Document(Model):
    """The whole file."""

    schema_version: Literal[1] = Field(alias="schema", description="Version of this format: 1.")
    source: str = Field(default="", description="Where the log comes from; free text.")
    time: TimeModel = Field(default=TimeModel(), description="The time axis.")
    rate: Number | None = Field(
        default=None,
        description="Samples per second where there are no stamps, or useless ones: they are counted.",
    )
    hold: Number = Field(
        default="following",
        description="following: an effort holds until the next sample; previous: since the one before; "
        "instant: it was sampled at its stamp; a number: that long after its stamp [s].",
    )
    columns: list[ColumnText] = Field(
        default=[], description="Names of the columns of a table without a header, in their order."
    )
    delimiter: Literal[",", ";", "\t", "|", " "] | None = Field(
        default=None, description="What stands between cells; ' ' for blanks. Default: found out."
    )
    decimal: Literal[".", ","] | None = Field(default=None, description="Decimal sign. Default: found out.")
    encoding: str | None = Field(
        default=None, description="Encoding of the text: utf-8, utf-16, latin-1. Default: found out."
    )
    skip_lines: Annotated[int, Field(ge=0)] = Field(
        default=0, description="Lines passed over at the beginning of the file."
    )
    names: dict[str, str] = Field(
        default={}, description="Short names for columns whose own cannot be part of a formula."
    )
    joints: Annotated[list[JointModel], Field(min_length=1)] | None = Field(
        default=None,
        description="The joints, in the order of the arm's coordinates. Default: by the names t, q1, i1, "
        "in SI units.",
    )
    coupling: CouplingModel | None = Field(default=None, description="A coupled transmission.")


def mapping_json_schema() -> dict[str, Any]:
    """JSON Schema (draft 2020-12) of mapping files, for editors."""
    schema = Document.model_json_schema(by_alias=True)
    head = {"$schema": "https://json-schema.org/draft/2020-12/schema", "title": "modelgen mapping of a log"}
    return head | {key: value for key, value in schema.items() if key != "title"}
