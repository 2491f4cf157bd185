"""Imported files and audio that a copy in an archive has beside its log, fetched when they are
read.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from base_station.archive.catalogue import LOG_NAME, RADIO_NAME, CatalogueEntry, name_in_archive
from base_station.archive.checking import parts_of
from base_station.archive.store import ArchiveStore
from base_station.radio.radio_log import RadioLog
from base_station.storage.imports import ImportFolder
from shared.mcap_log import SegmentReader
from shared.own_files import make_folder

_PART_BYTES = 4 << 20


class ArchivedImports(ImportFolder):
    """Imported files.  Raises ArchiveError if the archive does not answer."""

    def __init__(self, path: Path, store: ArchiveStore, entry: CatalogueEntry) -> None:
        """``path``: where they are kept once they are fetched."""
        super().__init__(path)
        self._store, self._entry = store, entry

    def file(self, incident_id: str, name: str) -> Path:
        path = super().file(incident_id, name)
        if incident_id == self._entry.incident_id and not path.exists():
            attached = self.attached_name(name)
            if attached in self._entry.attached:
                self.take_from(incident_id, attached, self._parts(*self._entry.attached[attached]))
        return path

    def _parts(self, begin: int, end: int) -> Iterator[bytes]:
        name = name_in_archive(self._entry.incident_id, self._entry.file(LOG_NAME).stored_name)
        for at in range(begin, end, _PART_BYTES):
            yield self._store.read(name, at, min(at + _PART_BYTES, end))


class ArchivedRadio(RadioLog):
    """Audio of the radio channels, all of which is fetched at once."""

    def __init__(self, folder: Path, store: ArchiveStore, entry: CatalogueEntry) -> None:
        """``folder``: where it is kept once it is fetched."""
        super().__init__(folder)
        self._store, self._entry = store, entry

    def channels(self) -> tuple[str, ...]:
        """Channels with audio.  Raises ArchiveError if the archive does not answer."""
        has_audio = any(one.name == RADIO_NAME for one in self._entry.files)
        if has_audio and not self.folder.is_dir():
            self._fetch()
        return super().channels()

    def _fetch(self) -> None:
        whole = self.folder.with_name(f"fetched-{RADIO_NAME}")
        with whole.open("wb") as file:
            file.writelines(parts_of(self._store, self._entry, self._entry.file(RADIO_NAME)))
        making = RadioLog(self.folder.with_name("making"))
        make_folder(making.folder)
        with SegmentReader(whole) as reader:
            making.take_from(reader)
        whole.unlink()
        making.folder.rename(self.folder)
