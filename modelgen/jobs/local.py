"""Jobs in processes of this machine, by joblib."""

from __future__ import annotations

import multiprocessing
import os
import signal
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from typing import TypeVar

from joblib import Parallel, delayed, parallel_config
from joblib.externals.loky.process_executor import TerminatedWorkerError

from modelgen.errors import InputError

T = TypeVar("T")
R = TypeVar("R")

ONE_THREAD = dict.fromkeys(
    ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "VECLIB_MAXIMUM_THREADS"), "1"
)


def run(
    function: Callable[[T], R], items: Sequence[T], processes: int, lost: Callable[[T], R] | None
) -> Iterator[tuple[int, R]]:
    """Run jobs as modelgen.jobs.run does, with that many processes."""
    waiting = list(range(len(items)))
    if processes == 1 and lost is None:
        for k in waiting:
            yield k, function(items[k])
        return
    while waiting:
        if processes == 1:
            assert lost is not None
            yield from _alone(function, items, waiting, lost)
            return
        try:
            for k, result in _together(function, items, waiting, processes):
                waiting.remove(k)
                yield k, result
        except TerminatedWorkerError:
            if lost is None:
                raise InputError(
                    "a process of the jobs was ended from outside or ran out of memory; fewer at once need "
                    f"less: --jobs {max(1, processes // 2)}"
                ) from None
            # Jobs are handed out in their order: what ended the process is among the first ones waiting.
            suspects = waiting[: 2 * processes]
            waiting = waiting[2 * processes :]
            yield from _alone(function, items, suspects, lost)


def _together(
    function: Callable[[T], R], items: Sequence[T], places: Sequence[int], processes: int
) -> Iterator[tuple[int, R]]:
    with parallel_config("loky", inner_max_num_threads=1):
        pool = Parallel(
            n_jobs=processes, return_as="generator_unordered", batch_size=1, pre_dispatch="2*n_jobs"
        )
        yield from pool(delayed(_placed)(function, k, items[k]) for k in list(places))


def _placed(function: Callable[[T], R], place: int, item: T) -> tuple[int, R]:
    return place, function(item)


def _alone(
    function: Callable[[T], R], items: Sequence[T], places: Sequence[int], lost: Callable[[T], R]
) -> Iterator[tuple[int, R]]:
    """One after the other in one process, a new one after each that a job has ended."""
    # Not forked: a fork would inherit the locks of this process' threads.
    context = multiprocessing.get_context("spawn")
    pool = None
    try:
        for k in places:
            pool = pool or ProcessPoolExecutor(1, mp_context=context, initializer=ignore_interrupt)
            try:
                # The libraries read it when they are loaded, before any function of the process is called.
                with _environment(ONE_THREAD):
                    job = pool.submit(function, items[k])
                result = job.result()
            except BrokenProcessPool:
                pool.shutdown()
                pool, result = None, lost(items[k])
            yield k, result
    finally:
        if pool is not None:
            pool.shutdown(wait=False, cancel_futures=True)


def ignore_interrupt() -> None:
    """Ctrl-C reaches the whole group; the parent process answers for all."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)


@contextmanager
def _environment(values: dict[str, str]) -> Iterator[None]:
    before = {name: os.environ.get(name) for name in values}
    os.environ.update(values)
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value
