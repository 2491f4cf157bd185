"""Writes a log as a folder of MCAP segments."""

from __future__ import annotations

import secrets
from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from enum import Enum
from pathlib import Path
from typing import Any

from mcap.records import Attachment, Channel, Metadata, Schema

from shared.clock import NS_PER_S
from shared.coded_text import coded
from shared.errors import LogError
from shared.mcap_log.chunk_writer import ChunkWriter, McapFile, bytes_of
from shared.mcap_log.durable_file import DurableFile
from shared.mcap_log.folder import segment_path
from shared.mcap_log.foreign_files import LogEnd, log_end
from shared.mcap_log.identity import SegmentIdentity
from shared.mcap_log.schemas import (
    descriptor_set,
    is_console,
    is_derived,
    sender_time_and_sequence,
    wire_type_of,
)
from shared.own_files import make_folder

_ENCODING = "protobuf"
_CONSOLE_ENCODING = "json"
_LOG_ID_BYTES = 8
_TOPICS_MAX = 60_000  # a channel id has 16 bits


@dataclass(frozen=True, slots=True)
class SegmentPolicy:
    """Policy of cutting a log into segments and of bringing them to the disk."""

    segment_s: float = 900.0
    flush_every_s: float = 0.5
    chunk_bytes: int = 256 * 1024
    # Each topic of each chunk has an entry in the segment's index, which is kept in memory
    # until the segment ends: many units make shorter segments.
    index_entries_max: int = 200_000
    waiting_bytes_max: int = 64 * 1024 * 1024  # kept in memory while the disk cannot be written


class SegmentState(Enum):
    OPEN = "open"  # being written
    CLOSED = "closed"
    TORN = "torn"  # not ended in order; readable up to the tear
    UNREADABLE = "unreadable"  # the disk does not even open it


@dataclass(frozen=True, slots=True)
class SegmentInfo:
    """Summary of a segment; times are log times, 0 while it is empty."""

    path: Path
    state: SegmentState
    start_ns: int
    end_ns: int
    messages: int
    size_bytes: int
    log_id: str = ""  # of its log; empty: of an earlier version, or damaged


