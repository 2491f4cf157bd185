"""Reads the segments of a log: by time and topic, whole, growing, torn or damaged."""

from __future__ import annotations

from collections.abc import Callable, Container, Iterator
from dataclasses import dataclass
from itertools import pairwise
from operator import itemgetter
from pathlib import Path

from shared.coded_text import coded, text_of_error
from shared.mcap_log.container import (
    CHUNK,
    INDEX_ENTRY,
    INDEX_HEAD,
    INDEX_OFFSET,
    MESSAGE,
    MESSAGE_BYTES,
    NONSENSE,
    RECORD,
    message_offsets,
    unpacked,
)
from shared.mcap_log.folder import segments_within
from shared.mcap_log.foreign_files import candidates, foreign_by_content, foreign_in_words
from shared.mcap_log.identity import identity_of
from shared.mcap_log.schemas import DERIVED
from shared.mcap_log.segment_contents import Chunk, contents_of
from shared.mcap_log.segment_file import SegmentFile
from shared.mcap_log.writing import SegmentInfo, SegmentState

LogRecord = tuple[int, str, bytes]  # log time, key, payload


@dataclass(frozen=True, slots=True)
class IntactChunk:
    """A chunk as it stands in the file, and what is in it."""

    record: bytes  # with opcode and length
    data: bytes  # schema, channel and message records


@dataclass(frozen=True, slots=True)
class _Wanted:
    """Selection of records."""

    low_ns: int
    high_ns: int
    keys: Container[str] | None
    derived: bool

    def has_key(self, key: str) -> bool:
        return (self.keys is None or key in self.keys) and (
            self.derived or not key.startswith(DERIVED)
        )


