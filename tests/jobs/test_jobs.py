"""Jobs here and on a Dask cluster: the same results, and what happens where a process or a cluster ends."""

import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import jobs_support
import pytest
from command_support import called
from jobs_support import cluster, deadly, lost, process, refused, square

from modelgen.errors import InputError
from modelgen.jobs import Where, run

pytestmark = pytest.mark.xdist_group("dask")
SQUARES = {k: k * k for k in range(8)}
EXCITE = ("excite", "--arm", "gravity_link1", "--velocity", "3", "--period", "10", "--starts", "3")
EXCITE += ("--iterations", "10", "--out", "t.csv")


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    with cluster(tmp_path_factory.mktemp("cluster")) as found:
        yield found


# A scheduler that is there answers at once.
IMPATIENT = "import modelgen.jobs.cluster as c; c.CONNECT = 1.0; from modelgen.cli import main; main()"


def impatient(folder: Path, *more: str) -> subprocess.CompletedProcess[str]:
    """The command in a process of its own, all that any library prints included."""
    environment = {**os.environ, "PYTHONPATH": str(Path(__file__).resolve().parents[2])}
    return subprocess.run(
        [sys.executable, "-c", IMPATIENT, *EXCITE, *more],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
        timeout=100,
    )


def one_line(answer: subprocess.CompletedProcess[str]) -> str:
    """The message of bad input, after the checks that every one of them must pass."""
    assert answer.returncode == 2, answer.stderr
    assert answer.stdout == ""
    assert len(answer.stderr.splitlines()) == 1, answer.stderr
    return answer.stderr


@pytest.mark.parametrize("processes", [1, 2, 5])
def test_every_job_is_done_once_in_any_number_of_processes(processes: int) -> None:
    found = list(run(square, range(8), Where(processes)))
    assert len(found) == 8
    assert dict(found) == SQUARES


@pytest.mark.parametrize("processes", [1, 2])
def test_a_job_that_ends_its_process_ends_no_other(processes: int) -> None:
    found = list(run(deadly, range(8), Where(processes), lost))
    assert len(found) == 8
    assert dict(found) == {**SQUARES, jobs_support.DEADLY: -jobs_support.DEADLY}


def test_a_job_that_ends_its_process_is_named_where_nothing_stands_for_it() -> None:
    with pytest.raises(InputError, match=r"out of memory.*--jobs 1"):
        list(run(deadly, range(8), Where(2)))


@pytest.mark.parametrize("processes", [1, 2])
def test_a_mistake_of_a_job_is_not_hidden(processes: int) -> None:
    with pytest.raises(ValueError, match="no 0"):
        list(run(refused, [0], Where(processes), lost))


def test_processes_do_not_fight_for_processors() -> None:
    found = [process for _, process in run(process, range(4), Where(2), lost)]
    assert {threads for _, threads in found} == {"1"}
    assert os.getpid() not in {number for number, _ in found}


def test_a_cluster_does_the_same_on_all_its_workers(address: str) -> None:
    assert dict(run(square, range(8), Where(dask=address))) == SQUARES
    found = [process for _, process in run(process, range(8), Where(dask=address))]
    assert len({number for number, _ in found}) == 2
    assert {threads for _, threads in found} == {"1"}


def test_a_job_that_ends_every_worker_it_gets_ends_no_other(address: str) -> None:
    found = dict(run(deadly, range(8), Where(dask=address), lost))
    assert found == {**SQUARES, jobs_support.DEADLY: -jobs_support.DEADLY}


def test_a_job_that_waits_behind_it_is_not_blamed(tmp_path: Path) -> None:
    """The end of a worker counts against all jobs that it had been given; here once is too often."""
    with cluster(tmp_path, workers=1, failures=0) as address:
        found = dict(run(deadly, range(8), Where(dask=address), lost))
    assert found == {**SQUARES, jobs_support.DEADLY: -jobs_support.DEADLY}


def test_a_trajectory_is_the_same_in_one_process_two_and_on_a_cluster(address: str, tmp_path: Path) -> None:
    files = {}
    for name, where in {"one": ["-j", "1"], "two": ["-j", "2"], "dask": ["--dask", address]}.items():
        folder = tmp_path / name
        folder.mkdir()
        answer = called(*EXCITE, *where, cwd=folder)
        assert answer.returncode == 0, answer.stderr
        files[name] = {file.name: file.read_bytes() for file in folder.iterdir()}
    assert len(files["one"]) == 5
    assert files["one"] == files["two"] == files["dask"]


def test_an_address_where_nothing_answers(tmp_path: Path) -> None:
    answer = one_line(impatient(tmp_path, "--dask", "tcp://127.0.0.1:1"))
    assert "--dask tcp://127.0.0.1:1: no scheduler answers there" in answer
    assert "dask scheduler" in answer
    assert not list(tmp_path.iterdir())


def test_an_address_that_is_none() -> None:
    with pytest.raises(InputError, match="--dask: found 'mars', expected an address such as tcp://"):
        list(run(square, range(2), Where(dask="mars")))


def test_a_scheduler_without_workers(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("modelgen.jobs.cluster.WORKERS", 0.3)
    with cluster(tmp_path, workers=0) as address, pytest.raises(InputError, match="has no workers"):
        list(run(square, range(2), Where(dask=address)))


def test_a_cluster_that_goes_away(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("modelgen.jobs.cluster.WORKERS", 4.0)
    with cluster(tmp_path) as address:
        jobs = run(process, range(400), Where(dask=address))
        next(jobs)
    with pytest.raises(InputError, match="has gone while jobs were running"):
        list(jobs)


def test_without_the_library(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(InputError, match=r"--dask needs distributed: pip install 'dask\[distributed\]>="):
        list(run(square, range(2), Where(dask="tcp://127.0.0.1:8786")))
