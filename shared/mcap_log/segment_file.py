"""One segment as bytes: what is read of it, and notes of what is wrong with it."""

from __future__ import annotations

import os
from pathlib import Path
from typing import BinaryIO

from shared.errors import LogError
from shared.mcap_log.container import RECORD


class SegmentFile:
    """An open file; ``damage`` describes, once each, what could not be read."""

    def __init__(self, path: Path) -> None:
        """Raises LogError when the file cannot be opened."""
        self.path = path
        self.damage: list[str] = []
        try:
            self._file: BinaryIO = path.open("rb")
        except OSError as error:
            raise LogError(f"{path} cannot be read: {error.strerror}") from error
        self.size = os.fstat(self._file.fileno()).st_size  # what is written later is not read

    def close(self) -> None:
        self._file.close()

    def record_at(self, offset: int) -> tuple[int, int]:
        """Opcode and length of the record whose head is there; ValueError as ``read``."""
        opcode, length = RECORD.unpack(self.read(offset, RECORD.size))
        return opcode, length

    def read(self, offset: int, count: int) -> bytes:
        """Raises ValueError where the file ends before it or the disk does not give it."""
        if offset + count > self.size:  # a damaged length may be more than any memory holds
            raise ValueError("the file ends before it")
        try:
            data = os.pread(self._file.fileno(), count, offset)
        except OSError as error:
            raise ValueError(f"the disk does not give it: {error}") from error
        if len(data) < count:
            raise ValueError("the file was made shorter meanwhile")
        return data

    def note(self, what: str) -> None:
        note = f"{self.path.name}: {what}"
        if note not in self.damage:
            self.damage.append(note)
