"""One call for jobs that do not depend on each other, wherever they run."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import TypeVar

from modelgen.jobs import cluster, local
from modelgen.jobs.where import Where

T = TypeVar("T")
R = TypeVar("R")


def run(
    function: Callable[[T], R],
    items: Sequence[T],
    where: Where,
    lost: Callable[[T], R] | None = None,
) -> Iterator[tuple[int, R]]:
    """Yields (place in `items`, function(item)) for every item, as they are done.

    function: of a module, so that other processes find it; a job must not depend on another one. An
    exception of a job ends all of them and is raised here. lost: the result of a job that has ended its
    process (memory, a crash), so that the others go on; every job then has a process that is not this one.
    The libraries of every process use one thread each. Raises InputError where the cluster cannot be
    reached, has no workers or loses them, and, without `lost`, where a process ends.
    """
    if where.dask is not None:
        yield from cluster.run(function, items, where.dask, lost)
    else:
        yield from local.run(function, items, where.count(len(items)), lost)
