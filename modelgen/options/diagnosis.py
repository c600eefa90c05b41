"""What may be chosen about a diagnosis."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from modelgen.options.field import documented, option


@documented(
    fields_beside={"thresholds": "Other values of thresholds by name, as docs/thresholds.md lists them."}
)
@dataclass(frozen=True)
class DiagnosisOptions:
    """How a model's gaps are looked for in logs; see docs/diagnosing.md."""

    mapping: Path | str | None = option(None, "Mapping file of a foreign log.", "FILE", kind=Path | None)
    cutoff: float | None = option(None, "Low-pass of effort and regressor.", "HZ", unit="Hz")
    period: float | None = option(None, "Period of the excitation, found by itself else.", "S", unit="s")
    effects: Sequence[str] = option(
        (),
        "Ask for this effect alone; repeatable.",
        "NAME[:JOINT]",
        ["--effect"],
        doc="Effects to ask for alone, NAME or NAME:JOINT, by name or number. Default: the catalogue.",
    )
    experiment: bool = option(
        True,
        "Do not look for what tells rivalling causes apart.",
        flags=["--no-experiment"],
        inverted=True,
        doc="Whether to look for what tells rivalling causes apart.",
    )
    processes: int | None = option(
        None, "Processes. Default: one per processor.", "N", ["-j", "--jobs"], least=1
    )
    thresholds: Mapping[str, float | tuple[float, ...]] = field(default_factory=dict)
