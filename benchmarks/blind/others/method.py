"""What a method gets, and what it gives back: one class, and the list of all that are there."""

from __future__ import annotations

import importlib
import pkgutil
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from blind.case import Array
from blind.others import methods
from modelgen.description import Arm

Place = tuple[str, int | None]  # effect of the catalogue and joint from 1, None for the whole arm


@dataclass(frozen=True)
class Term:
    """An effect at a place, with the values at which its columns were taken.

    searched: how many of its values were found by trying, because its columns do not depend on them linearly.
    """

    effect: str
    joint: int | None
    values: Mapping[str, float]
    searched: int = 0

    @property
    def place(self) -> Place:
        """Effect and joint."""
        return self.effect, self.joint


@dataclass(frozen=True)
class Motion:
    """M rows of n joints, all in one filter: time (M,) [s]; q, dq, ddq (M, n) [rad, m]; moving (M, n), rows
    that count; own (M, n, p), columns of the user's model, one for each of its parameters; terms, columns (M,
    n, k) of each of the problem's terms.
    """

    time: Array
    q: Array
    dq: Array
    ddq: Array
    moving: Array
    own: Array
    terms: Sequence[Array]

    @cached_property
    def table(self) -> Array:
        """Columns of all terms side by side, (M, n, K)."""
        return np.concatenate([self.own[:, :, :0], *self.terms], axis=2)


@dataclass(frozen=True)
class Record(Motion):
    """A training record: its motion, and effort (M, n) as the description has it [N m, N, or current]."""

    effort: Array


@dataclass(frozen=True)
class Problem:
    """One case, as a method sees it.

    folder: arms.yaml, mapping.yaml if there is one, and the training records as they were logged, for who
    does everything alone. arm: as described. terms: what may be missing, everything that modelgen
    would ask for. train: the training records. test: the motion of the test record, whose effort nobody sees.
    """

    folder: Path
    arm: Arm
    terms: Sequence[Term]
    train: Sequence[Record]
    test: Motion

    @property
    def n(self) -> int:
        """Number of joints."""
        return int(self.test.q.shape[1])


@dataclass(frozen=True)
class Answer:
    """named: what is said to be missing. effort: (M, n), predicted along the test record's motion."""

    named: frozenset[Place]
    effort: Array


class Method(ABC):
    """Names what a model lacks, and predicts the effort of a record that it has not seen."""

    title: str  # in the table
    tuning: str  # how what it lets one choose was chosen, a sentence
    names = True  # whether it names anything at all

    @abstractmethod
    def answer(self, problem: Problem) -> Answer:
        """Answer of the method for one case."""


def known() -> tuple[str, ...]:
    """Names of the methods that are there: the modules of `blind.others.methods`."""
    return tuple(sorted(m.name for m in pkgutil.iter_modules(methods.__path__)))


def method(name: str) -> Method:
    """A method by its name. Raises ValueError for one that is not there."""
    if name not in known():
        raise ValueError(f"no method {name!r}: there are {', '.join(known())}")
    found = importlib.import_module(f"blind.others.methods.{name}").METHOD
    assert isinstance(found, Method)
    return found
