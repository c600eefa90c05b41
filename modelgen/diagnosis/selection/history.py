"""The history holds the candidates of every turn, their evidence, and why each is no cause."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from modelgen.diagnosis.candidates import FittedCandidate, Place
from modelgen.diagnosis.validation import Judgement

# Why what was taken is no cause in the end.
EXCHANGED, SUPERFLUOUS, COARSE = "exchanged", "superfluous", "coarse positions"
SUSPECT = "suspect"


@dataclass(frozen=True)
class Ranked:
    """A candidate's evidence at one turn, and why it is no cause: empty for what passed validation.

    cross_gain, expected_gain: as a cause's, None where that was not asked; chosen: at this turn,
    after an exchange the one that stayed.
    """

    effect: str
    joint: int | None
    delta_bic: float
    cross_gain: float | None
    expected_gain: float | None
    refused: str
    chosen: bool = False

    @property
    def place(self) -> Place:
        """Effect and joint."""
        return self.effect, self.joint


History = list[list[Ranked]]


def ranked(trial: FittedCandidate, by: Judgement | None, refused: str) -> Ranked:
    """by: where validation was asked."""
    gain, expected = (None, None) if by is None else (by.gain, by.expected)
    return Ranked(*trial.candidate.place, trial.gain.delta_bic, gain, expected, refused)


def best_of_each(ranking: Sequence[Ranked], taken: Place | None) -> list[Ranked]:
    """Best first; of an effect that was tried in several forms at a joint the one that came farthest."""
    best: dict[Place, Ranked] = {}
    for r in sorted(ranking, key=lambda r: (bool(r.refused), -r.delta_bic)):
        best.setdefault(r.place, replace(r, chosen=r.place == taken))
    return sorted(best.values(), key=lambda r: -r.delta_bic)


def taken_back(turns: History, place: Place, why: str, instead: Place | None = None) -> History:
    """The turns, where one took `place`, with the reason why it did not stay; and took `instead`."""
    return [
        [_with_taken(r, place, why, instead or place) for r in turn]
        if any(r.chosen and r.place == place for r in turn)
        else turn
        for turn in turns
    ]


def _with_taken(r: Ranked, lost: Place, why: str, taken: Place) -> Ranked:
    return replace(r, refused=why if r.place == lost else r.refused, chosen=r.place == taken)
