"""ROS 1 and 2 bags and MCAP files, without ROS (extra `logs`: rosbags, mcap)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from modelgen.dataset.objects import Wanted
from modelgen.dataset.reading.bag_messages import Messages, messages_of
from modelgen.dataset.reading.messages import columns_of, labels, number_at
from modelgen.dataset.reading.specs import unreadable
from modelgen.dataset.reading.turns import joined
from modelgen.errors import InputError
from modelgen.extras import missing
from modelgen.numeric import Array

ROWS = 4096  # messages gathered at a time
PEEK = 200  # messages of a topic that its columns are taken from
LOG_TIME = "log_time"


class BagReader:
    """A bag whose columns are `topic.field`.

    Where columns are of several topics, these are held in memory, and joined at common instants. Raises
    InputError where the file cannot be read or a library is missing.
    """

    by_column = False

    def __init__(self, path: Path) -> None:
        self.path = path
        if not path.exists():
            raise unreadable(path, FileNotFoundError())
        self._found: dict[str, None] = {}
        self._start: int | None = None
        self._topics = self._scanned()
        if not self._topics:
            raise InputError(f"{path}: the bag holds no message that can be read")
        self.names = tuple(f"{topic}.{name}" for topic, columns in self._topics.items() for name in columns)

    @property
    def origins(self) -> dict[str, float]:
        """What the columns of instants at which messages were recorded count from [s since 1970, UTC]."""
        return {f"{topic}.{LOG_TIME}": 1e-9 * (self._start or 0) for topic in self._topics}

    @property
    def remarks(self) -> tuple[str, ...]:
        """What was found out about the file, and left out."""
        return tuple(self._found)

    def _scanned(self) -> dict[str, tuple[str, ...]]:
        """Columns by topic, of all publishers: from a topic's first messages, from all that name elements."""
        found: dict[str, dict[str, None]] = {}
        seen: dict[str, int] = {}
        publishers: dict[str, set[tuple[str, ...]]] = {}
        with self._messages() as messages:
            for topic, time, decoded in messages:
                self._start = time if self._start is None else min(self._start, time)
                seen[topic] = seen.get(topic, 0) + 1
                if seen[topic] > PEEK and not any(publishers[topic]):
                    continue
                message = decoded()
                known = publishers.setdefault(topic, set())
                names = tuple(labels(message))
                if names not in known:
                    known.add(names)
                    columns = found.setdefault(topic, dict.fromkeys([LOG_TIME]))
                    columns |= dict.fromkeys(columns_of(message))
        self._several = {topic for topic, known in publishers.items() if len(known) > 1}
        return {topic: tuple(columns) for topic, columns in found.items()}

    def blocks(self, wanted: Wanted, rows: int) -> Iterator[Array]:
        """The wanted columns, block after block; the first wanted one is the time."""
        places = [self._place(name) for name in wanted.names]
        base = places[0][0]
        topics = sorted({topic for topic, _ in places})
        if topics == [base] and base not in self._several:
            yield from self._streamed(base, [name for _, name in places], rows)
            return
        series = {topic: self._series(topic, places) for topic in topics}
        readings = []
        for topic, name in places[1:]:
            stamps, values = series[topic]
            # Of several publishers, a message may lack a column; else a NaN is one that was logged.
            there = ~np.isnan(values[name]) if topic in self._several else slice(None)
            readings.append((stamps[there], values[name][there]))
        table, remark = joined(str(self.path), wanted, readings, series[base][0])
        if remark:
            self._remark(remark)
        yield from (table[k : k + rows] for k in range(0, len(table), rows))

    def _present(self, topic: str, names: Sequence[str]) -> Array:
        """Columns (N, k) of a topic with several publishers, the time first, in the order of time.

        Messages that have none of the others are passed over; NaN where one has only some.
        """
        kept, passed = [], 0
        with self._messages([topic]) as messages:
            for _, time, decoded in messages:
                message = decoded()
                row = [self._number(message, time, name) for name in names]
                if len(row) > 1 and np.isnan(row[1:]).all():
                    passed += 1
                else:
                    kept.append(row)
        if passed:
            self._remark(
                f"{topic}: {passed} of {passed + len(kept)} messages have none of the columns: passed over"
            )
        table = np.array(kept).reshape(len(kept), len(names))
        return table[np.argsort(table[:, 0], kind="stable")] if np.isnan(table).any() else table

    def _series(self, topic: str, places: Sequence[tuple[str, str]]) -> tuple[Array, dict[str, Array]]:
        """Times (N,) of a topic's messages, of the kind of the time column's, and its wanted columns (N,)."""
        base, clock = places[0]
        if clock not in self._topics[topic]:
            raise InputError(
                f"{self.path}: {base} and {topic} have no common clock: {topic} has no {clock}; "
                f"use {base}.{LOG_TIME} as the time column"
            )
        names = [name for other, name in places[1:] if other == topic]
        if topic in self._several:
            table = self._present(topic, [clock, *names])
        else:
            blocks = list(self._streamed(topic, [clock, *names], ROWS))
            table = np.concatenate(blocks) if blocks else np.empty((0, 1 + len(names)))
        for name, x in zip(names, table.T[1:], strict=True):
            if np.isnan(x).all():
                raise InputError(f"{self.path}: {topic} has no message with {name}")
        if np.any(np.diff(table[:, 0]) <= 0.0):
            raise InputError(f"{self.path}: time runs backwards in {topic}.{clock}")
        return table[:, 0], dict(zip(names, table.T[1:], strict=True))

    def _streamed(self, topic: str, names: Sequence[str], rows: int) -> Iterator[Array]:
        """Columns of a topic, block after block."""
        waiting: list[list[float]] = []
        with self._messages([topic]) as messages:
            for _, time, decoded in messages:
                message = decoded()
                waiting.append([self._number(message, time, name) for name in names])
                if len(waiting) == rows:
                    yield np.array(waiting)
                    waiting = []
        if waiting:
            yield np.array(waiting)

    def _number(self, message: Any, time: int, name: str) -> float:
        if name == LOG_TIME:
            return 1e-9 * (time - (self._start or 0))
        return number_at(message, name)

    def _place(self, column: str) -> tuple[str, str]:
        topic = max((t for t in self._topics if column.startswith(f"{t}.")), key=len)
        return topic, column.removeprefix(f"{topic}.")

    @contextmanager
    def _messages(self, topics: Sequence[str] | None = None) -> Iterator[Messages]:
        try:
            with messages_of(self.path, topics, self._remark) as messages:
                yield messages
        except InputError:
            raise
        except ImportError as error:
            raise missing(f"{self.path}: bags need", str(error.name)) from None
        except Exception as error:
            # Foreign code on a file of any content: whatever it raises means that the file cannot be read.
            reason = " ".join(str(error).split())[:160] or type(error).__name__
            reindex = self.path.suffix == ".bag" and "index" in reason
            hint = "; it was not closed or is cut off: `rosbag reindex FILE` mends it" if reindex else ""
            raise InputError(f"{self.path}: cannot be read as a bag: {reason}{hint}") from None

    def _remark(self, text: str) -> None:
        self._found[text] = None
