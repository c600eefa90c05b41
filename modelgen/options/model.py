"""Options of an arm's functions."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, replace

from modelgen.errors import InputError, suggest
from modelgen.options.field import documented, option
from modelgen.options.noise import Noise

GAINS = ("known", "estimated", "row_wise")
PARTS = ("drives", "effects")
REALS = ("double", "float")


@documented(
    fields_beside={
        "identified": "Values of the base parameters by name, to be folded in.",
        "noise": "Noise of the inputs, which the monitor weighs by; None: all inputs alike.",
        "combined": "Whether there are the functions that the description combines of others.",
    }
)
@dataclass(frozen=True)
class ModelOptions:
    """How the functions of an arm are made; see docs/theory.md for the drive gains.

    Raises InputError for a part that cannot be left out, and for gains that do not exist.
    """

    without: frozenset[str] = option(
        frozenset(), "Leave out drives, effects or both: drives,effects.", "PARTS", kind=str
    )
    gains: str = option("known", "Drive gains: known, estimated, or scaled row by row.", choices=GAINS)
    runtime_geometry: bool = option(False, "Lever geometry, offsets and symbols become an input.")
    sincos: bool = option(
        False, "Sines and cosines of the joint angles become inputs.", flags=["--sincos-inputs"]
    )
    derivatives: bool = option(
        True,
        "Leave out the derivatives of the dynamics, the largest functions.",
        flags=["--no-derivatives"],
        inverted=True,
        doc="Whether there are derivatives of the dynamics, the largest functions.",
    )
    watch: bool = option(
        True,
        "Leave out the momentum observer and the monitor.",
        flags=["--no-watch"],
        inverted=True,
        doc="Whether there are the momentum observer and the monitor.",
    )
    jacobian_link: str | None = option(None, "Link that the Jacobian belongs to. Default: the last.", "LINK")
    real: str = option(
        "double", "Real numbers in C where the compiler is given no other: float or double.", choices=REALS
    )
    batch: frozenset[str] = option(
        frozenset(),
        "Functions that C has over many states at once too: inverse_dynamics,regressor, or all.",
        "NAMES",
        kind=str,
    )
    nominal: bool = option(
        False,
        "Also fold in the nominal values of links and effects: functions that end in _nominal, and an array.",
    )
    identified: Mapping[str, float] = field(default_factory=dict)
    noise: Noise | None = None
    combined: bool = True

    def __post_init__(self) -> None:
        object.__setattr__(self, "without", parts_of(self.without))
        object.__setattr__(self, "batch", frozenset(_words(self.batch)))
        check_gains(self.gains)
        if self.real not in REALS:
            hint = suggest(self.real, REALS)
            raise InputError(f"--real: found '{self.real}', expected {' or '.join(REALS)}{hint}")

    @property
    def evaluated(self) -> ModelOptions:
        """The same for a model that is evaluated and not printed: without what is made of other functions."""
        return replace(self, derivatives=False, combined=False, watch=False)


def parts_of(given: str | Collection[str]) -> frozenset[str]:
    """Parts to leave out, from "drives,effects" or their names. Raises InputError for others."""
    parts = _words(given)
    for part in parts:
        if part not in PARTS:
            raise InputError(
                f"--without: found '{part}', expected {' or '.join(PARTS)}{suggest(part, PARTS)}"
            )
    return frozenset(parts)


def _words(given: str | Collection[str]) -> list[str]:
    """Words of a list, or between the commas of a text."""
    words = given.split(",") if isinstance(given, str) else given
    return [word.strip() for word in words if word.strip()]


def check_gains(gains: str) -> None:
    """Raises InputError for a mode of the drive gains that does not exist."""
    if gains not in GAINS:
        raise InputError(f"--gains: found '{gains}', expected {', '.join(GAINS)}{suggest(gains, GAINS)}")
