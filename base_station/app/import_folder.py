"""Imports of an incident in a station's folder, beside a running station or without one."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

from base_station.app.logged_action import log_action
from base_station.core.person_references import with_references
from base_station.importers.import_service import ImportService, require_anchor
from base_station.importers.interface import ImportOptions
from base_station.importers.requests import ImportAction, request_action
from base_station.storage.data_folder import DataFolder
from base_station.storage.db.database import Database
from base_station.storage.db.imports import ImportCatalogue
from base_station.storage.db.models import ImportRow, IncidentRow
from base_station.storage.db.opening import open_database
from base_station.storage.db.records import Records
from base_station.storage.db.roster import Roster
from base_station.storage.imports import ImportFolder
from shared.clock import NS_PER_S, SystemClock
from shared.errors import UserError
from shared.folder_lock import FolderLock
from shared.mcap_log import recover_log
from shared.messages.station import RemoveImport


@contextmanager
def open_imports(data: Path, incident_id: str, by: str) -> Iterator[FolderImports]:
    """Open the imports of an incident.  Raises UserError if there is no such incident.  If no
    station runs on the folder, it is locked meanwhile.
    """
    folder = DataFolder(data)
    folder.require()
    lock = None if FolderLock.is_held(data) else folder.lock()
    try:
        if lock is not None:
            recover_log(folder.log)
        with open_database(folder.require_database()) as store:
            records = Records(store, SystemClock())
            incident = records.require_incident(incident_id)
            yield FolderImports(folder, store, incident, by, is_locked=lock is not None)
    finally:
        if lock is not None:
            lock.close()


@dataclass(frozen=True)
class FolderImports:
    folder: DataFolder
    store: Database
    incident: IncidentRow
    by: str
    is_locked: bool  # no station runs on the folder

    def require_anchor(self) -> None:
        """Raise UserError if the incident's place on the Earth is not known, as then nothing can be
        imported.
        """
        require_anchor(Records(self.store, SystemClock()), self.incident)

    def import_file(
        self,
        file: Path,
        shift_s: float = 0.0,
        utc_offset_h: float | None = None,
        name: str = "",
    ) -> Sequence[str]:
        """Import a file, and return lines about its content.  ``name`` replaces the file's own
        name.  Raises UserError with the fault of the file.
        """
        desk = self._desk()
        incident_id = self.incident.incident_id
        options = ImportOptions(name or file.name, incident_id, shift_s, utc_offset_h)
        with self._catalogue.folder.incoming() as path:
            try:
                self._catalogue.folder.require_room(file.stat().st_size)
            except OSError as error:
                raise UserError(f"{file} cannot be read: {error.strerror or error}") from error
            self._catalogue.folder.copy(file, path)
            import_id = desk.import_file(path, options, self._act)
        row = self._catalogue.entry(incident_id, import_id)
        return [] if row is None else [self._line(row), *self._warnings(row)]

    def remove(self, import_id: str) -> str:
        """Remove an import, and return the file's name.  Raises UserError if there is none with
        this id.
        """
        row = self._catalogue.entry(self.incident.incident_id, import_id)
        if row is None:
            raise UserError(f"nothing with the id {import_id} was brought into this incident")
        self._act(RemoveImport(self.incident.incident_id, import_id))
        self._catalogue.folder.remove(self.incident.incident_id, import_id)
        return self._roster.shown(row.file_name)

    def lines(self) -> Iterator[str]:
        """Lines for a list, one for each file, oldest first."""
        for row in Records(self.store, SystemClock()).imports_of(self.incident.incident_id):
            yield self._line(row)

    @property
    def _catalogue(self) -> ImportCatalogue:
        return ImportCatalogue(self.store, ImportFolder(self.folder.imports))

    @property
    def _roster(self) -> Roster:
        return Roster(self.store, SystemClock())

    def _desk(self) -> ImportService:
        anchor = require_anchor(Records(self.store, SystemClock()), self.incident)
        return ImportService(
            self._catalogue, self.incident, anchor, self.folder.recorded_until_ns()
        )

    def _act(self, action: ImportAction) -> None:
        nameless = with_references(action, self._roster.ids_by_name())
        if self.is_locked:
            log_action(self.folder, self.store, self.by, nameless)
        else:
            request_action(self.folder, action)

    def _line(self, row: ImportRow) -> str:
        name = self._roster.shown(row.file_name)
        summary = self._catalogue.folder.summary(row.incident_id, row.import_id)
        what = "not at this station" if summary is None else f"{summary.tracks} tracks"
        return (
            f"{row.import_id}\t{name}\t{row.format}\t{what}\t{_utc(row.first_ns)} to "
            f"{_utc(row.last_ns)}\tby {row.by}, {_utc(row.t_ns)}\tSHA-256 {row.sha256}"
        )

    def _warnings(self, row: ImportRow) -> Iterator[str]:
        summary = self._catalogue.folder.summary(row.incident_id, row.import_id)
        for warning in () if summary is None else summary.warnings:
            yield f"  {self._roster.shown(row.file_name)}: {warning}"


def _utc(t_ns: int) -> str:
    return f"{datetime.fromtimestamp(t_ns // NS_PER_S, UTC):%Y-%m-%d %H:%M:%S} UTC"
