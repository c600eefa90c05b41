"""Messages of ROS 1 and 2 bags and MCAP files, one after the other, without ROS."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Any, TypeAlias

from modelgen.errors import InputError

# topic, time [ns], what decodes the message
Messages: TypeAlias = Iterator[tuple[str, int, Callable[[], Any]]]
Remark: TypeAlias = Callable[[str], None]
READ = ("json", "cdr")  # encodings of messages in MCAP files


@contextmanager
def messages_of(path: Path, topics: Sequence[str] | None, remark: Remark) -> Iterator[Messages]:
    """The messages of a file or folder, of some topics or of all; remark: called with what is left out.

    Raises whatever the libraries raise.
    """
    files = bag_files(path)
    if path.suffix == ".mcap" and path.is_file():
        kinds = _encodings(path)
        if kinds is None or "json" in kinds.values():
            with path.open("rb") as stream:
                yield _mcap_messages(stream, topics, remark)
            return
        other = {topic: kind for topic, kind in kinds.items() if kind not in READ and kind != "ros1"}
        if other and len(other) == len(kinds):
            named = ", ".join(f"{topic} ({kind})" for topic, kind in other.items())
            raise InputError(f"{path}: found messages of {named}, expected JSON or ROS ones; convert them")
    from rosbags.highlevel import AnyReader  # noqa: PLC0415 - an extra
    from rosbags.typesys import Stores, get_typestore  # noqa: PLC0415

    with AnyReader(files, default_typestore=get_typestore(Stores.LATEST)) as bag:
        chosen = [c for c in bag.connections if topics is None or c.topic in topics]
        yield (
            (c.topic, time, partial(bag.deserialize, raw, c.msgtype))
            for c, time, raw in bag.messages(connections=chosen)
        )


def bag_files(path: Path) -> list[Path]:
    """The bag, or the files of a folder that has lost its metadata.yaml."""
    if not path.is_dir() or (path / "metadata.yaml").exists():
        return [path]
    for suffix in (".db3", ".mcap", ".bag"):
        if found := sorted(path.glob(f"*{suffix}")):
            return found
    return [path]


def _encodings(path: Path) -> dict[str, str] | None:
    """Encoding of the messages by topic; None where the file is cut off before it says so."""
    from mcap.reader import make_reader  # noqa: PLC0415 - an extra

    with path.open("rb") as stream:
        try:
            summary = make_reader(stream).get_summary()
        except Exception:
            return None
    return None if summary is None else {c.topic: c.message_encoding for c in summary.channels.values()}


def _mcap_messages(stream: Any, topics: Sequence[str] | None, remark: Remark) -> Messages:
    """Messages in the order of the file, up to where it is cut off."""
    from mcap.records import Channel, Message, Schema  # noqa: PLC0415 - an extra
    from mcap.stream_reader import StreamReader  # noqa: PLC0415

    schemas: dict[int, Any] = {}
    channels: dict[int, Any] = {}
    decoders: dict[int, Callable[[bytes], Any]] = {}
    count = 0
    try:
        for record in StreamReader(stream, validate_crcs=True).records:
            if isinstance(record, Schema):
                schemas[record.id] = record
            elif isinstance(record, Channel):
                channels[record.id] = record
                if record.message_encoding == "json":
                    decoders[record.id] = json.loads
                elif record.message_encoding == "cdr" and record.schema_id in schemas:
                    decoders[record.id] = _cdr(schemas[record.schema_id])
                else:
                    remark(f"{record.topic}: messages of the kind {record.message_encoding} are not read")
            elif isinstance(record, Message):
                count += 1
                channel = channels[record.channel_id]
                decode = decoders.get(record.channel_id)
                if decode is not None and (topics is None or channel.topic in topics):
                    yield channel.topic, record.log_time, partial(decode, record.data)
    except (GeneratorExit, InputError):
        raise
    except Exception:
        # The library's reader of damaged files raises whatever it meets.
        if not count:
            raise
        remark(f"the file is cut off or damaged after {count} messages: they are read")


def _cdr(schema: Any) -> Callable[[bytes], Any]:
    """A decoder of ROS 2 messages by the definition in the file."""
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore  # noqa: PLC0415 - an extra

    store = get_typestore(Stores.LATEST)
    name = schema.name if schema.name.count("/") == 2 else schema.name.replace("/", "/msg/", 1)
    if name not in store.types:
        store.register(get_types_from_msg(schema.data.decode(), name))
    return lambda raw: store.deserialize_cdr(raw, name)
