"""A grouping states base parameters as combinations of standard parameters."""

from __future__ import annotations

from dataclasses import dataclass

from modelgen.description.objects import Scalar


@dataclass(frozen=True)
class BaseParameter:
    """One base parameter: the sum of `terms`, pairs of (index of a standard parameter, factor).

    The first term is the representative, with factor 1: the column of the regressor that belongs to
    the base parameter is the representative's, of a last link in its frame moved to the foot of the
    common normal (`analytic.slid`). `expression` is the sum in print.
    """

    name: str
    unit: str
    terms: tuple[tuple[int, Scalar], ...]
    expression: str

    @property
    def representative(self) -> int:
        """Index of the standard parameter whose column, in the frames of `slid`, this parameter takes."""
        return self.terms[0][0]


@dataclass(frozen=True)
class Contained:
    """A drive's inertia in a base parameter of its link's.

    joint: index into `arm.joints`. name: of the drive's inertia among the standard parameters; base: index of
    the base parameter, in which a unit of it counts `factor` times. nominal: the description's value, None
    where it gives none.
    """

    joint: int
    name: str
    base: int
    factor: Scalar
    nominal: float | None


@dataclass(frozen=True)
class Grouping:
    """The base parameters, the standard parameters that have no effect at all on the input, and the drives'
    inertia that base parameters of links contain.
    """

    base: tuple[BaseParameter, ...]
    without_effect: tuple[int, ...]
    drives: tuple[Contained, ...] = ()
