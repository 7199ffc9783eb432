"""ROS recordings, version 1 (`.bag`) and 2 (`.db3`), as messages; whatever is wrong is one clear error."""

import contextlib
import itertools
import struct
from dataclasses import dataclass
from pathlib import Path

import apsw  # comes with rosbags, which lets its errors through
from rosbags import rosbag1, rosbag2
from rosbags.serde import SerdeError
from rosbags.typesys import Stores, get_typestore

from courtside.geometry import camera_fields
from courtside.study.errors import InputError

READERS = {
    ".bag": (rosbag1.Reader, Stores.ROS1_NOETIC, "deserialize_ros1"),
    ".db3": (rosbag2.Reader, Stores.ROS2_HUMBLE, "deserialize_cdr"),
}
# What rosbags, its parsers and its decompressors raise on damaged files.
DAMAGED = (rosbag1.ReaderError, rosbag2.ReaderError, SerdeError, apsw.Error, struct.error)
DAMAGED += (OSError, EOFError, ValueError, LookupError, TypeError, AttributeError, ArithmeticError)
DAMAGED += (AssertionError, RuntimeError, MemoryError)
LARGEST_MESSAGE_BYTES = 1 << 28  # a 4K colour picture has 25 MB
HOW = "copy it again from the camera's computer, or record again and stop the recording in its program"


@dataclass(frozen=True, eq=False)
class Bag:
    """An open recording.

    Attributes
    ----------
    path : Path
    counts : dict of str to int
        Messages on each topic.
    """

    path: Path
    counts: dict
    _reader: object
    _parse: object

    def messages(self, topics):
        """Yield (topic, time_ns, message) of some topics, in order of time.

        Raises
        ------
        InputError
            If a message is damaged or missing.
        """
        wanted = [c for c in self._reader.connections if c.topic in set(topics)]
        if not wanted:
            return
        with _guarded(self.path):
            for connection, time_ns, raw in self._reader.messages(wanted):
                if len(raw) > LARGEST_MESSAGE_BYTES:
                    raise ValueError(f"a message of {len(raw)} bytes on {connection.topic}")
                yield connection.topic, time_ns, self._parse(raw, connection.msgtype)

    def first(self, topic):
        """Return the first message on a topic; None where there is none."""
        found = next(self.messages([topic]), None)
        return found[2] if found else None

    def all(self, topic, limit=1000):
        """Return the first messages on a topic, as many as `limit` at most."""
        return [message for _, _, message in itertools.islice(self.messages([topic]), limit)]


@contextlib.contextmanager
def opened(path):
    """Open a recording.

    Parameters
    ----------
    path : str or Path
        `.bag` of ROS 1 or `.db3` of ROS 2.

    Yields
    ------
    bag : Bag

    Raises
    ------
    InputError
        If the file is missing, none of these, cut short or damaged.
    """
    path = Path(path)
    if path.suffix.lower() not in READERS or not path.is_file():
        found = f"a file named *{path.suffix}" if path.is_file() else "no file"
        raise InputError(
            f"{path}: expected a recording in ROS format (.bag or .db3), found {found}; correct the path"
        )
    kind, store, parser = READERS[path.suffix.lower()]
    parse = getattr(get_typestore(store), parser)
    with contextlib.ExitStack() as stack:
        with _guarded(path):
            reader = stack.enter_context(kind(path))
            counts = {}
            for connection in reader.connections:
                if not isinstance(connection.topic, str) or not connection.topic.isprintable():
                    raise ValueError("a topic without a readable name")
                counts[connection.topic] = counts.get(connection.topic, 0) + connection.msgcount
        yield Bag(path, counts, reader, parse)


@contextlib.contextmanager
def _guarded(path):
    try:
        yield
    except InputError:
        raise
    except DAMAGED as error:
        found = camera_fields.short(error) or type(error).__name__
        if "not indexed" in found:
            found = "a recording that was not finished (it has no index)"
        raise InputError(
            f"{path}: expected a whole recording in ROS format, found damage: {found}; {HOW}"
        ) from error
