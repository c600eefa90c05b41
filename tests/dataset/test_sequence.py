"""Records that run on from others: by the stamps of whole logs, or as parts of one."""

from __future__ import annotations

from pathlib import Path

import pytest
from dataset_support import DRIVEN, columns, times, write_csv

from modelgen.dataset import prepare, read
from modelgen.dataset.processing.sequence import in_sequence
from modelgen.dataset.thresholds import USUAL

LENGTH, RATE, PAUSE = 8.0, 100.0, USUAL.max_pause


def log(folder: Path, name: str, begin: float) -> str:
    t = times(LENGTH, RATE)
    return str(write_csv(folder / name, columns(t) | {"t": t + begin}))


def names_before(logs: list[str]) -> list[str | None]:
    found = in_sequence([prepare(read(x, DRIVEN)) for x in logs])
    return [None if p.before is None else p.before.record.name.rpartition("/")[2] for p in found]


@pytest.mark.parametrize(
    ("begin", "follows"),
    [(LENGTH, True), (LENGTH + 0.9 * PAUSE, True), (LENGTH + 1.1 * PAUSE, False), (0.0, False), (4.0, False)],
)
def test_stamps_that_go_on_where_another_log_ends_run_on(tmp_path: Path, begin: float, follows: bool) -> None:
    logs = [log(tmp_path, "a.csv", 0.0), log(tmp_path, "b.csv", begin)]
    assert names_before(logs) == [None, "a.csv" if follows else None]
    assert names_before(logs[::-1]) == ["a.csv" if follows else None, None]  # whatever their order


def test_each_runs_on_from_the_last_before_it(tmp_path: Path) -> None:
    logs = [log(tmp_path, f"{k}.csv", k * LENGTH) for k in range(3)]
    assert names_before(logs) == [None, "0.csv", "1.csv"]
    (_, _, last) = in_sequence([prepare(read(x, DRIVEN)) for x in logs])
    assert last.before is not None
    assert last.before.before is not None  # as does the one before


def test_parts_of_one_log_run_on_and_those_of_two_do_not(tmp_path: Path) -> None:
    one, other = log(tmp_path, "a.csv", 0.0), log(tmp_path, "b.csv", 0.0)
    assert names_before([f"{one}@0:4", f"{one}@4:8"]) == [None, "a.csv@0:4"]
    assert names_before([f"{one}@0:4", f"{other}@4:8"]) == [None, None]