class SegmentReader:
    """Reads one segment; as a context manager it closes the file.

    Nothing that the bytes of the file may be raises: what cannot be read is described in
    ``damage`` while reading, and reading goes on behind it where it can.
    """

    def __init__(self, path: Path, file: SegmentFile | None = None) -> None:
        """``file``: where it is elsewhere.  Raises LogError when there is no such file."""
        self.path = path
        self._file = file or SegmentFile(path)
        self._contents = contents_of(self._file)

    def __enter__(self) -> SegmentReader:
        return self

    def __exit__(self, *_: object) -> None:
        self._file.close()

    @property
    def damage(self) -> list[str]:
        return self._file.damage

    @property
    def state(self) -> SegmentState:
        """State by the contents alone: a segment that is still written counts as torn."""
        if not self._file.is_given:
            return SegmentState.UNREADABLE
        return SegmentState.CLOSED if self._contents.is_complete else SegmentState.TORN

    @property
    def bytes_lost(self) -> int:
        """Behind the last readable chunk of a file that was not ended in order; indexes are made
        again, and count as none.
        """
        return self._file.size - self._contents.readable_bytes

    @property
    def topic_counts(self) -> dict[str, int] | None:
        """Messages a topic, as the end of a complete file states them; else None."""
        if self._contents.counts is None:
            return None
        topics = self._contents.topics
        return {topics.get(key, ""): count for key, count in self._contents.counts.items()}

    def info(self) -> SegmentInfo:
        """Counts the messages of a segment that is not complete by reading it."""
        chunks, identity = self._contents.chunks, identity_of(self.path)
        counts = self.topic_counts
        if counts is None:
            messages = sum(1 for _ in self.records())
        else:
            messages = sum(
                count for topic, count in counts.items() if not topic.startswith(DERIVED)
            )
        return SegmentInfo(
            self.path,
            self.state,
            min((chunk.start_ns for chunk in chunks), default=0),
            max((chunk.end_ns for chunk in chunks), default=0),
            messages,
            self._file.size,
            identity.log_id if identity else "",
        )

    def records(
        self,
        start_ns: int | None = None,
        end_ns: int | None = None,
        keys: Container[str] | None = None,
        *,
        derived: bool = False,
    ) -> Iterator[LogRecord]:
        """The records from ``start_ns`` until before ``end_ns``, in the order of writing."""
        wanted = _Wanted(
            0 if start_ns is None else start_ns,
            1 << 64 if end_ns is None else end_ns,
            keys,
            derived,
        )
        for index, chunk in enumerate(self._contents.chunks):
            outside = chunk.end_ns < wanted.low_ns or chunk.start_ns >= wanted.high_ns
            if index < self._contents.chunks_learned and (outside or self._lacks(chunk, keys)):
                continue
            data = self._chunk_data(chunk)
            offsets = None if keys is None else self._indexed_offsets(chunk, keys, data)
            if offsets is None:
                offsets = list(message_offsets(data, self._contents.topics))
            self._contents.chunks_learned = max(self._contents.chunks_learned, index + 1)
            if not outside:
                yield from self._records_at(data, offsets, wanted)

    def chunk_sizes(self) -> list[int]:
        """Bytes of the records in each chunk, before compression; ValueError where a head of them
        cannot be read.
        """
        offsets = [chunk.offset + RECORD.size for chunk in self._contents.chunks]
        return [CHUNK.unpack(self._file.read(offset, CHUNK.size))[2] for offset in offsets]

    def is_whole(self) -> bool:
        """True if every chunk is as it was written."""
        return self._file.is_given and all(map(self._chunk_data, self._contents.chunks))

    def intact_chunks(self) -> Iterator[IntactChunk]:
        """Records that can be read, in the order of the file."""
        for chunk in self._contents.chunks:
            data = self._chunk_data(chunk)
            if data:
                _, length = self._file.record_at(chunk.offset)
                yield IntactChunk(self._file.read(chunk.offset, 9 + length), data)

    def _records_at(self, data: bytes, offsets: list[int], wanted: _Wanted) -> Iterator[LogRecord]:
        topics = {
            number: key for number, key in self._contents.topics.items() if wanted.has_key(key)
        }
        known = self._contents.topics
        unknown = 0
        for offset in offsets:
            _, length, topic, _, t_ns = MESSAGE.unpack_from(data, offset)
            key = topics.get(topic)
            if key is not None and wanted.low_ns <= t_ns < wanted.high_ns:
                yield t_ns, key, data[offset + MESSAGE_BYTES : offset + 9 + length]
            elif topic not in known:
                unknown += 1
        if unknown:
            self._file.note(
                coded(
                    "segment-keys-lost",
                    "{file}: {count} records whose key was in a damaged part are lost",
                    file=self.path.name,
                    count=unknown,
                )
            )

    def _lacks(self, chunk: Chunk, keys: Container[str] | None) -> bool:
        """True where the chunk's index has none of the topics: it need not be unpacked."""
        if keys is None or chunk.topic_offsets is None:
            return False
        topics = self._contents.topics
        here = map(itemgetter(0), INDEX_OFFSET.iter_unpack(chunk.topic_offsets))
        return not any(key in keys for key in map(topics.get, here))

    def _chunk_data(self, chunk: Chunk) -> bytes:
        """The chunk's records; nothing, and a note of the damage, where they are not intact."""
        try:
            _, length = self._file.record_at(chunk.offset)
            return unpacked(self._file.read(chunk.offset + 9, length))
        except NONSENSE as error:
            self._file.note(
                coded(
                    "segment-chunk-lost",
                    "{file}: the chunk at byte {offset} is lost ({reason})",
                    file=self.path.name,
                    offset=chunk.offset,
                    reason=text_of_error(error),
                )
            )
            return b""

    def _indexed_offsets(self, chunk: Chunk, keys: Container[str], data: bytes) -> list[int] | None:
        """Offsets of the wanted topics' messages inside the chunk, in the order of writing.

        None where there is no index.  The index has no checksum, so it is held against the data.
        """
        if chunk.topic_offsets is None or not data:
            return None
        offsets: list[int] = []
        try:
            for topic, at in INDEX_OFFSET.iter_unpack(chunk.topic_offsets):
                if self._contents.topics.get(topic) in keys:
                    offsets += self._index_entries(topic, at, data)
        except NONSENSE:
            self._file.note(
                coded(
                    "segment-index",
                    "{file}: the index of the chunk at byte {offset} is damaged; read without it",
                    file=self.path.name,
                    offset=chunk.offset,
                )
            )
            return None
        return sorted(offsets)

    def _index_entries(self, topic: int, at: int, data: bytes) -> list[int]:
        _, length = self._file.record_at(at)
        body = self._file.read(at + 9, length)
        if INDEX_HEAD.unpack_from(body) != (topic, len(body) - INDEX_HEAD.size):
            raise ValueError("it is another, or of another length")
        entries = list(INDEX_ENTRY.iter_unpack(body[INDEX_HEAD.size :]))
        offsets = [offset for _, offset in entries]
        found = [MESSAGE.unpack_from(data, offset) for offset in offsets]
        if [(topic, t_ns) for t_ns, _ in entries] != [(head[2], head[4]) for head in found]:
            raise ValueError("it names other messages")
        if any(later <= earlier for earlier, later in pairwise(offsets)):
            raise ValueError("it is out of order")
        return offsets


def read_log(
    folder: Path,
    start_ns: int | None = None,
    end_ns: int | None = None,
    keys: Container[str] | None = None,
    on_damage: Callable[[str], object] = lambda _: None,
    *,
    derived: bool = False,
) -> Iterator[LogRecord]:
    """The records of a folder of segments in the order of writing: ``(t_ns, key, payload)``.

    From ``start_ns`` until before ``end_ns``; log times must not go back from one segment to the
    next.  Files that are no segments of this log are left out.  ``on_damage`` is called with a
    sentence for each part that could not be read; ``derived``: topics that follow from others are
    given, too.
    Raises LogError when a segment is taken away meanwhile.
    """
    foreign: dict[Path, str] = {}
    following = dict(candidates(folder, foreign))
    for path in segments_within(list(following), start_ns, end_ns):
        if reason := foreign_by_content(path, following[path]):
            foreign[path] = reason
            continue
        with SegmentReader(path) as segment:
            yield from segment.records(start_ns, end_ns, keys, derived=derived)
            for note in segment.damage:
                on_damage(note)
    for path, reason in foreign.items():
        on_damage(foreign_in_words(path, reason))
