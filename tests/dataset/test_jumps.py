"""A position that jumps is found, said by `read_log`, and nothing is identified across it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from dataset_support import DRIVEN, columns, times, write_csv

import modelgen as mg
from modelgen.dataset import Stream
from modelgen.errors import InputError
from modelgen.identification.streamed import identify_streamed

Table = dict[str, np.ndarray]
T = times(20.0, 200.0)
PLACE = 1700  # t = 8.5 s


def anew(table: Table) -> None:
    """The encoder counts from zero again."""
    table["q1"][PLACE:] -= table["q1"][PLACE]


def slipped(table: Table) -> None:
    table["qm2"][PLACE:] += 900.0


def lost(table: Table) -> None:
    """Readings of zero for a tenth of a second."""
    table["q1"][PLACE : PLACE + 20] = 0.0


def frozen(table: Table) -> None:
    """The logger writes its last line again for half a second."""
    for values in table.values():
        if values is not table["t"]:
            values[PLACE - 99 : PLACE + 1] = values[PLACE - 99]


def turned(table: Table) -> None:
    """An encoder of a joint that counts 0 to 1 rad, again and again."""
    table["q1"] %= 1.0


def often(table: Table) -> None:
    """One reading in a hundred is zero."""
    table["q1"][np.random.default_rng(1).choice(len(T), len(T) // 100, replace=False)] = 0.0


@pytest.mark.parametrize("how", [anew, slipped, lost, frozen, turned, often])
def test_nothing_is_identified_across_a_jump(how: Callable[[Table], None], tmp_path: Path) -> None:
    table = columns(T)
    how(table)
    test = columns(T) | {"i1": np.cos(T), "q1": 0.5 * np.sin(T)}
    name = "qm2" if how is slipped else "q1"
    (said,) = (x for x in mg.read_log(table, DRIVEN).remarks if "jumps by" in x)
    assert said.startswith(f"{name} jumps by")
    if how in (anew, slipped, lost, frozen):
        where = PLACE if how is frozen else PLACE - 1
        assert f"after t = {T[where]:.9g} s" in said
    for asked in (mg.identify, mg.diagnose):
        with pytest.raises(InputError, match=f"{name} jumps by"):
            asked(DRIVEN, table, test)
        with pytest.raises(InputError, match=f"{name} jumps by"):
            asked(DRIVEN, test, table)
    file = write_csv(tmp_path / "a.csv", table)
    with pytest.raises(InputError, match=f"a.csv.*{name} jumps by"):
        identify_streamed([Stream(file, DRIVEN)], DRIVEN)


@pytest.mark.parametrize("seed", range(4))
def test_what_motions_and_their_readings_have_is_no_jump(seed: int) -> None:
    random = np.random.default_rng(seed)
    table, count = columns(T), len(T)
    quick = np.clip((T - 8.0) / 0.03, 0, 1)  # a stroke within six samples, of a joint that rests else
    joints = {
        "stroke": 0.3 + 0.5 * quick**2 * (3 - 2 * quick) + 1e-4 * random.normal(size=count),
        "coarse": 0.05 * np.rint(table["q1"] / 0.05),
        "noisy": table["q1"] + 0.02 * random.standard_t(5, count),
        "sticking": 0.04 * np.floor(T / 0.4 + 0.3 * random.uniform(size=count).cumsum() / 100),
        "late": table["q1"][
            np.maximum.accumulate(np.where(random.uniform(size=count) < 0.4, np.arange(count), 0))
        ],
    }
    for what, q in joints.items():
        assert not mg.read_log(table | {"q1": q}, DRIVEN).jump, what
    kept = np.sort(random.choice(count, int(0.97 * count), replace=False))
    fewer = {name: values[kept] for name, values in table.items()}
    assert not mg.read_log(fewer, DRIVEN).jump
