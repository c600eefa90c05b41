"""Traits are what other parts may ask of an effect besides its law: where it can stand, how its values are
found, where and when it shows, which values are plausible.

Every trait says something of the physics or of the measurement, and has a default: a kind of effect sets what
it implies, and a class of its own sets what is particular to it. Joints are numbered as coordinates, from 1;
None is the whole arm.
"""

from __future__ import annotations

import math
from abc import ABC
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from enum import Enum
from itertools import product
from types import MappingProxyType
from typing import ClassVar

import numpy as np

from modelgen.description.objects import Arm, Joint
from modelgen.effects.parameters import Parameter, at
from modelgen.numeric import Array

Numbers = Mapping[str, float]  # values of parameters, by name
Added = Callable[[Numbers], Array]  # what the effect with these values adds to the inputs, (N, n)
INVISIBLE = 1e-5  # of the largest column
SMALL = 1e-3  # of the value in its picture, of a parameter: the step of a slope


class Family(Enum):
    """Kind of the rest that a law leaves, since no law is that of the arm to the last."""

    OTHER = "other"
    FRICTION = "friction"  # a force over the joint's own motion
    SPRING = "spring"  # a force over the joint's position: none is linear over all its travel
    FLUID = "fluid"  # one value for all links, whose widths differ
    ELASTIC = "elastic"  # a link that swings behind its drive shakes all links


class Presence(Enum):
    """When it is there."""

    ALWAYS = "always"
    SOME = "some"  # in some of the records and not in others: it comes or goes between two of them
    FADING = "fading"  # most at the begin of a log: it does not repeat with the excitation


class Shows(Enum):
    """Parts of a motion that show it."""

    NEAR_REST = "near rest"  # friction at speeds near zero
    REVERSALS = "reversals"  # as a change of what happens where the speed changes its sign
    BRIEFLY = "briefly"  # changes within less than a few samples
    IMPACTS = "impacts"  # in moments, between which it does nothing
    PLACES = "places"  # by where the joint is, of which one range says nothing about another
    LOAD = "load"  # in another way with another payload


@dataclass(frozen=True)
class Reading:
    """A reading on the bench of what a cause claims. names: the parameters that claim it. std: standard
    deviation of the reading in their unit; None where it is a force that is read off the input for `duration`
    [s], with the noise of that, in A. claim: what the cause says of it, with a place for the size and its
    unit.
    """

    text: str
    names: tuple[str, ...]
    std: float | None = None
    duration: float = 1.0
    claim: str = "the cause claims {}"


@dataclass(frozen=True)
class Seen:
    """Limits of what records can show. whole: each begins where its log does; still: joints that rest in all;
    unsided: joints whose position cannot tell a link from its drive, since it is not known which of the two
    it is, or is too coarse (`coarse`).
    """

    whole: bool
    still: tuple[int, ...]
    unsided: tuple[int, ...]
    coarse: bool


