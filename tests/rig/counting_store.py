"""An archive that counts what is asked of it."""

from __future__ import annotations

import time
from collections.abc import Sequence
from pathlib import Path

from base_station.archive.store import ArchiveStore


class CountingStore:
    """An ``ArchiveStore`` before another one."""

    def __init__(self, store: ArchiveStore) -> None:
        self._store = store
        self.requests = self.bytes = 0  # of what was read
        self.waited_s = 0.0

    @property
    def address(self) -> str:
        return self._store.address

    def put(self, name: str, content: Path) -> None:
        self._store.put(name, content)

    def size(self, name: str) -> int | None:
        self.requests += 1
        return self._store.size(name)

    def read_all(self, name: str) -> bytes | None:
        begun_s = time.perf_counter()
        data = self._store.read_all(name)
        self._count(data or b"", begun_s)
        return data

    def read(self, name: str, begin: int, end: int) -> bytes:
        begun_s = time.perf_counter()
        data = self._store.read(name, begin, end)
        self._count(data, begun_s)
        return data

    def names(self, beginning: str = "") -> Sequence[str]:
        self.requests += 1
        return self._store.names(beginning)

    def remove(self, name: str) -> None:
        self._store.remove(name)

    def _count(self, data: bytes, begun_s: float) -> None:
        self.waited_s += time.perf_counter() - begun_s
        self.requests += 1
        self.bytes += len(data)
