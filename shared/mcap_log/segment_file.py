"""One segment as bytes: what is read of it, and notes of what is wrong with it."""

from __future__ import annotations

import os
from pathlib import Path
from typing import BinaryIO

from shared.coded_text import coded
from shared.errors import LogError
from shared.mcap_log.container import RECORD

_BLOCK_BYTES = 4096  # a disk gives so much or none of it


class SegmentFile:
    """An open file; ``damage`` describes, once each, what could not be read.

    One that the disk does not give is as good as empty, with ``is_given`` false.
    """

    def __init__(self, path: Path) -> None:
        """Raises LogError when there is no such file."""
        self.path = path
        self.damage: list[str] = []
        self.is_given = True
        try:
            self._file: BinaryIO = path.open("rb")
        except FileNotFoundError as error:
            raise LogError(
                coded(
                    "segment-gone",
                    "{path} cannot be read: {error}",
                    path=str(path),
                    error=str(error.strerror),
                )
            ) from error
        except OSError as error:
            self._file = Path(os.devnull).open("rb")  # noqa: SIM115 - until ``close``
            self.is_given = False
            self.note(
                coded(
                    "segment-unreadable",
                    "{file}: the disk does not give it ({error})",
                    file=path.name,
                    error=str(error.strerror),
                )
            )
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
            raise behind_end()
        try:
            data = os.pread(self._file.fileno(), count, offset)
        except OSError as error:
            self.note(
                coded(
                    "segment-unreadable-part",
                    "{file}: the disk does not give all of it",
                    file=self.path.name,
                )
            )
            raise ValueError(
                coded("bytes-unreadable", "the disk does not give it: {error}", error=str(error))
            ) from error
        if len(data) < count:
            raise ValueError(coded("bytes-cut", "the file was made shorter meanwhile"))
        return data

    def read_from(self, offset: int) -> bytes:
        """All that follows; zeros where the disk does not give it."""
        first = offset - offset % _BLOCK_BYTES
        return b"".join(
            self._read_or_zeros(max(block, offset), min(block + _BLOCK_BYTES, self.size))
            for block in range(first, self.size, _BLOCK_BYTES)
        )

    def _read_or_zeros(self, begin: int, end: int) -> bytes:
        try:
            return self.read(begin, end - begin)
        except ValueError:
            return bytes(end - begin)

    def note(self, damage: str) -> None:
        """``damage``: a coded text that names the file."""
        if damage not in self.damage:
            self.damage.append(damage)


def behind_end() -> ValueError:
    return ValueError(coded("bytes-behind-end", "the file ends before it"))
