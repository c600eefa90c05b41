"""Cross-validation: each part of the training records held out in its turn."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from modelgen.dataset import Chosen, Prepared, Record, prepare
from modelgen.errors import InputError
from modelgen.identification.objects import Identification, Validation
from modelgen.numeric import Array
from modelgen.regression.cross_validation import blocks

SHORTEST = 1.0  # s, of what lies between two held-out parts and is of use


@dataclass(frozen=True)
class Folds:
    """parts: what was held out, "t0 to t1 s" in every record, and the errors there.

    rmse, nrmse_percent: (n,) over all parts together, as of one record.
    """

    parts: tuple[tuple[str, Validation], ...]
    rmse: Array
    nrmse_percent: Array


def folds(
    records: Sequence[Record],
    count: int,
    chosen: Chosen,
    identified: Callable[[Sequence[Prepared], Sequence[Prepared]], Identification],
) -> Folds:
    """Each record in `count` parts of equal length; part k of all records is held out, the rest identified.

    identified: from (train, test) to an identification with its validation. Raises InputError where a part
    is too short.
    """
    found = []
    for k in range(count):
        train: list[Record] = []
        test: list[Record] = []
        for record in records:
            size = len(record.t)
            begin, end = blocks(size, count)[k]
            test.append(record.part(begin, end))
            train += [
                record.part(a, b) for a, b in ((0, begin), (end, size)) if (b - a) * record.step >= SHORTEST
            ]
        t = test[0].t
        validation = identified(_prepared(train, chosen), _prepared(test, chosen)).test
        assert validation is not None
        found.append((f"{t[0]:.4g} to {t[-1]:.4g} s", validation))
    left = sum(v.rows * v.rmse**2 for _, v in found)
    whole = sum(v.rows * (100.0 * v.rmse / v.nrmse_percent) ** 2 for _, v in found)
    rows = sum(v.rows for _, v in found)
    return Folds(tuple(found), np.sqrt(left / rows), 100.0 * np.sqrt(left / whole))


def _prepared(records: Sequence[Record], chosen: Chosen) -> list[Prepared]:
    try:
        return [prepare(record, chosen) for record in records]
    except InputError as error:
        raise InputError(f"--folds: a part is too short: {error}") from error
