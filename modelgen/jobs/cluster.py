"""Jobs on a Dask cluster."""

from __future__ import annotations

import importlib
import logging
import re
import threading
from collections.abc import Callable, Iterator, Sequence
from typing import Any, TypeVar

from modelgen.errors import InputError
from modelgen.extras import missing as missing_library

T = TypeVar("T")
R = TypeVar("R")

CONNECT = 10.0  # s until the scheduler must have answered
WORKERS = 20.0  # s until the scheduler must have a worker
LOOK = 2.0  # s between looks at whether the cluster still lives

_ADDRESS = re.compile(r"([a-z]+://)?[A-Za-z0-9._-]+:[0-9]+|[a-z]+://\[[0-9a-fA-F:]+\]:[0-9]+")

# What jobs use is not made for two threads of one process: a worker with several takes turns.
_turn = threading.Lock()


def run(
    function: Callable[[T], R], items: Sequence[T], address: str, lost: Callable[[T], R] | None
) -> Iterator[tuple[int, R]]:
    """Run jobs as modelgen.jobs.run does, on the workers of the scheduler at `address`."""
    distributed = _library()
    # It reports every worker that is lost; what that means for the jobs is said here.
    logging.getLogger("distributed.client").setLevel(logging.CRITICAL)
    client = _connected(distributed, address)
    try:
        _check_workers(client, address)
        suspects = []
        for k, future in _submitted(distributed, client, function, items, range(len(items)), address):
            try:
                result = _result(distributed, future, address)
            except distributed.scheduler.KilledWorker:
                if lost is None:
                    raise InputError(
                        f"--dask {address}: a job has ended every worker that had it (memory?)"
                    ) from None
                suspects.append(k)
                continue
            yield k, result
        # The end of a worker counts against every job that it had been given: alone, each answers for itself.
        for k in suspects:
            ((_, future),) = _submitted(distributed, client, function, items, [k], address)
            try:
                result = _result(distributed, future, address)
            except distributed.scheduler.KilledWorker:
                assert lost is not None
                result = lost(items[k])
            yield k, result
    finally:
        # Closing cancels what has not been done.
        client.close(timeout=CONNECT)


def _library() -> Any:
    try:
        return importlib.import_module("distributed")
    except ImportError:
        raise missing_library("--dask needs", "distributed") from None


def _connected(distributed: Any, address: str) -> Any:
    example = "expected an address such as tcp://127.0.0.1:8786"
    if not _ADDRESS.fullmatch(address):
        raise InputError(f"--dask: found '{address}', {example}")
    try:
        return distributed.Client(address, timeout=CONNECT)
    except (OSError, ValueError, TimeoutError):
        raise InputError(
            f"--dask {address}: no scheduler answers there, {example}; `dask scheduler` starts one and "
            "prints its own, `dask worker ADDRESS` gives it a worker"
        ) from None


def _check_workers(client: Any, address: str) -> None:
    try:
        client.wait_for_workers(1, timeout=WORKERS)
    except TimeoutError:
        raise InputError(
            f"--dask {address}: the scheduler has no workers; `dask worker {address}` starts one"
        ) from None
    try:
        client.submit(_in_turn, _ready, None, pure=False).result()
    except ImportError as error:
        raise InputError(f"--dask {address}: the workers lack a package: {error}; install modelgen") from None


def _submitted(
    distributed: Any,
    client: Any,
    function: Callable[[T], R],
    items: Sequence[T],
    places: Sequence[int],
    address: str,
) -> Iterator[tuple[int, Any]]:
    """Places and their futures, as they end."""
    futures = {client.submit(_in_turn, function, items[k], pure=False): k for k in places}
    while futures:
        for future in _done(distributed, client, futures, address):
            yield futures.pop(future), future


def _done(distributed: Any, client: Any, futures: dict[Any, int], address: str) -> list[Any]:
    """Futures that have ended, in the order of their items. Raises InputError where the cluster is gone."""
    missing = 0.0
    while True:
        try:
            ended = distributed.wait(list(futures), timeout=LOOK, return_when="FIRST_COMPLETED").done
            return sorted(ended, key=lambda future: futures[future])
        except TimeoutError:
            alive = client.status == "running" and bool(client.ncores())
            missing = 0.0 if alive else missing + LOOK
        except distributed.CancelledError:
            raise _gone(address) from None
        if missing >= WORKERS:
            raise _gone(address)


def _result(distributed: Any, future: Any, address: str) -> Any:
    try:
        return future.result()
    except (distributed.CancelledError, distributed.comm.CommClosedError):
        raise _gone(address) from None


def _gone(address: str) -> InputError:
    return InputError(
        f"--dask {address}: the cluster has gone while jobs were running; what was finished is kept, "
        "call again when it is there"
    )


def _in_turn(function: Callable[[T], R], item: T) -> R:
    with _turn:
        return function(item)


def _ready(_: None) -> None:
    """First job on a worker, after which it has loaded modelgen."""
