"""Jobs in forks: every one once, in order, whatever becomes of the forks."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from modelgen.jobs import Where, forked

COUNT = 300  # more than a byte counts


@pytest.mark.parametrize("processes", [1, 2, 5])
def test_every_job_is_done_once_and_answers_come_in_order(tmp_path: Path, processes: int) -> None:
    notes = tmp_path / "done"

    def job(k: int) -> tuple[int, int]:
        with notes.open("a") as file:
            file.write(f"{k}\n")
        return k * k, os.getpid()

    answers = forked(job, COUNT, Where(processes))
    assert [square for square, _ in answers] == [k * k for k in range(COUNT)]
    assert sorted(map(int, notes.read_text().split())) == list(range(COUNT))
    assert len({process for _, process in answers}) <= processes


@pytest.mark.skipif(sys.platform != "linux", reason="no forks are made here")
def test_forks_take_part() -> None:
    here = os.getpid()
    meeting, other = os.pipe()

    def job(k: int) -> int:
        # one waits for the other: a single process would not come to an end
        if k == 0:
            os.read(meeting, 1)
        else:
            os.write(other, b"x")
        return os.getpid()

    assert len({here, *forked(job, 2, Where(2))}) == 2


def test_what_a_killed_fork_had_taken_is_done_here() -> None:
    here = os.getpid()

    def job(k: int) -> int:
        if os.getpid() != here:
            os.kill(os.getpid(), signal.SIGKILL)
        return -k

    assert forked(job, 20, Where(4)) == [-k for k in range(20)]


def test_an_error_of_a_job_is_raised_wherever_it_met_it() -> None:
    def job(k: int) -> int:
        if k == 7:
            raise ValueError("seven")
        return k

    with pytest.raises(ValueError, match="seven"):
        forked(job, 20, Where(3))


def test_answers_that_cannot_be_sent_are_found_here() -> None:
    answers = forked(lambda k: lambda: k, 6, Where(2))
    assert [answer() for answer in answers] == list(range(6))


def test_each_job_that_starts_here_is_told() -> None:
    told: list[int] = []
    forked(lambda k: k, 9, Where(1), told.append)
    assert told == list(range(9))


THREADS = """
import numpy.linalg
from threadpoolctl import threadpool_info
from modelgen.jobs import Where, forked

def most(_):
    return max(library["num_threads"] for library in threadpool_info())

print(most(0), *forked(most, 4, Where(2)), most(0))
"""


@pytest.mark.skipif(sys.platform != "linux" or os.cpu_count() == 1, reason="nothing has several threads")
def test_linear_algebra_in_forks_keeps_to_one_thread_and_has_its_own_again_after() -> None:
    environment = {name: value for name, value in os.environ.items() if not name.endswith("_NUM_THREADS")}
    environment["OPENBLAS_NUM_THREADS"] = environment["MKL_NUM_THREADS"] = "2"
    told = subprocess.check_output([sys.executable, "-c", THREADS], text=True, env=environment)
    before, *during, after = (int(text) for text in told.split())
    assert during == [1] * 4
    assert before == after > 1
