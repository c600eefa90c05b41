"""When Python looks for cycles among the objects of a process: a third of a short command's time."""

from __future__ import annotations

import gc

# New objects between two searches, and such searches between two of older objects. Imports and models make
# some 100 000 objects that stay; with Python's own 700, 10, 10 they are looked through again and again.
THRESHOLDS = (100_000, 5, 2)


def collect_rarely() -> None:
    """For the process of a command, from its begin on."""
    gc.set_threshold(*THRESHOLDS)


def collect_no_more() -> None:
    """At the end of such a process: what is in a cycle then goes with it, without a last search."""
    gc.freeze()
