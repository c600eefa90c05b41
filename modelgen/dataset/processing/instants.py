"""When efforts were read against the stamps of the positions: conventions of logs, and what the data say."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from modelgen.dataset.objects import Record
from modelgen.dataset.processing.resampling import efforts_resampled
from modelgen.dataset.thresholds import USUAL, DatasetThresholds

CLEARLY = 5.0  # deviations by which a delay is beyond a sample

# Sampling periods by which what an effort's sample stands for lies after the position's stamp.
CONVENTIONS = {"following": 0.5, "instant": 0.0, "previous": -0.5}
UNKNOWN = 0.65  # sampling periods: the conventions from the default one, each as likely as the others (RMS)


@dataclass(frozen=True)
class LateChannel:
    """Channels of a joint that are older than all others, or younger.

    name: of the joint. what: "positions", "efforts", or "positions and efforts". samples: how many sampling
    periods older, negative for younger. deviation: of that.
    """

    name: str
    what: str
    samples: float
    deviation: float

    def question(self, step: float) -> str:
        """A question about them, for a sampling period [s]."""
        age, rows = abs(self.samples), round(abs(self.samples))
        how, where = ("older", "up") if self.samples > 0 else ("younger", "down")
        columns = "columns" if " and " in self.what else "column"
        return (
            f"The {self.what} at {self.name} are {age * step * 1e3:.3g} ms ({age:.3g} ± "
            f"{_short(self.deviation)} samples) {how} than all other channels: are they filtered, or sent "
            f"late? Parameters may be wrong by that; move their {columns} {where} by {rows} rows beside the "
            "others."
        )


@dataclass(frozen=True)
class EffortInstant:
    """When the efforts of records were read.

    hold: as used, one of CONVENTIONS or a delay [s]. known: what says so: "mapping", "readings", "data", or
    nothing, where it is the default. delay, std: of the efforts' samples after the positions' stamps as the
    data have it [sampling periods]; None where they do not say. fits: what that is, a convention or a delay
    [s]; None where the data cannot tell. step: sampling period [s]. alike: whether the joints agree. late:
    names of joints whose efforts are clearly more than a sample away from what is used, each with its delay
    and deviation. missing: whether a delay that fits best stands for causes that the model lacks, and is not
    given. channels: those that are clearly older than all others where positions are among them, in place of
    the delays.
    """

    hold: str | float
    known: str
    step: float
    delay: float | None = None
    std: float | None = None
    fits: str | float | None = None
    alike: bool = True
    late: tuple[tuple[str, float, float], ...] = ()
    missing: bool = False
    channels: tuple[LateChannel, ...] = ()

    @property
    def answer(self) -> str:
        """What the data say to what is used: one of ANSWERS."""
        if self.channels:
            return "joints_differ"
        if self.known == "data":
            return "found"
        if self.fits is not None:
            return "agree" if agrees(self) else "disagree"
        if self._beyond_and_so():
            return "agree"
        vague = self.std is None or self.std > USUAL.max_instant_std
        if vague and not self.late:
            return "cannot_tell"
        return "beyond_a_sample" if self.alike else "joints_differ"

    @property
    def doubt(self) -> float:
        """How far the instant may be from what is used [sampling periods]: nothing where somebody said it, or
        where channels are late, which is asked about; as if nobody knew it where the efforts of a joint are.
        """
        if self.known not in ("", "data") or self.channels:
            return 0.0
        if self.delay is None or self.std is None or (self.late and not self.alike):
            return UNKNOWN
        used = CONVENTIONS[self.hold] if isinstance(self.hold, str) else self.hold / self.step
        return min(UNKNOWN, float(np.hypot(self.std, self.delay - used)))

    def _beyond_and_so(self) -> bool:
        """Whether a stated delay that is no convention is what the data say, to a part of a sample."""
        if self.delay is None or self.std is None or isinstance(self.hold, str) or not self.alike:
            return False
        off = abs(self.delay - self.hold / self.step)
        return self.std < 0.5 and off <= _tolerance(self.std, USUAL)

    def to_json(self) -> dict[str, Any]:
        """`log.effort_instant` of identification.json and diagnosis.json."""
        return {
            "hold": self.hold,
            "known_from": self.known or "default",
            "delay_samples": None if self.delay is None else round(self.delay, 4),
            "std_samples": None if self.std is None else float(f"{self.std:.3g}"),
            "fits": self.fits,
            "data": self.answer,
        }

    def questions(self) -> tuple[str, ...]:
        """A question for efforts that are clearly late or early, of all joints together where they agree."""
        if self.channels:
            return tuple(channel.question(self.step) for channel in self.channels)
        if not self.late or (self.alike and self.answer != "beyond_a_sample"):
            return ()
        groups = self.late
        if self.alike and self.delay is not None and self.std is not None:
            groups = ((", ".join(name for name, *_ in self.late), self.delay, self.std),)
        said = []
        for names, delay, std in groups:
            old, young = ("efforts", "positions") if delay < 0 else ("positions", "efforts")
            how = f"; `hold: {delay * self.step:.4g}` in a mapping file reads them so" if self.alike else ""
            said.append(
                f"The {old} at {names} are {abs(delay) * self.step * 1e3:.3g} ms ({abs(delay):.3g} ± "
                f"{_short(std)} samples) older than the {young} beside them: are they filtered, or sent "
                f"late? Parameters may be wrong by that{how}."
            )
        return tuple(said)

    def line(self) -> str:
        """One line on it."""
        if isinstance(self.hold, str):
            said = _WORDS[self.hold]
        else:
            said = f"{abs(self.hold) * 1e3:.4g} ms {'before' if self.hold < 0 else 'after'} it"
        text = f"the effort counts as {'read ' if not isinstance(self.hold, str) else ''}{said}"
        measured = "" if self.delay is None else f"{self.delay:.2f} ± {self.std:.2g} samples after it"
        source = {"mapping": ", as the mapping says", "readings": ": it is new where the position is"}
        text += f" (hold: {self.hold if isinstance(self.hold, str) else f'{self.hold:.4g}'})"
        text += source.get(self.known, "")
        if self.fits is not None and self.answer == "disagree":
            measured += f", hold: {self.fits if isinstance(self.fits, str) else f'{self.fits:.4g}'}"
        if self.channels:
            return text + "; the data cannot tell, for channels of a joint are older than the others"
        if self.missing:
            return text + "; the data cannot tell while the model lacks causes"
        return text + ANSWERS[self.answer] + (f": {measured}" if measured else "")


# What the data may say of when the efforts were read, and how a line goes on then.
ANSWERS = {
    "found": ", found from the data",
    "agree": "; the data agree",
    "disagree": "; but the data say otherwise",
    "cannot_tell": "; the data cannot tell",
    "joints_differ": "; the data cannot tell, for the joints differ; on average",
    "beyond_a_sample": "; the data have a delay that is no log's convention",
}

_WORDS = {
    "following": "held over the interval after the position's stamp",
    "previous": "held over the interval before the position's stamp",
    "instant": "read at the position's stamp",
}


def agrees(found: EffortInstant, limits: DatasetThresholds = USUAL) -> bool:
    """Whether the data agree with what is used, as far as they can tell."""
    if found.fits is None or found.delay is None or found.std is None:
        return True
    used = CONVENTIONS[found.hold] if isinstance(found.hold, str) else found.hold / found.step
    return abs(found.delay - used) <= _tolerance(found.std, limits)


def fitting(delay: float, std: float, step: float, limits: DatasetThresholds = USUAL) -> str | float | None:
    """The convention that a delay [sampling periods] is, else the delay [s]; None where it is neither.

    A delay beyond a sample from the default is no convention of a log: something in the arm is late.
    """
    if std > limits.max_instant_std:
        return None
    apart, name = min((abs(delay - place), name) for name, place in CONVENTIONS.items())
    if apart <= _tolerance(std, limits):
        return name
    return delay * step if abs(delay - CONVENTIONS["following"]) <= 1.0 + std else None


def beyond(delay: float, std: float, used: float) -> bool:
    """Whether a delay is clearly more than a sample from the one used, all in sampling periods."""
    return abs(delay - used) - 1.0 > CLEARLY * std


def with_hold(record: Record, hold: str | float) -> Record:
    """The record with its efforts read as `hold` says.

    Those of a log with uneven stamps are moved to its axis anew: what one reading stands for is longer where
    the next comes later.
    """
    step, uneven = record.step, record.uneven
    if uneven is not None and record.gain is not None:
        efforts, later = efforts_resampled(uneven.stamps, uneven.efforts, record.t, step, uneven.method, hold)
        held = hold in ("following", "previous")
        return replace(record, input=efforts / record.gain, hold=later, held=held, effort_hold=hold)
    later = CONVENTIONS[hold] * step if isinstance(hold, str) else hold
    return replace(record, hold=later, held=hold in ("following", "previous"), effort_hold=hold)


def _short(deviation: float) -> str:
    """One digit, without an exponent."""
    return f"{float(f'{deviation:.1g}'):g}"


def _tolerance(std: float, limits: DatasetThresholds) -> float:
    return max(3.0 * std, limits.instant_tolerance)
