"""Causes, values and errors as they are reported."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from modelgen.diagnosis.evidence import Endogeneity
from modelgen.diagnosis.validation import Check
from modelgen.numeric import Array


@dataclass(frozen=True)
class Estimate:
    """A parameter of a cause. separate: whether the records show it beside the arm's own parameters, which
    hold it where they do not; its value then is zero.
    """

    value: float
    std: float
    unit: str
    separate: bool = True


@dataclass(frozen=True)
class Share:
    """A share is what leaving a cause out costs on the test record, percent of the RMSE. low, high: 95 %
    interval. Below zero where it does harm there. Not a number where that is not known.
    """

    gain: float = float("nan")
    low: float = float("nan")
    high: float = float("nan")


@dataclass(frozen=True)
class NamedCause:
    """A cause. joint: number of the coordinate from 1, None for the whole arm. ambiguous_with: rivals with
    how far their evidence lies behind; aliases: effects that no motion tells apart from it. cross_gain,
    expected_gain: percent of the RMSE on rows that its fit had not seen, measured, and due to it as found.
    share: of the gain on the test record. joint_name: of the description, None for the whole arm. checks: the
    same for every cause. records: those that have it, where others do not, the test record among them; None
    where all do.
    """

    effect: str
    joint: int | None
    parameters: Mapping[str, Estimate]
    delta_bic: float
    cross_gain: float
    expected_gain: float
    aliases: tuple[tuple[str, int | None], ...] = ()
    ambiguous_with: tuple[tuple[str, int | None, float], ...] = ()
    share: Share = Share()
    joint_name: str | None = None
    checks: tuple[Check, ...] = ()
    records: tuple[str, ...] | None = None


@dataclass(frozen=True)
class Errors:
    """RMSE on the test record by joint (n,), in `unit`. gain: percent; low, high: its 95 % interval.

    interval: that of `overall`.
    """

    unit: str
    before: Array
    after: Array
    gain: Array
    low: Array
    high: Array
    interval: tuple[float, float] = (float("nan"), float("nan"))

    @property
    def overall(self) -> float:
        """Percent of the error over all joints that have one, each in units of its own error before."""
        measured = self.before > 0.0
        ratios = self.after[measured] / self.before[measured]
        return float(100.0 * (1.0 - np.sqrt(np.mean(ratios**2)))) if measured.any() else float("nan")


@dataclass(frozen=True)
class Positions:
    """Errors of the positions. feigned: percent of the RMSE by joint (n,) that they could feign; endogeneity:
    test of Durbin, Wu and Hausman, None where nothing repeats.
    """

    feigned: Array
    endogeneity: Endogeneity | None
