"""Jobs in forks of this process: they see all that it has, and only their answers are sent."""

from __future__ import annotations

import os
import pickle
import sys
import warnings
from collections.abc import Callable
from contextlib import suppress
from multiprocessing import get_context
from multiprocessing.connection import Connection
from typing import Any, TypeVar

from modelgen.jobs.local import ignore_interrupt
from modelgen.jobs.threads import one_thread
from modelgen.jobs.where import Where

T = TypeVar("T")
BYTES = 2  # of the number of a job
MOST = 2000  # jobs whose numbers a pipe holds


def forked(
    job: Callable[[int], T], count: int, where: Where, called: Callable[[int], None] | None = None
) -> list[T]:
    """Results of job(0) to job(count - 1), in order, by this process and forks on the other processors.

    Whoever is free takes the next one. Jobs must not depend on another one. What a fork did not answer,
    because it was killed say, is done here. called: with the number of every job that starts here.
    Linear algebra has one thread in each.
    Where there are no forks, or these are not safe (macOS, Windows), all is done here.
    """
    forks = where.count(count) - 1 if sys.platform == "linux" and count <= MOST else 0
    if forks < 1:
        return [_called(job, k, called) for k in range(count)]
    with one_thread():
        found = _together(job, count, forks, called)
    return [found[k] if k in found else _called(job, k, called) for k in range(count)]


def _together(
    job: Callable[[int], T], count: int, forks: int, called: Callable[[int], None] | None
) -> dict[int, T]:
    """Answers of this process and of that many forks."""
    numbers, end = os.pipe()
    os.write(end, b"".join(k.to_bytes(BYTES, "big") for k in range(count)))
    os.close(end)
    helpers = []
    try:
        for _ in range(forks):
            with suppress(OSError):  # no process to be had: as without one
                helpers.append(_started(job, numbers))
        found = _answers(numbers, lambda k: _called(job, k, called))
        for _, answers in helpers:
            with suppress(EOFError, OSError, pickle.UnpicklingError):
                found.update(answers.recv())
    finally:
        os.close(numbers)
        for process, answers in helpers:
            answers.close()
            process.kill()
            process.join()
    return found


def _started(job: Callable[[int], Any], numbers: int) -> tuple[Any, Connection]:
    context = get_context("fork")
    here, there = context.Pipe(duplex=False)
    process = context.Process(target=_help, args=(job, numbers, there), daemon=True)
    with warnings.catch_warnings():
        # Threads whose locks a fork would inherit draw progress bars and wait for pictures; it does neither.
        warnings.simplefilter("ignore", DeprecationWarning)
        process.start()
    there.close()
    return process, here


def _help(job: Callable[[int], Any], numbers: int, answers: Connection) -> None:
    """Work of a fork. It leaves an error to the process that asked, which meets it again."""
    ignore_interrupt()
    found: dict[int, Any] = {}
    with suppress(Exception):
        _answers(numbers, job, found)
    with suppress(Exception):
        answers.send(found)
    os._exit(0)  # nothing of the parent's is to be flushed or closed here


def _answers(numbers: int, job: Callable[[int], T], found: dict[int, T] | None = None) -> dict[int, T]:
    """Answers of the jobs whose numbers this process took from the pipe."""
    found = {} if found is None else found
    while taken := os.read(numbers, BYTES):
        number = int.from_bytes(taken, "big")
        found[number] = job(number)
    return found


def _called(job: Callable[[int], T], k: int, called: Callable[[int], None] | None) -> T:
    if called is not None:
        called(k)
    return job(k)
