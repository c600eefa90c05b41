"""Options of simulated motions and of their refinement."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from modelgen.options.field import documented, option
from modelgen.options.model import parts_of

Coordinates = str | float | Sequence[float]

_PARAMETERS = "<arm>_parameters.yaml of modelgen identify."
_WINDOW = "Start again from the measured state after so long."


@documented()
@dataclass(frozen=True)
class SimulationOptions:
    """How a motion of the model begins, what drives it and how it is integrated; see docs/simulation.md.

    Values by joint are text as on the command line ("20 deg", "0.1, 20 deg"), a number for all joints, or
    numbers in joint order. Raises InputError for parts that cannot be left out.
    """

    q0: Coordinates = option(
        "", 'Initial positions: "20 deg", or one by joint: "0.1, 20 deg".', "Q", kind=str, unit="rad or m"
    )
    dq0: Coordinates = option(
        "0", "Initial velocities, likewise, per second.", "DQ", kind=str, unit="rad/s or m/s", quiet=True
    )
    duration: float | None = option(None, "Length.", "S", unit="s")
    rate: float | None = option(None, "Samples per second. Default: 1000.", "HZ", unit="Hz")
    lock: Sequence[str] | Mapping[str, float] = option(
        (), "Hold a joint, j2=0 say; repeatable.", "JOINT=Q", unit="rad or m"
    )
    payload: str | Sequence[float] = option(
        "", "Point mass at the last link [kg], in its frame [m].", "M[,X,Y,Z]", kind=str, unit="kg, m"
    )
    parameters: Path | str | Mapping[str, Any] | None = option(None, _PARAMETERS, "FILE", kind=Path | None)
    without: frozenset[str] = option(
        frozenset(), "Leave out drives, effects or both: drives,effects.", "PARTS", kind=str
    )
    mapping: Path | str | None = option(None, "Mapping file of a foreign log.", "FILE", kind=Path | None)
    window: float | None = option(None, _WINDOW, "S", unit="s")
    control: str = option("", "pi (cascade) or computed_torque, after --reference or the log.", "NAME")
    reference: Any = option(
        None, "CSV with t and q<n> to follow.", "FILE", kind=Path | None, unit="s, rad or m"
    )
    inputs: Any = option(
        None,
        "CSV with t and i<n> (tau<n> where undriven).",
        "FILE",
        ["--input"],
        kind=Path | None,
        unit="s, A, N m or N",
    )
    bandwidth: float = option(5.0, "Of the controller.", "HZ", unit="Hz")
    method: str = option("", "fixed (compiled C), cvodes, DOP853, RK45, LSODA, Radau or BDF.", "NAME")
    step: float | None = option(None, "Longest fixed step.", "S", unit="s")
    encoder: Coordinates = option(
        "", "Write a log: positions in counts per turn, or metre; one by joint.", "COUNTS", kind=str
    )
    encoder_at: str = option("joint", "Where the encoders sit: joint, or motor (columns qm<n>).", "SIDE")
    hold: str = option("", "What the logged efforts are: following, instant or previous.", "NAME")
    noise: Coordinates = option(
        "", "Standard deviation of the logged efforts.", "A", kind=str, unit="A, N m, N"
    )
    jitter: float = option(0.0, "Standard deviation of the logged samples' times.", "S", unit="s")
    seed: int = option(0, "Of noise and jitter.", "N")

    def __post_init__(self) -> None:
        object.__setattr__(self, "without", parts_of(self.without))


@documented()
@dataclass(frozen=True)
class RefinementOptions:
    """Which parameters are tuned until the simulated motion is the measured one, and from where."""

    mapping: Path | str | None = option(None, "Mapping file of a foreign log.", "FILE", kind=Path | None)
    parameters: Path | str | Mapping[str, Any] | None = option(None, _PARAMETERS, "FILE", kind=Path | None)
    free: Sequence[str] = option(
        (),
        "Base parameter to tune; repeatable. Default: all with efforts, else those of the effects.",
        "PARAMETER",
    )
    window: float | None = option(None, _WINDOW, "S", unit="s")
