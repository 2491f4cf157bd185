"""Job queue: requested jobs with their progress, in a file until they are done."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from threading import Lock
from typing import Generic, Protocol, TypeVar

import msgspec

from base_station.storage.private_files import write_atomically
from shared.coded_text import coded, text_of_error
from shared.errors import StoreError
from shared.worker import Worker

_KEPT = 20  # of those that are over


class JobState(Protocol):
    @property
    def is_over(self) -> bool: ...


class Job(Protocol):
    """One job: a msgspec.Struct."""

    @property
    def state(self) -> JobState: ...


J = TypeVar("J", bound=Job)


class JobList(Generic[J]):
    """Jobs in the order of asking, kept in a file.  Thread-safe."""

    def __init__(self, path: Path, kind: type[J]) -> None:
        """A file that is no list of jobs is taken for an empty one."""
        self._path = path
        self._lock = Lock()  # never held while the disk is waited for
        self._saving = Lock()  # taken before the other one
        self._all: list[J] = []
        with suppress(OSError, msgspec.DecodeError):
            self._all = msgspec.json.decode(path.read_bytes(), type=list[kind])  # type: ignore[valid-type]

    def all(self) -> tuple[J, ...]:
        """Return copies of those under way and the last that are over."""
        with self._lock:
            return tuple(map(_copy, self._all))

    def under_way(self) -> list[J]:
        """Return the jobs themselves: change them with ``note``."""
        with self._lock:
            return self._under_way()

    def add(self, make: Callable[[list[J]], J]) -> J:
        """Add the job that ``make`` returns, and return a copy of it, when it is on the disk.

        ``make`` is called with the jobs under way, may return one of these, and may raise.

        Raises StoreError where the disk does not take it.
        """
        with self._saving:
            with self._lock:
                under_way = self._under_way()
                job = make(under_way)
                is_new = not any(job is one for one in under_way)
                over = [one for one in self._all if one.state.is_over]
                wanted = [*over[1 - _KEPT :], *under_way, job] if is_new else self._all
                content = msgspec.json.encode(wanted)
            if is_new:
                try:
                    write_atomically(self._path, content)
                except StoreError as error:
                    raise StoreError(
                        coded(
                            "job-not-kept",
                            "what was asked for cannot be kept, so nothing is done: {reason}",
                            reason=text_of_error(error),
                        )
                    ) from error
            with self._lock:
                self._all = wanted
                return _copy(job)

    def note(self, job: J, *, save: bool, **now: object) -> bool:
        """Change fields of a job; return False where it was over before, and stays as it is.

        A disk that fails does no harm: at worst the job is done once more.
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
        """Change fields of all jobs of the condition, of those that are over too."""
        with self._lock:
            for job in filter(which, self._all):
                for name, value in now.items():
                    setattr(job, name, value)
        self._save()

    def _under_way(self) -> list[J]:
        return [one for one in self._all if not one.state.is_over]

    def _save(self) -> None:
        """Write the file, where the disk takes it."""
        with self._saving:
            with self._lock:
                content = msgspec.json.encode(self._all)
            with suppress(StoreError):
                write_atomically(self._path, content)


class JobQueue(JobList[J]):
    """Job list with a worker, from ``start`` to ``close``; a restart goes on with the same jobs."""

    def __init__(
        self, path: Path, kind: type[J], name: str, work: Callable[[list[J]], float], failing: str
    ) -> None:
        """``work`` is called in the worker with the jobs under way, and returns the pause after it
        (see ``shared.worker``); a job that is added ends the pause.
        """
        super().__init__(path, kind)
        self._worker = Worker(name, lambda: work(self.under_way()), failing)

    def start(self) -> None:
        self._worker.start()

    def close(self) -> None:
        self._worker.close()

    @property
    def is_closing(self) -> bool:
        """True when work on a job is to be broken off."""
        return self._worker.stopping.is_set()

    def add(self, make: Callable[[list[J]], J]) -> J:
        added = super().add(make)
        self._worker.wake()
        return added

    def wake(self) -> None:
        """Call ``work`` at once: jobs have changed."""
        self._worker.wake()


def _copy(job: J) -> J:
    copied: J = msgspec.structs.replace(job)  # type: ignore[type-var]
    return copied
