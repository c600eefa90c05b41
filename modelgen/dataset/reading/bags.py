"""ROS 1 and 2 bags and MCAP files, without ROS (extra `logs`: rosbags, mcap)."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from modelgen.dataset.reading.extras import missing
from modelgen.dataset.reading.messages import columns_of, number_at
from modelgen.dataset.reading.specs import unreadable
from modelgen.errors import InputError
from modelgen.numeric import Array

PEEK = 2000  # messages that the topics' columns are taken from
LOG_TIME = "log_time"
Messages = Iterator[tuple[str, int, Any]]  # topic, time [ns], message


class BagReader:
    """A bag whose columns are `topic.field`, one row per message of the time column's topic.

    Columns of other topics are interpolated at those times, by straight lines; such topics are held in
    memory. Raises InputError where the file cannot be read or a library is missing.
    """

    by_column = False
    remarks: tuple[str, ...] = ()

    def __init__(self, path: Path) -> None:
        self.path = path
        if not path.exists():
            raise unreadable(path, FileNotFoundError())
        found: dict[str, dict[str, None]] = {}
        self._start: int | None = None
        with self._messages() as messages:
            for k, (topic, time, message) in enumerate(messages):
                self._start = time if self._start is None else min(self._start, time)
                if topic not in found:
                    found[topic] = dict.fromkeys([LOG_TIME, *columns_of(message)])
                if k >= PEEK:
                    break
        if not found:
            raise InputError(f"{path}: the bag holds no message that can be read")
        self._topics = {topic: tuple(columns) for topic, columns in found.items()}
        self.names = tuple(f"{topic}.{name}" for topic, columns in found.items() for name in columns)

    def blocks(self, wanted: tuple[str, ...], rows: int) -> Iterator[Array]:
        """The wanted columns, block after block; the first wanted one is the time and sets the rows."""
        places = [self._place(name) for name in wanted]
        base = places[0][0]
        others = {topic for topic, _ in places} - {base}
        series = {topic: self._series(topic, places) for topic in sorted(others)}
        waiting: list[list[float]] = []
        with self._messages([base]) as messages:
            for _, time, message in messages:
                waiting.append(
                    [self._number(message, time, name) if topic == base else 0.0 for topic, name in places]
                )
                if len(waiting) == rows:
                    yield from self._joined(np.array(waiting), places, series)
                    waiting = []
        if waiting:
            yield from self._joined(np.array(waiting), places, series)

    def _joined(
        self, block: Array, places: Sequence[tuple[str, str]], series: dict[str, tuple[Array, Array]]
    ) -> Iterator[Array]:
        """The block with the other topics' columns filled in, where those topics have begun and not ended."""
        t = block[:, 0]
        inside = np.ones(len(t), dtype=bool)
        for topic, (stamps, values) in series.items():
            inside &= (t >= stamps[0]) & (t <= stamps[-1])
            names = [name for other, name in places if other == topic]
            for k, (other, name) in enumerate(places):
                if other == topic:
                    block[:, k] = np.interp(t, stamps, values[:, names.index(name)])
        if inside.any():
            yield block[inside]

    def _series(self, topic: str, places: Sequence[tuple[str, str]]) -> tuple[Array, Array]:
        """Times (N,) and wanted columns (N, k) of a topic; its times are of the kind of the base's."""
        clock = places[0][1]
        if clock not in self._topics[topic]:
            raise InputError(
                f"{self.path}: {places[0][0]} and {topic} have no common clock: {topic} has no {clock}; "
                f"use {places[0][0]}.{LOG_TIME} as the time column"
            )
        names = [name for other, name in places if other == topic]
        with self._messages([topic]) as messages:
            table = np.array(
                [
                    [self._number(message, time, name) for name in (clock, *names)]
                    for _, time, message in messages
                ]
            )
        if np.any(np.diff(table[:, 0]) <= 0.0):
            raise InputError(f"{self.path}: time runs backwards in {topic}.{clock}")
        return table[:, 0], table[:, 1:]

    def _number(self, message: Any, time: int, name: str) -> float:
        if name == LOG_TIME:
            return 1e-9 * (time - (self._start or 0))
        return number_at(message, name)

    def _place(self, column: str) -> tuple[str, str]:
        topic = max((t for t in self._topics if column.startswith(f"{t}.")), key=len)
        return topic, column.removeprefix(f"{topic}.")

    @contextmanager
    def _messages(self, topics: Sequence[str] | None = None) -> Iterator[Messages]:
        opened = _json_messages if _is_json(self.path) else _ros_messages
        try:
            with opened(self.path, topics) as messages:
                yield messages
        except InputError:
            raise
        except ImportError as error:
            raise missing(f"{self.path}: bags need", str(error.name)) from None
        except Exception as error:
            # Foreign code on a file of any content: whatever it raises means that the file cannot be read.
            reason = " ".join(str(error).split())[:160] or type(error).__name__
            raise InputError(f"{self.path}: cannot be read as a bag: {reason}") from None


def _is_json(path: Path) -> bool:
    """Whether an MCAP file's messages are JSON, which needs no ROS types."""
    if path.suffix != ".mcap":
        return False
    try:
        from mcap.reader import make_reader  # noqa: PLC0415 - an extra

        with path.open("rb") as stream:
            summary = make_reader(stream).get_summary()
    except Exception:
        return False
    kinds = {channel.message_encoding for channel in summary.channels.values()} if summary else set()
    return kinds == {"json"}


@contextmanager
def _json_messages(path: Path, topics: Sequence[str] | None) -> Iterator[Messages]:
    from mcap.reader import make_reader  # noqa: PLC0415 - an extra

    with path.open("rb") as stream:
        found = make_reader(stream).iter_messages(topics=topics)
        yield ((channel.topic, message.log_time, json.loads(message.data)) for _, channel, message in found)


@contextmanager
def _ros_messages(path: Path, topics: Sequence[str] | None) -> Iterator[Messages]:
    from rosbags.highlevel import AnyReader  # noqa: PLC0415 - an extra
    from rosbags.typesys import Stores, get_typestore  # noqa: PLC0415

    with AnyReader([path], default_typestore=get_typestore(Stores.LATEST)) as bag:
        chosen = [c for c in bag.connections if topics is None or c.topic in topics]
        yield (
            (connection.topic, time, bag.deserialize(raw, connection.msgtype))
            for connection, time, raw in bag.messages(connections=chosen)
        )
