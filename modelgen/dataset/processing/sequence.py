"""Which records run on from others: what a drive keeps, as its heat, it keeps from one to the next."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

from modelgen.dataset.processing.prepare import Prepared
from modelgen.dataset.reading.specs import parse


def in_sequence(prepared: Sequence[Prepared]) -> list[Prepared]:
    """The same records, each with the one that it runs on from.

    One runs on from another of the same clock that ended at most `max_pause` before, and the arm stood still
    between: parts of one log, or logs of their own whose stamps go on where the other's end.
    """
    found = list(prepared)
    for k in sorted(range(len(found)), key=lambda k: float(found[k].time[0])):
        own = found[k]
        earlier = [p for p in found if _follows(own, p)]
        if earlier:
            found[k] = replace(own, before=max(earlier, key=lambda p: float(p.time[-1])))
    return found


def _follows(later: Prepared, earlier: Prepared) -> bool:
    part, other = (parse(p.record.name) for p in (later, earlier))
    cut = any(math.isfinite(x) for spec in (part, other) for x in (spec.begin, spec.end))
    one_clock = part.path == other.path if cut else part.path != other.path
    most = later.settings.thresholds.max_pause
    return one_clock and 0.0 < float(later.time[0] - earlier.time[-1]) <= most
