"""The records of a command: training and test logs, read, checked against each other."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from modelgen.dataset.objects import Record
from modelgen.dataset.processing.content import noise_alone
from modelgen.dataset.reading.column_table import Log
from modelgen.dataset.reading.read import read
from modelgen.dataset.reading.specs import check_separate
from modelgen.dataset.thresholds import USUAL, DatasetThresholds
from modelgen.description import Arm
from modelgen.errors import InputError


def gather(
    train: Sequence[Log],
    test: Sequence[Log],
    arm: Arm,
    mapping: Path | str | None = None,
    thresholds: DatasetThresholds = USUAL,
) -> tuple[list[Record], list[Record]]:
    """Training and test records of `--train`, `--test`, `--mapping`.

    Raises InputError as `read` and `check_separate` do, and where a test record holds samples of a training
    record under another name.
    """
    check_separate(train, test)
    training = several(train, arm, mapping, thresholds)
    testing = [read(spec, arm, mapping, thresholds) for spec in test]
    for record in testing:
        for other in training:
            check_different(other, record, thresholds)
    return training, testing


def several(
    logs: Sequence[Log],
    arm: Arm,
    mapping: Path | str | None = None,
    thresholds: DatasetThresholds = USUAL,
) -> list[Record]:
    """Records of one purpose: in some of them a joint may stand throughout, not in all. Raises InputError."""
    found = [read(spec, arm, mapping, thresholds, still=len(logs) > 1) for spec in logs]
    still = [(np.ptp(r.q, axis=0) == 0.0) | noise_alone(r.q) for r in found if len(r.t)]
    for k in np.flatnonzero(np.all(still, axis=0)) if still else ():
        name, q = arm.joints[arm.coordinates[k]].name, found[0].q[:, k]
        noise = f", but for noise of {q.std():.2g}," if np.ptp(q) else ""
        raise InputError(
            f"{found[0].name}: joint {name} stands at {q.mean():.6g}{noise} in all samples of all records, "
            "expected a motion in one of them; where it was held, lock it in the description, "
            f"locked: {{{name}: ...}}"
        )
    return found


def check_different(train: Record, test: Record, limits: DatasetThresholds = USUAL) -> None:
    """No `max_shared_samples` consecutive samples of a motion in both. Raises InputError.

    Measured samples do not repeat to the last digit: such runs are copies, whatever the files are called.
    """
    seen = {row.tobytes() for row in _rows(train)}
    rows = _rows(test)
    shared = np.array([row.tobytes() in seen for row in rows], dtype=bool)
    # At rest, quantised samples do repeat.
    moving = np.any(np.diff(test.q, axis=0, prepend=test.q[:1]) != 0.0, axis=1)
    counts = np.cumsum(np.concatenate([[0], shared & moving]))
    run = limits.max_shared_samples
    if len(counts) > run and np.any(counts[run:] - counts[:-run] == run):
        first = int(np.argmax(counts[run:] - counts[:-run] == run))
        raise InputError(
            f"--train {train.name} and --test {test.name} share samples: those after "
            f"t = {test.t[first]:.6g} s "
            "of the test record are in the training record too; a test record must be another measurement"
        )


def _rows(record: Record) -> np.ndarray:
    """Samples (N, k), without their stamps: a copy may start anew."""
    columns = [record.q] if record.input is None else [record.q, record.input]
    return np.ascontiguousarray(np.hstack(columns))
