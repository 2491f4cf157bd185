"""Log of an archived incident, read in place: only requested parts are fetched."""

from __future__ import annotations

from collections.abc import Callable, Container, Iterator
from pathlib import Path

from base_station.archive.catalogue import CONSOLE_NAME, LOG_NAME, name_in_archive
from base_station.archive.store import ArchiveStore
from base_station.engine.log_feed import LogFeed
from base_station.storage.db.archived import ArchivedFile
from shared.mcap_log import (
    LogRecord,
    RangedSegmentFile,
    SegmentReader,
    channel_of_audio,
    is_console,
)


class ArchivedFeed(LogFeed):
    """Feed of a copy.  Reading raises ArchiveError if the archive does not answer."""

    def __init__(
        self,
        store: ArchiveStore,
        incident_id: str,
        files: dict[str, ArchivedFile],
        log_id: str,
        on_damage: Callable[[str], object] = lambda _: None,
    ) -> None:
        """``files``: entries of the catalogue, by name."""
        self._on_damage = on_damage
        self._store, self._incident_id, self._files_by_name = store, incident_id, files
        self._console = _ranged(store, incident_id, files[CONSOLE_NAME])
        self._whole = _ranged(store, incident_id, files[LOG_NAME])
        self._id = log_id

    @property
    def log_id(self) -> str:
        return self._id

    def noting(self, on_damage: Callable[[str], object]) -> ArchivedFeed:
        return ArchivedFeed(
            self._store, self._incident_id, self._files_by_name, self._id, on_damage
        )

    def records(
        self,
        start_ns: int | None = None,
        end_ns: int | None = None,
        keys: Container[str] | None = None,
    ) -> Iterator[LogRecord]:
        return self._read(self._whole, start_ns, end_ns, keys, derived=False)

    def everything(
        self, start_ns: int, end_ns: int | None, topics: Container[str] | None
    ) -> Iterator[LogRecord]:
        is_of_console = isinstance(topics, set | frozenset) and all(map(is_console, topics))
        file = self._console if is_of_console else self._whole
        found = self._read(file, start_ns, end_ns, topics, derived=topics is not None)
        # As in a station's log: audio of the radio has its own (``ArchivedRadio``).
        return (record for record in found if channel_of_audio(record[1]) is None)

    def watch(self) -> Callable[[], bool]:
        """Return a function that is never True: a copy is not changed, but replaced."""
        return lambda: False

    def _read(
        self,
        file: RangedSegmentFile,
        start_ns: int | None,
        end_ns: int | None,
        keys: Container[str] | None,
        *,
        derived: bool,
    ) -> Iterator[LogRecord]:
        if start_ns is not None and end_ns is not None:
            file.prefetch(start_ns, end_ns)
        with SegmentReader(file.path, file) as reader:
            yield from reader.records(start_ns, end_ns, keys, derived=derived)
            for note in reader.damage:
                self._on_damage(note)


def _ranged(store: ArchiveStore, incident_id: str, file: ArchivedFile) -> RangedSegmentFile:
    name = name_in_archive(incident_id, file.stored_name)

    def fetch(begin: int, end: int) -> bytes:
        return store.read(name, begin, end)

    return RangedSegmentFile(Path(name), file.segment_ranges, fetch)
