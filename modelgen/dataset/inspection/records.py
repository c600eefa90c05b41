"""What was found out about the records of an identification or a diagnosis, and assumed of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from modelgen.charts import at_joints
from modelgen.dataset.inspection.channels import Channel, Inspected, inspect_record
from modelgen.dataset.objects import Record
from modelgen.dataset.processing.instants import EffortInstant
from modelgen.dataset.processing.prepare import Prepared
from modelgen.dataset.processing.settings import Chosen
from modelgen.dataset.recorded import Recorded

COARSE = 1e-3  # of a channel's range, from which on its resolution is worth a line
RESTING = 0.05  # of the samples, from which on those left out are worth a line
LINES = 6


@dataclass(frozen=True)
class RecordsInspected:
    """Facts of records that are used together.

    train, test: by record. cutoff: of effort and regressor [Hz], 0 without a filter. hold: "following",
    "previous", "instant", or the delay [s] of the effort's samples; None for free motions. repeats: rows of
    the log per new reading, the most. left_out: samples of the training records (n,) that stand for no
    equation of their joint: those at rest, and those that the filters trim. instant: what the data say of
    `hold`; None where they were not asked. joints: their names (n,).
    """

    train: tuple[Inspected, ...]
    test: tuple[Inspected, ...]
    cutoff: float
    hold: str | float | None
    repeats: float
    left_out: tuple[int, ...]
    joints: tuple[str, ...]
    instant: EffortInstant | None = None

    @property
    def samples(self) -> int:
        """Number of samples of the training records."""
        return sum(x.samples for x in self.train)

    @property
    def shares_left_out(self) -> list[float]:
        """Shares (n,) of the samples of the training records that stand for no equation of their joint."""
        return [count / max(self.samples, 1) for count in self.left_out]

    @property
    def resolution(self) -> dict[str, float]:
        """Finest step of the readings by channel, of those that have one, in the channel's unit."""
        found: dict[str, float] = {}
        for c in self._channels:
            if c.resolution is not None:
                found[c.name] = min(c.resolution, found.get(c.name, np.inf))
        return found

    @property
    def period(self) -> float | None:
        """Period [s] of the first training record that repeats itself."""
        return next((x.period for x in self.train if x.period is not None), None)

    def recorded(self) -> list[Recorded]:
        """What a page says of each record, in the order of use."""
        uses = (("train", self.train), ("test", self.test))
        return [Recorded(x.name, use, x.samples, x.rate, x.begins) for use, own in uses for x in own]

    @property
    def remarks(self) -> tuple[str, ...]:
        """Remarks on the records, each once."""
        return tuple(dict.fromkeys(remark for x in (*self.train, *self.test) for remark in x.remarks))

    def to_json(self) -> dict[str, Any]:
        """`log` of identification.json and diagnosis.json."""
        return {
            "hold": self.hold,
            "effort_instant": None if self.instant is None else self.instant.to_json(),
            "rate": _rounded(self.train[0].rate),
            "jitter": round(max(x.jitter for x in self.train), 6),
            "repeated_readings": _rounded(self.repeats),
            "period_s": None if self.period is None else _rounded(self.period),
            "cutoff_hz": _rounded(self.cutoff),
            "samples": self.samples,
            "samples_left_out": list(self.left_out),
            "resolution": {name: _rounded(step) for name, step in self.resolution.items()},
            "records": [
                {
                    "name": x.name,
                    "use": use,
                    "samples": x.samples,
                    "rate": _rounded(x.rate),
                    "jitter": round(x.jitter, 6),
                    "period_s": None if x.period is None else _rounded(x.period),
                }
                for use, records in (("train", self.train), ("test", self.test))
                for x in records
            ],
            "remarks": list(self.remarks),
        }

    def lines(self) -> list[str]:
        """What is worth saying of it."""
        return [*self._facts(), *self.remarks]

    def brief(self) -> tuple[list[str], list[str]]:
        """The same in six lines at most, and the remarks that these leave out."""
        said = self._facts()
        free = LINES - len(said)
        if len(self.remarks) <= free:
            return [*said, *self.remarks], []
        shown, left = self.remarks[: free - 1], self.remarks[free - 1 :]
        return [*said, *shown, f"{len(left)} more remarks: --verbose, or the report"], list(left)

    def _facts(self) -> list[str]:
        many = f"{len(self.train)} training records" if len(self.train) > 1 else "training record"
        period = "the motion does not repeat" if self.period is None else f"period {self.period:.6g} s"
        said = [f"{many}: {self.samples} samples at {self.train[0].rate:.6g} Hz, {period}"]
        if self.hold is not None and not any(f"hold: {self.hold}" in remark for remark in self.remarks):
            first = self.train[0]
            instant = self.instant or EffortInstant(self.hold, "", 1.0 / first.rate)
            said.append(instant.line())
        coarse = [_step(c) for c in self._channels if c.coarse(COARSE)]
        if coarse:
            said.append(f"coarse readings: {', '.join(dict.fromkeys(coarse))}")
        if max(self.shares_left_out, default=0.0) > RESTING:
            percent = [f"{100 * share:.0f} %" for share in self.shares_left_out]
            said.append(f"left out at rest and at the ends: {at_joints(self.joints, percent)}")
        return said

    @property
    def _channels(self) -> list[Channel]:
        return [c for x in self.train for c in x.channels]


def inspect_records(
    train: Sequence[Prepared],
    test: Sequence[Record],
    chosen: Chosen,
    periods: Sequence[float | None],
    samples: Sequence[int] | None = None,
    instant: EffortInstant | None = None,
) -> RecordsInspected:
    """Facts of the records. chosen: how they were processed. periods: samples in a period of each training
    record. samples: of each training record, where `train` holds the beginnings of streams. instant: when
    their efforts were read, where the data were asked.
    """
    first = train[0].record
    counts = [len(p.time) for p in train] if samples is None else samples
    fitted = tuple(
        inspect_record(p.record, lag, count) for p, lag, count in zip(train, periods, counts, strict=True)
    )
    used = np.zeros(first.n)
    for p, count in zip(train, counts, strict=True):
        used += p.moving.sum(axis=0) * p.settings.stride * (count / len(p.time))
    left = np.maximum(sum(counts) - used, 0.0)
    return RecordsInspected(
        train=fitted,
        test=tuple(inspect_record(r, None) for r in test),
        cutoff=chosen.cutoff,
        hold=None if first.input is None else first.effort_hold,
        repeats=max(p.record.repeats for p in train),
        left_out=tuple(int(x) for x in np.rint(left)),
        instant=instant,
        joints=tuple(first.joint_names),
    )


def _step(c: Channel) -> str:
    assert c.resolution is not None
    return f"{c.name} in steps of {c.resolution:.3g} {c.unit}, {(c.high - c.low) / c.resolution:.0f} of them"


def _rounded(value: float) -> float:
    return float(f"{value:.9g}")