class Traits(ABC):
    """Traits of an effect.

    Nonlinear parameters without a grid or forms, whose default is zero or is not given, are departures from
    the model: where no parameter is linear they are estimated, by slopes about zero.

    sources: what robot files call its parameters, at the joint: its own name of each by theirs.
    laws: what simulators call those of a law that stands by itself, at the motor: likewise; "other" and
        "ratio" where it acts on q + ratio q_other.
    parts: names of parameters that are also estimated alone, since others often are as they were.
    exact: what it does follows from the arm's own equations or is a constant; its form leaves others nothing.
    needs_effort: it is about what the drives are given, or what working does to them; of no meaning in a free
        motion.
    needs_drive: it is made by a drive; a joint without one has it only where efforts tell of an actuator.
    periodic: it repeats with its coordinate, `harmonic` times in a `revolution`, two of its parameters; the
        waves are read off a periodogram.
    rereads: with it the joint is elsewhere at the same reading of its motor.
    relative: motions show it beside that of other joints alone; where all have it, so do the parameters.
    own_sizes: each joint or link has a size of its own, so that one that may stand at either is looked for at
        each alone too.
    of_rotor: its parameter is the inertia of the drive itself, before what lies between drive and link.
    overlooked: how many times its usual size, and in any case up to which value, nobody sees it at a glance.
    reading: what can be read of it on the bench.
    simpler: the law of the catalogue that this one comes to at a limit of its values.
    varies: laws of the catalogue that this one lets vary, over time, place, load or speed. Where a
        description lacks one of them, what is constant in this law comes first (marginality, Nelder 1977).
    series: its law is the first terms of a series in the joint's position; another function of the position
        and the direction is the same cause.
    claims: names of parameters without which it would not be there, see `above_zero`.
    """

    name: ClassVar[str]
    linear: ClassVar[tuple[Parameter, ...]] = ()
    nonlinear: ClassVar[tuple[Parameter, ...]] = ()
    shown: ClassVar[Mapping[str, float]] = at()
    sources: ClassVar[Mapping[str, str]] = MappingProxyType({})
    laws: ClassVar[Mapping[str, str]] = MappingProxyType({})
    parts: ClassVar[tuple[tuple[str, ...], ...]] = ()
    family: ClassVar[Family] = Family.OTHER
    exact: ClassVar[bool] = False
    presence: ClassVar[Presence] = Presence.ALWAYS
    shows: ClassVar[frozenset[Shows]] = frozenset()
    needs_effort: ClassVar[bool] = False
    needs_drive: ClassVar[bool] = False
    periodic: ClassVar[bool] = False
    rereads: ClassVar[bool] = False
    relative: ClassVar[bool] = False
    own_sizes: ClassVar[bool] = False
    of_rotor: ClassVar[bool] = False
    overlooked: ClassVar[tuple[float, float]] = (math.inf, 0.0)
    reading: ClassVar[Reading | None] = None
    simpler: ClassVar[type[Traits] | None] = None
    varies: ClassVar[tuple[type[Traits], ...]] = ()
    series: ClassVar[bool] = False
    claims: ClassVar[tuple[str, ...]] = ()

    @classmethod
    def accepted(cls) -> tuple[Parameter, ...]:
        """The parameters that a description may set."""
        return (*cls.linear, *cls.nonlinear)

    # -- where it stands, and what it does there --------------------------------------------

    @classmethod
    def stands_at(cls, arm: Arm, number: int | None) -> bool:
        """Whether the arm admits it there."""
        return True

    @classmethod
    def delays(cls, values: Numbers) -> float | None:
        """Time [s] by which the effort comes after its input, where that is all it does."""
        return None

    @classmethod
    def lags(cls, values: Numbers) -> bool:
        """Whether such a time is the time constant of a first-order lag: of the effort, or, where it is
        negative, of what the log has of it.
        """
        return False

    @classmethod
    def scales(cls, values: Numbers) -> float | None:
        """Factor that it puts on the joint's input, where that is all it does."""
        return None

    @classmethod
    def pivot_direction(cls, values: Numbers) -> float | None:
        """Direction [rad] that its values give the actuator's base, from the joint, against x of the joint's
        frame at q = -theta; None for most.
        """
        return None

    # -- how its values are found -----------------------------------------------------------

    @classmethod
    def departures(cls) -> tuple[Parameter, ...]:
        """Nonlinear parameters that are zero where nothing is amiss."""
        return tuple(p for p in cls.nonlinear if not (p.structural or p.grid or p.forms or p.default))

    @classmethod
    def estimated(cls) -> tuple[str, ...]:
        """Names of what its columns belong to."""
        return tuple(p.name for p in cls.linear or cls.departures())

    @classmethod
    def searched(cls) -> tuple[Parameter, ...]:
        """Nonlinear parameters that are searched for; at most the first of them by a grid."""
        return tuple(p for p in cls.nonlinear if len(p.grid) > 1)

    @classmethod
    def variants(cls, arm: Arm, number: int | None) -> list[dict[str, float]]:
        """Values that are not searched for, of every form in which it is tried at a place."""
        open_to = [(p.name, p.forms) for p in cls.nonlinear if p.forms]
        return [
            {name: value for (name, _), value in zip(open_to, values, strict=True) if value is not None}
            for values in product(*(forms for _, forms in open_to))
        ]

    @classmethod
    def conditional(cls, fixed: Numbers) -> tuple[str, ...]:
        """Names of what is estimated if values that are not searched for are as they are guessed."""
        return ()

    @classmethod
    def subsets(cls, arm: Arm, number: int | None) -> tuple[tuple[str, ...], ...]:
        """Names of the parameters that are estimated at a place, one try after the other; () for all."""
        return ((), *cls.parts)

    @classmethod
    def sought(cls, behind_link: bool) -> tuple[Parameter, ...]:
        """All that is searched for in turn, the first over its grid; none where it cannot show.

        behind_link: the position of the link was measured, not that of its drive. Of elastic joints and play
        it is more than their own parameters, since nothing that they do is in proportion to any.
        """
        return cls.searched()

    @classmethod
    def slopes(cls, names: Sequence[str], values: Numbers, added: Added) -> Array:
        """Changes of the inputs (N, n, k) per unit of what is estimated, where nothing is linear.

        names: of `estimated`. values: of all parameters that have one; where a departure has one that is more
        than the step of a slope, its column is the secant, the whole change over the value: a tilt that turns
        heavy links is beyond a slope. Slopes are central, and one-sided where no value is below zero.
        """
        departures = {p.name: p for p in cls.departures()}
        held = {name: value for name, value in values.items() if name not in departures}
        parts = []
        for name in names:
            p, value = departures[name], values.get(name, 0.0)
            step = p.step or SMALL * abs(cls.shown.get(name, 0.0)) or SMALL
            if abs(value) > step:
                parts.append(added({**held, name: value}) / value)
                continue
            ahead = added({**held, name: step})
            if p.bounds[0] > -step:
                parts.append(ahead / step)
            else:
                behind = added({**held, name: -step})
                parts.append((ahead - behind) / (2 * step))
        return visible(np.stack(parts, axis=2))

    @classmethod
    def physical(cls, found: Numbers) -> dict[str, float]:
        """Its own parameters from what was fixed, searched for and estimated."""
        round_ = {p.name for p in cls.nonlinear if p.turns}
        return {name: math.remainder(v, math.tau) if name in round_ else v for name, v in found.items()}

    @classmethod
    def vanishes(cls, estimated: Numbers) -> bool:
        """Whether it vanishes: no parameter that may not be negative is above zero."""
        positive = {p.name for p in cls.accepted() if p.bounds[0] >= 0.0}
        limited = [value for name, value in estimated.items() if name in positive]
        return bool(limited) and not max(limited) > 0

    # -- where it shows ---------------------------------------------------------------------

    @classmethod
    def judged_at(cls, number: int | None, values: Numbers, n: int) -> list[int]:
        """Coordinates (from 0), of n, whose equations show it."""
        if number is None:
            return list(range(n))
        pair = cls.coupled(values)
        return [number - 1] if pair is None else [number - 1, pair[0] - 1]

    @classmethod
    def coupled(cls, values: Numbers) -> tuple[int, float] | None:
        """Number of another joint that turns it too, and its own turns per turn of that; None for most."""
        return None

    @classmethod
    def imitates(cls, values: Numbers) -> Shows | None:
        """Part of a motion in which its values make it look like another law; None for most."""
        return None

    @classmethod
    def hidden(cls, arm: Arm, seen: Seen, named: bool) -> list[str]:
        """Why records of this arm cannot show it; none where they can. named: it was found in them."""
        return []

    # -- which values are plausible ---------------------------------------------------------

    @classmethod
    def impossible(cls, arm: Arm, number: int | None, values: Numbers) -> str:
        """Why no arm has it with these values, a clause; empty where nothing speaks against them."""
        return ""

    @classmethod
    def above_zero(cls, arm: Arm, values: Numbers, spread: Numbers) -> float:
        """Standard deviations by which what it claims is above zero, the least of all; inf where nothing is.

        values, spread: of what is estimated of it, with its standard deviations, by name.
        """
        found = (values[name] / max(spread[name], 1e-300) for name in cls.claims if name in values)
        return min(found, default=math.inf)

    @classmethod
    def usual(cls, arm: Arm, number: int | None) -> Mapping[str, float]:
        """Sizes of its parameters that arms usually have, of those alone of which something is known."""
        return {p.name: p.usual for p in cls.nonlinear if p.usual is not None}


def visible(columns: Array) -> Array:
    """Columns (N, n, k), zero where differences have left nothing but rounding of what does not show."""
    sizes = np.abs(columns).max(axis=(0, 1), initial=0.0)
    return np.where(sizes > INVISIBLE * sizes.max(initial=0.0), columns, 0.0)


def joint_of(arm: Arm, number: int) -> Joint:
    """The joint of a coordinate, by its number from 1."""
    return arm.joints[arm.coordinates[number - 1]]
