"""What people asked for and a desk works at: in a file until it is done, with how far it is."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from threading import Lock
from typing import Generic, Protocol, TypeVar

import msgspec

from base_station.storage.private_files import write_atomically
from shared.errors import StoreError

_KEPT = 20  # of those that are over


class JobState(Protocol):
    @property
    def is_over(self) -> bool: ...


class Job(Protocol):
    """A msgspec.Struct."""

    @property
    def state(self) -> JobState: ...


J = TypeVar("J", bound=Job)


class Jobs(Generic[J]):
    """In the order of asking.  Thread-safe."""

    def __init__(self, path: Path, kind: type[J]) -> None:
        """What is no list of jobs is taken for an empty one."""
        self._path = path
        self._lock = Lock()  # never held while the disk is waited for
        self._saving = Lock()  # taken before the other one
        self._all: list[J] = []
        with suppress(OSError, msgspec.DecodeError):
            self._all = msgspec.json.decode(path.read_bytes(), type=list[kind])  # type: ignore[valid-type]

    def all(self) -> tuple[J, ...]:
        """Copies: of those under way and the last that are over."""
        with self._lock:
            return tuple(map(_copy, self._all))

    def under_way(self) -> list[J]:
        """Themselves: change them with ``note``."""
        with self._lock:
            return self._under_way()

    def add(self, make: Callable[[list[J]], J]) -> J:
        """A copy of what ``make`` gives, which is on the disk when this returns.  It is told what
        is under way, may give one of those, and may raise.

        Raises StoreError where the disk does not take it.
        """
        with self._saving:
            with self._lock:
                under_way = self._under_way()
                job = make(under_way)
                is_new = not any(job is one for one in under_way)
                over = [one for one in self._all if one.state.is_over]
                wanted = [*over[1 - _KEPT :], *under_way, job] if is_new else self._all
                said = msgspec.json.encode(wanted)
            if is_new:
                try:
                    write_atomically(self._path, said)
                except StoreError as error:
                    raise StoreError(
                        f"what was asked for cannot be kept, so nothing is done: {error}"
                    ) from error
            with self._lock:
                self._all = wanted
                return _copy(job)

    def note(self, job: J, *, save: bool, **now: object) -> bool:
        """How it stands now; False where it was over before, and stays as it is.

        Whether a disk that fails keeps it does not matter: at worst it is done once more.
        """
        with self._lock:
            if job.state.is_over:
                return False
            for name, value in now.items():
                setattr(job, name, value)
        if save:
            self._save()
        return True

    def note_each(self, which: Callable[[J], bool], **now: object) -> None:
        """Of those that are over, too."""
        with self._lock:
            for job in filter(which, self._all):
                for name, value in now.items():
                    setattr(job, name, value)
        self._save()

    def _under_way(self) -> list[J]:
        return [one for one in self._all if not one.state.is_over]

    def _save(self) -> None:
        """Where the disk takes it."""
        with self._saving:
            with self._lock:
                said = msgspec.json.encode(self._all)
            with suppress(StoreError):
                write_atomically(self._path, said)


def _copy(job: J) -> J:
    copied: J = msgspec.structs.replace(job)  # type: ignore[type-var]
    return copied
