"""Catalogue of what was brought into incidents, with the folder that has the files."""

from __future__ import annotations

from pathlib import Path

from sqlalchemy import select

from base_station.storage.db.database import Database
from base_station.storage.db.models import ImportRow
from base_station.storage.imports import ImportFolder


class ImportCatalogue:
    """Thread-safe; every method is one transaction."""

    def __init__(self, store: Database, folder: ImportFolder) -> None:
        self._store = store
        self.folder = folder

    def ids(self) -> set[tuple[str, str]]:
        """Incident and id of all."""
        with self._store.read() as session:
            found = session.execute(select(ImportRow.incident_id, ImportRow.import_id))
            return {(incident_id, import_id) for incident_id, import_id in found}

    def attachments(self, incident_id: str) -> dict[str, Path]:
        """As ``ImportFolder.attachments``, of all of an incident that are here."""
        own = select(ImportRow.import_id).where(ImportRow.incident_id == incident_id)
        with self._store.read() as session:
            return self.folder.attachments(incident_id, session.scalars(own).all())

    def entry(self, incident_id: str, import_id: str) -> ImportRow | None:
        with self._store.read() as session:
            return session.get(ImportRow, (incident_id, import_id))