class Segment:
    """One MCAP file being written: topics are keys, payloads are kept as they are."""

    def __init__(self, path: Path, chunk_bytes: int, identity: SegmentIdentity) -> None:
        self._identity = identity
        self._mcap = McapFile(path, identity)
        self._chunk = ChunkWriter()
        self._chunk_bytes = chunk_bytes
        self._schemas: dict[str, int] = {}
        self._topics: dict[str, tuple[int, bool]] = {}  # by key, and whether it counts as a message
        self.index_entries = 0
        self.start_ns = 0
        self.end_ns = 0
        self.messages = 0

    @property
    def file(self) -> DurableFile:
        return self._mcap.file

    def add(self, t_ns: int, key: str, payload: bytes) -> None:
        topic, counts = self._topics.get(key) or self._register(key)
        publish_ns, sequence = sender_time_and_sequence(payload)
        self._chunk.add_message(topic, t_ns, payload, publish_ns or t_ns, sequence)
        if self._chunk.size > self._chunk_bytes:
            self.end_chunk()
        self.start_ns = self.start_ns or t_ns
        self.end_ns = max(self.end_ns, t_ns)
        self.messages += counts

    def add_metadata(self, name: str, contents: dict[str, str]) -> None:
        """A metadata record behind what was added so far, for any reader of MCAP."""
        self.end_chunk()
        self._mcap.add_metadata(Metadata(name, contents))

    def add_attachment(self, name: str, media_type: str, content: bytes, t_ns: int) -> None:
        """A file of its own behind what was added so far, for any reader of MCAP."""
        self.end_chunk()
        self._mcap.add_attachment(Attachment(t_ns, t_ns, name, media_type, content))

    def add_attachment_file(
        self, name: str, media_type: str, path: Path, t_ns: int
    ) -> Iterator[None]:
        """The same of a file that may be large: in parts, between which the caller may take what is
        made.  Raises LogError where the file is changed meanwhile, OSError where it cannot be read.
        """
        self.end_chunk()
        yield from self._mcap.add_attachment_file(
            Attachment(t_ns, t_ns, name, media_type, b""), path
        )

    def end_chunk(self) -> None:
        """Everything added so far is in the file, which may still have to reach the disk."""
        chunk = self._chunk.take()
        if chunk is not None:
            self._mcap.add(chunk)
            self.index_entries += len(chunk.index_offsets)

    def finish(self) -> None:
        """Write what makes the file complete."""
        self.end_chunk()
        self._mcap.finish()

    @property
    def is_full_of_topics(self) -> bool:
        return len(self._topics) >= _TOPICS_MAX

    def info(self, state: SegmentState) -> SegmentInfo:
        return SegmentInfo(
            self.file.path,
            state,
            self.start_ns,
            self.end_ns,
            self.messages,
            self.file.tell(),
            self._identity.log_id,
        )

    def _register(self, key: str) -> tuple[int, bool]:
        wire_type = wire_type_of(key)
        schema = 0 if wire_type is None else self._schema_of(wire_type)
        topic = len(self._topics) + 1
        registered = self._topics[key] = topic, not is_derived(key)
        encoding = "" if wire_type is None else _ENCODING
        if is_console(key):
            encoding = _CONSOLE_ENCODING
        record = bytes_of(Channel(topic, key, encoding, {}, schema))
        self._mcap.topics[topic] = record
        self._chunk.add_record(record)
        return registered

    def _schema_of(self, wire_type: Any) -> int:
        name = wire_type.DESCRIPTOR.full_name
        if name not in self._schemas:
            number = self._schemas[name] = len(self._schemas) + 1
            record = bytes_of(Schema(number, descriptor_set(wire_type), _ENCODING, name))
            self._mcap.schemas[number] = record
            self._chunk.add_record(record)
        return self._schemas[name]


