"""Makes a new MCAP file of a log: all that can be read of it, or a cut by time and topic.

The original is only read; the new file is there when all of it is written, and not at all
otherwise.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from datetime import datetime
from fnmatch import fnmatchcase
from functools import cache
from importlib.metadata import version
from pathlib import Path

from shared.clock import NS_PER_S
from shared.errors import UserError
from shared.log_command.inspection import damage_of
from shared.log_command.log_files import LogFileSet
from shared.mcap_log import LogRecord, RebuiltSegment, Segment, SegmentReader, identity_in_log
from shared.out_file import whole

EXTRACT_METADATA = "muster.extract"
_CHUNK_BYTES = 1 << 20  # as archives have it: fewer chunks than a log that must not lose a second
_SYNC_BYTES = 32 << 20  # what is not on the disk waits in memory


class TopicPatterns:
    """Set of the topics that one of the shell patterns matches; without patterns, of all."""

    def __init__(self, patterns: Iterable[str] = ()) -> None:
        self.patterns = tuple(patterns)
        self._matches = cache(self._is_matched)

    def __contains__(self, topic: object) -> bool:
        return isinstance(topic, str) and self._matches(topic)

    def _is_matched(self, topic: str) -> bool:
        return not self.patterns or any(fnmatchcase(topic, one) for one in self.patterns)


@dataclass(frozen=True, slots=True)
class Selection:
    """Records from ``start`` until before ``end``; None: from the first, to the last."""

    start: datetime | None = None
    end: datetime | None = None
    topics: TopicPatterns = field(default_factory=TopicPatterns)

    def records(self, reader: SegmentReader) -> Iterator[LogRecord]:
        return reader.records(_ns(self.start), _ns(self.end), self.topics, derived=True)


@dataclass(frozen=True, slots=True)
class Extraction:
    """Contents of the new file, and damage of the log that it was read from."""

    messages: int
    damage: list[str]


def recover_file(path: Path, target: Path, on_bytes: Callable[[int], None]) -> Extraction:
    """Write all that can be read of one file as a complete one.  ``on_bytes`` takes the size of
    each part that was read.  Raises UserError where ``target`` is there already or cannot be
    written.
    """
    with SegmentReader(path) as reader, _new_file(target) as making:
        rebuilt = RebuiltSegment(making, identity_in_log(path))
        try:
            for chunk in reader.intact_chunks():
                rebuilt.add(chunk)
                on_bytes(len(chunk.record))
                if rebuilt.file.waiting_bytes > _SYNC_BYTES:
                    rebuilt.file.sync()
            rebuilt.finish()
            rebuilt.file.sync()
        finally:
            rebuilt.file.close()
        damage = damage_of(reader)
    with SegmentReader(target) as written:
        return Extraction(sum((written.topic_counts or {}).values()), damage)


def cut_log(
    files: LogFileSet, target: Path, selection: Selection, on_file: Callable[[], None]
) -> Extraction:
    """Write the selected records of a log as one file, with an index and chunks of a megabyte.

    ``on_file`` is called behind each file that was read.  Raises UserError where there is no such
    record, or ``target`` is there already or cannot be written.
    """
    damage = [f"segment {number} is missing" for number in files.missing_numbers]
    count = 0
    with _new_file(target) as making:
        cut = Segment(making, _CHUNK_BYTES, identity_in_log(files.paths[0]))
        try:
            for path in files.paths:
                with SegmentReader(path) as reader:
                    for t_ns, key, payload in selection.records(reader):
                        cut.add(t_ns, key, payload)
                        count += 1
                        if cut.file.waiting_bytes > _SYNC_BYTES:
                            cut.file.sync()
                    damage += damage_of(reader)
                on_file()
            if not count:
                raise UserError(
                    "no record of that time and those topics is in the log; `muster log info` "
                    "shows what is"
                )
            cut.add_metadata(EXTRACT_METADATA, _origin(files, selection))
            cut.finish()
            cut.file.sync()
        finally:
            cut.file.close()
    return Extraction(count, damage)


def _origin(files: LogFileSet, selection: Selection) -> dict[str, str]:
    """Origin of an extract, for any reader of MCAP; the log's id stands in the head."""
    return {
        "muster_version": version("muster"),
        "first_file": files.paths[0].name,
        "last_file": files.paths[-1].name,
        "start": selection.start.isoformat() if selection.start else "",
        "end": selection.end.isoformat() if selection.end else "",
        "topics": " ".join(selection.topics.patterns),
    }


@contextmanager
def _new_file(target: Path) -> Iterator[Path]:
    if target.exists():
        raise UserError(f"{target} is there already; choose another name")
    with whole(target) as making:
        making.unlink()  # a log's own file is made by its writer
        yield making


def _ns(time: datetime | None) -> int | None:
    return None if time is None else round(time.timestamp() * 1e6) * (NS_PER_S // 1_000_000)
