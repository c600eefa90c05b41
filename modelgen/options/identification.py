"""Options of an identification."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from modelgen.options.field import documented, option
from modelgen.options.model import GAINS, check_gains, parts_of


@documented()
@dataclass(frozen=True)
class IdentificationOptions:
    """How base parameters are found from logs; see docs/identification.md.

    Raises InputError for parts that cannot be left out, and for gains that do not exist. The other
    values are checked before the logs are read.
    """

    mapping: Path | str | None = option(None, "Mapping file of a foreign log.", "FILE", kind=Path | None)
    cutoff: float | None = option(None, "Low-pass of effort and regressor.", "HZ", unit="Hz")
    preset: str = option("default", "Processing: default, paper or paper_parallel, see docs/logs.md.", "NAME")
    method: str = option(
        "wls",
        "ols, wls (weights by joint), gls (noise that joints share), robust, iv (noisy positions).",
        "NAME",
    )
    instrument: str = option(
        "auto",
        "auto, period (another period of the motion) or simulated (the model under its controller).",
        "NAME",
    )
    control: str = option("pi", "Of the simulated instrument: pi (cascade) or computed_torque.", "NAME")
    reference: Any = option(
        None,
        "CSV with t and q<n> that the controller followed. Default: the filtered measured motion.",
        "FILE",
        kind=Path | None,
        unit="s, rad or m",
    )
    bandwidth: float | None = option(
        None, "Of that controller. Default: enough for the motion.", "HZ", unit="Hz"
    )
    gains: str = option(
        "known",
        "Torque constants: known, estimated (from a --payload), or each row in its own scale.",
        choices=GAINS,
    )
    payload: Sequence[str] | Mapping[str | int, float | Sequence[float]] = option(
        (),
        "Point mass [kg] that the last link carries in a log, in its frame [m]; repeatable.",
        "LOG=M[,X,Y,Z]",
        unit="kg, m",
    )
    essential: bool = option(False, "Fit again with the parameters alone that the logs support.")
    compare_drives: bool = option(
        False,
        "Identify without the drives' dynamics too, and compare the errors on the test records.",
    )
    folds: int | None = option(
        None,
        "Cross-validate: each of K parts of the training records held out in its turn.",
        "K",
        least=2,
    )
    consistent: bool = option(False, "The closest parameters of links that could exist.")
    stream: bool = option(False, "Read block by block, as logs above 512 MB always are.")
    without: frozenset[str] = option(
        frozenset(), "Leave out drives, effects or both: drives,effects.", "PARTS", kind=str
    )

    def __post_init__(self) -> None:
        object.__setattr__(self, "without", parts_of(self.without))
        check_gains(self.gains)
