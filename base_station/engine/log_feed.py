"""Log feeds: records of a log in the order of recording, which is the order in which they are
stepped.

A record is ``(t_ns, key, payload)`` with station time; ``base_station.core.events.event_of``
decodes it to an event.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Container, Iterator
from pathlib import Path
from typing import Protocol

from shared.mcap_log import (
    LogRecord,
    SegmentIdentity,
    identity_of,
    log_id_of,
    read_log,
    segment_paths,
)


class RecordSource(Protocol):
    """Source of the records of a span of time."""

    def records(
        self,
        start_ns: int | None = None,
        end_ns: int | None = None,
        keys: Container[str] | None = None,
    ) -> Iterator[LogRecord]:
        """Records from station time ``start_ns`` to before ``end_ns``."""


class LogFeed(ABC):
    """The records of one log, in a folder or in an archive."""

    @property
    @abstractmethod
    def log_id(self) -> str:
        """Identity of the log from its segments; empty for segments of an earlier version."""

    @abstractmethod
    def noting(self, on_damage: Callable[[str], object]) -> LogFeed:
        """Return a feed of the same log with another callback for damage."""

    @abstractmethod
    def records(
        self,
        start_ns: int | None = None,
        end_ns: int | None = None,
        keys: Container[str] | None = None,
    ) -> Iterator[LogRecord]:
        """Records from station time ``start_ns`` to before ``end_ns``, of the log as it is at the
        first step.

        Raises LogError when a segment cannot be opened.
        """

    @abstractmethod
    def everything(
        self, start_ns: int, end_ns: int | None, topics: Container[str] | None
    ) -> Iterator[LogRecord]:
        """Records of these topics, including those that were decided from others; None: of all
        topics.
        """

    @abstractmethod
    def watch(self) -> Callable[[], bool]:
        """Return a function that gives True once a present segment was rewritten or removed."""


class FolderFeed(LogFeed):
    """Records of a folder, from every segment in turn, the open one included.  Any thread may call
    it; each iterator is for one thread.
    """

    def __init__(
        self,
        folder: Path,
        flush: Callable[[], object] = lambda: None,
        on_damage: Callable[[str], object] = lambda _: None,
    ) -> None:
        """``flush`` writes records in memory to disk (``Recorder.flush``); ``on_damage`` receives a
        sentence about each part that cannot be read.
        """
        self._folder = folder
        self._flush = flush
        self._on_damage = on_damage

    @property
    def log_id(self) -> str:
        return log_id_of(segment_paths(self._folder))

    @property
    def segment_names(self) -> set[str]:
        """File names of its segments."""
        return {path.name for path in segment_paths(self._folder)}

    def noting(self, on_damage: Callable[[str], object]) -> FolderFeed:
        return FolderFeed(self._folder, self._flush, on_damage)

    def records(
        self,
        start_ns: int | None = None,
        end_ns: int | None = None,
        keys: Container[str] | None = None,
    ) -> Iterator[LogRecord]:
        self._flush()
        return read_log(self._folder, start_ns, end_ns, keys, self._on_damage)

    def everything(
        self, start_ns: int, end_ns: int | None, topics: Container[str] | None
    ) -> Iterator[LogRecord]:
        self._flush()
        return read_log(
            self._folder, start_ns, end_ns, topics, self._on_damage, derived=topics is not None
        )

    def watch(self) -> Callable[[], bool]:
        now = self._files()
        return lambda: not now <= self._files()

    def _files(self) -> set[tuple[str, SegmentIdentity | None]]:
        """Segments by name and identity: a segment whose records were changed has another identity,
        one that was packed has the same.
        """
        return {(path.name, identity_of(path)) for path in segment_paths(self._folder)}
