"""Copy of the erasures that wait at the station that leads, kept by the one that follows: a request
that the leader has not ordered in the log yet is not lost with it.
"""

from __future__ import annotations

from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path

import msgspec

from base_station.storage.private_files import write_atomically


class WaitingErasure(msgspec.Struct, frozen=True):
    """Erasure that was requested of a station that cannot order it, or has not ordered it yet."""

    request_id: str
    kind: str  # "person" or "incident"
    subject_id: str

    @property
    def subject(self) -> str:
        """As "person ID" or "incident ID"."""
        return f"{self.kind} {self.subject_id}"


class LeaderRequests:
    """In a file, with ids alone; for one thread."""

    def __init__(self, path: Path) -> None:
        """A file that is no list of requests is taken for an empty one."""
        self._path = path
        self._all: tuple[WaitingErasure, ...] = ()
        with suppress(OSError, msgspec.DecodeError):
            self._all = msgspec.json.decode(path.read_bytes(), type=tuple[WaitingErasure, ...])

    def all(self) -> tuple[WaitingErasure, ...]:
        return self._all

    def replace(self, waiting: Iterable[WaitingErasure]) -> None:
        """Raises StoreError where the disk does not take it: the former ones stay."""
        now = tuple(waiting)
        if now != self._all:
            write_atomically(self._path, msgspec.json.encode(now))
            self._all = now