class SegmentWriter:
    """Appends records to the newest segment of a folder, and begins new ones.

    A record is on the disk for good ``flush_every_s`` of log time later at the latest, and at
    once when it is urgent.  Time is passed in.  No disk trouble raises: records wait in memory,
    ``problem`` says so in words, and everything goes to its place when the disk takes it again.
    Records beyond ``waiting_bytes_max`` are refused and counted in ``lost``.

    One thread at a time.
    """

    def __init__(
        self,
        folder: Path,
        policy: SegmentPolicy = SegmentPolicy(),
        on_closed: Callable[[SegmentInfo], None] = lambda _: None,
    ) -> None:
        """``on_closed`` is called with each segment that is complete and on the disk.

        Raises LogError when the folder cannot be made or read.
        """
        try:
            make_folder(folder)
            self._end = log_end(folder)
        except OSError as error:
            raise LogError(f"the log folder {folder} cannot be used: {error.strerror}") from error
        self._folder = folder
        self._policy = policy
        self._flush_every_ns = round(policy.flush_every_s * NS_PER_S)
        self._on_closed = on_closed
        self._segment: Segment | None = None
        self._ended: deque[Segment] = deque()  # complete, but not all on the disk
        self._flush_due_ns: int | None = None
        self._trouble: OSError | None = None
        self.lost = 0

    def continue_log(self, number: int, log_id: str) -> None:
        """The log had a segment of this number, which is gone; ``log_id``: that of the log, where
        none is left that says so.
        """
        self._end = replace(
            self._end,
            number=max(self._end.number, number),
            log_id=self._end.log_id or log_id,
        )

    @property
    def problem(self) -> str:
        """Reason that records do not reach the disk, as a sentence; empty: they do."""
        if self._trouble is None:
            return ""
        error, waiting_mb = self._trouble.strerror or "", self.waiting_bytes / 1e6
        if self.lost:
            return coded(
                "log-records-lost",
                "the log cannot be written to {folder} ({error}): {waiting_mb:.1f} MB wait in "
                "memory, {lost} records are lost; free or mend the disk",
                folder=str(self._folder),
                error=error,
                waiting_mb=waiting_mb,
                lost=self.lost,
            )
        return coded(
            "log-waits",
            "the log cannot be written to {folder} ({error}): {waiting_mb:.1f} MB wait in memory; "
            "free or mend the disk",
            folder=str(self._folder),
            error=error,
            waiting_mb=waiting_mb,
        )

    @property
    def waiting_bytes(self) -> int:
        return sum(segment.file.waiting_bytes for segment in self._segments())

    @property
    def is_on_disk(self) -> bool:
        """Everything that was written."""
        return self._flush_due_ns is None and self._trouble is None

    def current(self) -> SegmentInfo | None:
        """The segment being written."""
        return None if self._segment is None else self._segment.info(SegmentState.OPEN)

    def write(self, t_ns: int, key: str, payload: bytes, *, urgent: bool = False) -> bool:
        """Append a record with log time ``t_ns``, which must not go back; False: it is lost."""
        kept = self.add(t_ns, key, payload)
        if kept and urgent:
            self.flush()
        else:
            self.advance(t_ns)
        return kept

    def add(self, t_ns: int, key: str, payload: bytes) -> bool:
        """As ``write``, of many records at once: call ``advance`` behind the last.  A disk that
        takes longer than what it takes has come in would else never get to the end of them.
        """
        if self._trouble is not None and self.waiting_bytes > self._policy.waiting_bytes_max:
            self.lost += 1
            return False
        if self._segment is None or self._is_over(self._segment, t_ns):
            self._begin_segment(t_ns)
        assert self._segment is not None
        self._segment.add(t_ns, key, payload)
        if self._flush_due_ns is None:
            self._flush_due_ns = t_ns + self._flush_every_ns
        return True

    def advance(self, t_ns: int) -> None:
        """Time goes on: flush when it is due.  Call it where records may stay away."""
        if self._flush_due_ns is not None and t_ns >= self._flush_due_ns:
            self._flush_due_ns = t_ns + self._flush_every_ns  # when to try again
            self.flush()

    def flush(self) -> None:
        """Bring everything to the disk; what fails is in ``problem``."""
        if self._segment is not None:
            self._segment.end_chunk()
        try:
            for segment in self._segments():
                segment.file.sync()
        except OSError as error:
            self._trouble = error
            return
        self._trouble = None
        self._flush_due_ns = None
        while self._ended:
            segment = self._ended.popleft()
            segment.file.close()
            self._on_closed(segment.info(SegmentState.CLOSED))

    def end_segment(self) -> None:
        """The next record begins another segment; what fails is in ``problem``."""
        self._end_segment()
        self.flush()

    def close(self) -> None:
        """End the log in order; what the disk does not take is left in ``problem``."""
        self._end_segment()
        self.flush()
        for segment in self._ended:
            segment.file.close()
        self._ended.clear()

    def _segments(self) -> list[Segment]:
        return [*self._ended, *([] if self._segment is None else [self._segment])]

    def _is_over(self, segment: Segment, t_ns: int) -> bool:
        return (
            t_ns - segment.start_ns >= self._policy.segment_s * NS_PER_S
            or segment.index_entries >= self._policy.index_entries_max
            or segment.is_full_of_topics
        )

    def _begin_segment(self, t_ns: int) -> None:
        self._end_segment()
        end = self._end
        log_id, number = end.log_id or secrets.token_hex(_LOG_ID_BYTES), end.number + 1
        path = segment_path(self._folder, number, t_ns)
        identity = SegmentIdentity(log_id, end.name)
        self._segment = Segment(path, self._policy.chunk_bytes, identity)
        self._end = LogEnd(log_id, path.name, number)

    def _end_segment(self) -> None:
        if self._segment is not None:
            self._segment.finish()
            self._ended.append(self._segment)
            self._segment = None
