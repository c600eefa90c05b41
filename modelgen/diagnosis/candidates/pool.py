"""All candidates tried at once, on all processors."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from modelgen.diagnosis.candidates.candidate import Candidate, at_links
from modelgen.diagnosis.candidates.fitted import FittedCandidate
from modelgen.diagnosis.candidates.search import Columns, Search
from modelgen.jobs import Where, forked


def fit_pool(
    pool: Sequence[Candidate],
    search: Search,
    where: Where,
    report: Callable[[int, int], None] | None = None,
) -> list[FittedCandidate | None]:
    """The best that each candidate can do, as `Search.trial`, in the order of the pool.

    Candidates that share columns are one job, so that the answer does not depend on the number of processors.
    """
    groups: dict[object, list[int]] = {}
    for k, candidate in enumerate(pool):
        # behind a link's own position play is tried where an elastic joint was
        both = candidate.elastic and at_links(candidate.joint, search.rows)
        groups.setdefault(candidate.joint if both else candidate.place, []).append(k)
    # what takes longest first: no processor waits for it at the end
    jobs = sorted(groups.values(), key=lambda places: not pool[places[0]].elastic)

    def job(number: int) -> tuple[list[FittedCandidate | None], Columns]:
        before = set(search.renewed)
        found = [search.trial(pool[k]) for k in jobs[number]]
        return found, {key: search.known[key] for key in search.renewed - before}

    def told(number: int) -> None:
        if report is not None:
            report(sum(map(len, jobs[:number])), len(pool))

    result: list[FittedCandidate | None] = [None] * len(pool)
    for places, (found, columns) in zip(jobs, forked(job, len(jobs), where, told), strict=True):
        search.learn(columns)
        for k, trial in zip(places, found, strict=True):
            result[k] = trial
    return result
