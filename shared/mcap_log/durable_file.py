"""An append-only file that outlives a full disk."""

from __future__ import annotations

import os
from collections import deque
from pathlib import Path

from shared.durable_names import sync_folder
from shared.own_files import open_own


class DurableFile:
    """Takes whatever is written at once; ``sync`` brings it to the disk.

    What is not known to be on the disk is kept here and goes to the same place at the next
    ``sync``, so nothing is lost and nothing stands there twice.  The file is made by the first
    ``sync``.  It is what an MCAP writer needs of an output stream.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._descriptor: int | None = None
        self._name_is_safe = False
        self._waiting: deque[bytes] = deque()
        self._unsure: list[bytes] = []  # given to the system, which may still lose it
        self._size = 0
        self._given_bytes = 0
        self._safe_bytes = 0

    @property
    def waiting_bytes(self) -> int:
        return self._size - self._safe_bytes

    def tell(self) -> int:
        """Bytes written so far, on the disk or not."""
        return self._size

    def write(self, data: bytes) -> int:
        if data:
            self._waiting.append(bytes(data))
            self._size += len(data)
        return len(data)

    def take(self) -> bytes:
        """Take the buffered bytes instead of writing them: for a file that is sent elsewhere."""
        content = b"".join(self._waiting)
        self._waiting.clear()
        self._given_bytes = self._safe_bytes = self._size
        return content

    def flush(self) -> None:
        """Asked for by stream writers after each chunk; ``sync`` is what reaches the disk."""

    def sync(self) -> None:
        """Returns when everything written is on the disk for good; raises OSError."""
        if self._descriptor is None:
            self._descriptor = open_own(self.path, os.O_RDWR | os.O_CREAT | os.O_EXCL, 0o640)
        if not self._name_is_safe:
            sync_folder(self.path.parent)
            self._name_is_safe = True
        while self._waiting:
            block = self._waiting.popleft()
            try:
                count = os.pwrite(self._descriptor, block, self._given_bytes)
            except OSError:
                self._waiting.appendleft(block)
                raise
            self._given_bytes += count
            self._unsure.append(block[:count])
            if count < len(block):
                self._waiting.appendleft(block[count:])
        try:
            os.fsync(self._descriptor)
        except OSError:  # the system may have dropped it, and the next fsync would not say so
            self._waiting.extendleft(reversed(self._unsure))
            self._unsure.clear()
            self._given_bytes = self._safe_bytes
            raise
        self._unsure.clear()
        self._safe_bytes = self._given_bytes

    def close(self) -> None:
        """Lets go of the file; what still waits is lost."""
        if self._descriptor is not None:
            os.close(self._descriptor)
            self._descriptor = None
