"""What depends on another joint, or on what was before, is no law of the joint's own position and speed."""

from dataclasses import fields, replace
from typing import Any

import numpy as np
import pytest
from diagnosis_support import ARM, three
from numpy.typing import NDArray
from scipy.signal import lfilter

from modelgen.dataset import Record
from modelgen.diagnosis.adequacy.motion_functions import hysteresis
from modelgen.diagnosis.pipeline import diagnose

STEP = 0.004  # s
TAU = 0.3  # s, of a spring and a dashpot in line
Law = Any


def once(record: Record, seconds: float = 9.6) -> Record:
    """The record's begin, in which nothing repeats."""
    n, count = len(record.q), round(seconds / STEP)
    given = {f.name: getattr(record, f.name) for f in fields(record)}
    cut = {k: x[:count] for k, x in given.items() if isinstance(x, np.ndarray) and len(x) == n}
    return replace(record, **cut)


def with_force(records: list[Record], joint: int, law: Law, share: float) -> list[Record]:
    """Records with a force at the joint besides, that is a share of its current."""
    found = []
    for r in records:
        given = np.asarray(r.input).copy()
        force = law(r.q, np.gradient(r.q, STEP, axis=0), joint - 1)
        given[:, joint - 1] += share * np.std(given[:, joint - 1]) / np.std(force) * force
        found.append(replace(r, input=given))
    return found


def remembered(q: NDArray[Any], dq: NDArray[Any], j: int) -> NDArray[Any]:
    """A spring and a dashpot in line."""
    kept = np.exp(-STEP / TAU)
    return np.asarray(lfilter([1.0 - kept], [1.0, -kept], dq[:, j]))


def of_another(q: NDArray[Any], dq: NDArray[Any], j: int) -> NDArray[Any]:
    """A wave over the place, driven by the other joint's speed."""
    return np.asarray(np.sin(3.0 * q[:, j] + 1.0) * np.tanh(3.0 * dq[:, 1 - j]))


def slipping(q: NDArray[Any], dq: NDArray[Any], j: int) -> NDArray[Any]:
    """Two springs that slip, one after a twentieth and one after a third of the range, stiffer at one end."""
    path, force = q[:, j], np.zeros(len(q))
    for width in (0.05 * np.ptp(path), 0.35 * np.ptp(path)):
        stretch = 0.0
        for k in range(1, len(path)):
            stretch = float(np.clip(stretch + path[k] - path[k - 1], -width, width))
            force[k] += stretch / width
    return np.asarray(force * (1.0 + 0.8 * np.sin(2.0 * path)))


@pytest.mark.parametrize(("law", "share"), [(remembered, 0.3), (of_another, 0.3), (slipping, 0.12)])
@pytest.mark.parametrize("joint", [1, 2])
def test_what_no_law_of_the_catalogue_depends_on_lends_no_name_where_nothing_repeats(
    law: Law, share: float, joint: int
) -> None:
    records = with_force([once(r) for r in three(None, 1, 0.0, seed=21)], joint, law, share)
    found = diagnose(ARM, records, experiment=False)
    assert not found.causes, [(c.effect, c.joint) for c in found.causes]


def test_a_spring_that_slips_follows_its_way_and_not_its_pace() -> None:
    """A spring of width 0.2 that is carried to and fro over 1.0, at two paces."""
    way = np.concatenate([np.linspace(0, 1, 500), np.linspace(1, 0, 300)[1:], np.linspace(0, 1, 700)[1:]])
    (force,) = hysteresis(way, np.array([0.2]))
    at = {round(x, 3): force[k, 0] for k, x in enumerate(way[:500])}
    assert at[0.1] == pytest.approx(0.5, abs=0.01)  # stretches
    assert force[400, 0] == 1.0  # slips
    back = np.flatnonzero(np.isclose(way, 0.8, atol=1e-3) & (np.arange(len(way)) > 500))[0]
    assert force[back, 0] == pytest.approx(0.0, abs=0.02)  # 0.2 from the turn
    assert force[790, 0] == -1.0
    slow, quick = np.unique(way[799:], return_index=True)[1], np.unique(way[:500], return_index=True)[1]
    again = np.interp(0.6, way[799:][slow], force[799:, 0][slow])
    assert again == pytest.approx(np.interp(0.6, way[:500][quick], force[:500, 0][quick]), abs=1e-9)
