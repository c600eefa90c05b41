"""What is remembered, and for how long."""

import pickle

import numpy as np

from modelgen.evaluation import Motion
from modelgen.evaluation.cache import Recent


def test_the_last_ones_are_remembered_and_no_more() -> None:
    made: list[str] = []
    recent: Recent[int] = Recent(2)

    def get(key: str) -> int:
        return recent(key, lambda: made.append(key) or len(made))  # type: ignore[func-returns-value]

    assert [get(key) for key in "abab"] == [1, 2, 1, 2]
    get("c")
    assert get("b") == 2
    assert get("a") == 4
    assert made == ["a", "b", "c", "a"]


def test_motions_are_told_apart_and_kept_while_they_are_keys() -> None:
    """Of a motion that is forgotten, another one may take the place in memory."""
    recent: Recent[float] = Recent(1000)
    for k in range(200):
        motion = Motion(np.arange(3.0), *(np.full((3, 1), float(k)) for _ in range(3)))
        found = recent.along("mean", motion, np.zeros(2), lambda m=motion: float(m.q.mean()))  # type: ignore[misc]
        assert found == k
        del motion


def test_it_can_be_sent_to_another_process() -> None:
    recent: Recent[float] = Recent(3)
    recent("a", lambda: 1.0)
    assert pickle.loads(pickle.dumps(recent))("a", lambda: 2.0) == 1.0
