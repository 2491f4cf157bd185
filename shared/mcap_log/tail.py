"""Tail of a log that a station is writing: each record once, soon after it is in the file.

``SegmentReader`` looks at a whole file each time; a tail goes on where it stopped.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import BinaryIO

from mcap.opcode import Opcode
from mcap.writer import MCAP0_MAGIC

from shared.mcap_log.container import (
    BETWEEN_CHUNKS,
    MESSAGE,
    MESSAGE_BYTES,
    NONSENSE,
    RECORD,
    message_offsets,
    unpacked,
)
from shared.mcap_log.folder import segment_number, segment_paths
from shared.mcap_log.reading import LogRecord

_READ_BYTES = 4 * 1024 * 1024


class LogTail:
    """Begins with the newest segment, and goes on to those that follow it.

    As a context manager it closes the file.  One thread at a time.  ``damage`` says in words what
    could not be read.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._file: BinaryIO | None = None
        self._number = 0
        self._offset = 0
        self._topics: dict[int, str] = {}
        self._is_over = False  # the rest of the segment holds no records
        self.damage: list[str] = []

    def __enter__(self) -> LogTail:
        return self

    def __exit__(self, *_: object) -> None:
        self._close()

    def read(self) -> list[LogRecord]:
        """Return what has been written since, some megabytes at most, topics for Foxglove as well;
        empty: nothing new.
        """
        if self._file is None:
            self._open_next()
        records = self._read_more()
        while not records and self._open_next():
            records = self._read_more()
        return records

    def _open_next(self) -> bool:
        """Go to the segment behind the present one, at the beginning to the newest; False: there is
        none.
        """
        paths = [
            path for path in segment_paths(self._folder) if segment_number(path) > self._number
        ]
        if not paths:
            return False
        path = paths[0] if self._number else paths[-1]
        try:
            file = path.open("rb")
        except OSError as error:  # taken away, or not ours to read
            self.damage.append(f"{path.name} cannot be read: {error.strerror}")
            self._number = segment_number(path)
            return True
        self._close()
        self._file, self._number = file, segment_number(path)
        self._offset, self._topics, self._is_over = len(MCAP0_MAGIC), {}, False
        return True

    def _close(self) -> None:
        if self._file is not None:
            self._file.close()
            self._file = None

    def _read_more(self) -> list[LogRecord]:
        """Records of the present segment; empty: it has no more yet."""
        records: list[LogRecord] = []
        while not records and (data := self._next_bytes()):
            records = self._take(data)
        return records

    def _next_bytes(self) -> bytes:
        """At least one whole MCAP record; empty: there is none yet."""
        if self._file is None or self._is_over:
            return b""
        file = self._file.fileno()
        data = os.pread(file, _READ_BYTES, self._offset)
        if len(data) < RECORD.size:
            return b""
        _, length = RECORD.unpack_from(data)
        whole = RECORD.size + length
        if whole > len(data) == _READ_BYTES and self._offset + whole <= os.fstat(file).st_size:
            data = os.pread(file, whole, self._offset)
        return data if whole <= len(data) or self._is_foreign(data[0]) else b""

    def _take(self, data: bytes) -> list[LogRecord]:
        """Go on behind the whole MCAP records in ``data``."""
        records: list[LogRecord] = []
        at = 0
        while at + RECORD.size <= len(data):
            opcode, length = RECORD.unpack_from(data, at)
            end = at + RECORD.size + length
            if self._is_foreign(opcode):
                self._end_segment(opcode)
                break
            if end > len(data):
                break
            if opcode == Opcode.CHUNK:
                records += self._records_in(data[at + RECORD.size : end])
            at = end
        self._offset += at
        return records

    @staticmethod
    def _is_foreign(opcode: int) -> bool:
        """True if no such record stands between the chunks of a segment."""
        return opcode != Opcode.CHUNK and opcode not in BETWEEN_CHUNKS

    def _end_segment(self, opcode: int) -> None:
        self._is_over = True
        if opcode != Opcode.DATA_END:
            self.damage.append(f"segment {self._number} makes no sense at byte {self._offset}")

    def _records_in(self, chunk: bytes) -> list[LogRecord]:
        try:
            data = unpacked(chunk)
        except NONSENSE as error:
            self.damage.append(f"a chunk of segment {self._number} is lost ({error})")
            return []
        records = []
        for offset in message_offsets(data, self._topics):
            _, length, topic, _, t_ns = MESSAGE.unpack_from(data, offset)
            key = self._topics.get(topic)
            if key is not None:
                payload = data[offset + MESSAGE_BYTES : offset + RECORD.size + length]
                records.append((t_ns, key, payload))
        return records
