"""Entry of an incident in an archive: the file ``catalogue.json`` beside the copy.

It is written last: a copy without it is incomplete, and is made again.  A copy that replaces
another one has files of other names, so that writing the entry replaces all of it at once.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import msgspec

from base_station.archive.store import ArchiveStore
from base_station.storage.db.archived import ArchivedFile
from base_station.storage.db.incident_rows import Row
from base_station.storage.db.known_people import KnownPerson
from shared.coded_text import TextCode, coded, with_codes
from shared.errors import ArchiveError

LOG_NAME = "incident.mcap"  # all of it, a log that stands alone (decision 119)
CONSOLE_NAME = "console.mcap"  # the pictures of consoles once more: a replay needs no other file
RADIO_NAME = "radio.mcap"  # audio of the radio channels once more
ENTRY_NAME = "catalogue.json"
VERSION = 1


class CatalogueEntry(msgspec.Struct, frozen=True):
    """An incident in an archive."""

    version: int
    muster_version: str
    incident_id: str
    name: str
    opened_ns: int
    closed_ns: int
    known_ns: int  # station time of the newest that was known of it
    archived_ns: int
    log_id: str  # of the station's log
    address: str  # of its dispatch
    people: dict[str, KnownPerson]  # who were in it, or are mentioned, by id
    alarm_rules: tuple[str, ...]
    files: tuple[ArchivedFile, ...]
    tables: dict[str, list[Row]]  # rows of the station's tables that a replay asks for
    # Files attached to ``incident.mcap``, by name: bytes from the first until before the second.
    attached: dict[str, tuple[int, int]] = {}  # msgspec copies it
    damage: tuple[str, ...] = ()  # unreadable parts of the station's log, in words
    damage_codes: tuple[TextCode, ...] = ()  # of ``damage``, in their order

    def damage_texts(self) -> tuple[str, ...]:
        return with_codes(self.damage, self.damage_codes)

    def file(self, name: str) -> ArchivedFile:
        """Entry of a file.  Raises ArchiveError if there is no file of this name."""
        for one in self.files:
            if one.name == name:
                return one
        raise ArchiveError(
            coded(
                "archive-copy-lacks-file",
                "the copy of {incident} has no {file}: copy it once more",
                incident=self.incident_id,
                file=name,
            )
        )


def name_in_archive(incident_id: str, name: str) -> str:
    return f"{incident_id}/{name}"


def stored_apart(entry: CatalogueEntry) -> CatalogueEntry:
    """The entry with names of files that do not replace those of the present copy."""
    files = []
    for one in entry.files:
        path = Path(one.name)
        stored_as = f"{path.stem}-{one.sha256[:16]}{path.suffix}"
        files.append(msgspec.structs.replace(one, stored_as=stored_as))
    return msgspec.structs.replace(entry, files=tuple(files))


def obsolete_files(store: ArchiveStore, entry: CatalogueEntry) -> Sequence[str]:
    """Files of an earlier copy of the incident that still exist beside this one."""
    own = {name_in_archive(entry.incident_id, one.stored_name) for one in entry.files}
    own.add(name_in_archive(entry.incident_id, ENTRY_NAME))
    return [one for one in store.names(f"{entry.incident_id}/") if one not in own]


def encoded_entry(entry: CatalogueEntry) -> bytes:
    return msgspec.json.encode(entry)


def read_entry(store: ArchiveStore, incident_id: str) -> CatalogueEntry | None:
    """Read the entry of an incident; None if there is no complete copy.  Raises ArchiveError."""
    name = name_in_archive(incident_id, ENTRY_NAME)
    encoded = store.read_all(name)
    if encoded is None:
        return None
    return decoded_entry(encoded, f"{store.address}: {name}")


def decoded_entry(encoded: bytes, where: str) -> CatalogueEntry:
    """Decode an entry.  ``where``: archive and name, for messages.  Raises ArchiveError."""
    try:
        entry = msgspec.json.decode(encoded, type=CatalogueEntry)
    except msgspec.MsgspecError as error:
        raise ArchiveError(
            coded(
                "archive-entry-unreadable",
                "the archive {place} cannot be read ({error}): copy the incident once more, or "
                "use the version of Muster that wrote it",
                place=where,
                error=str(error),
            )
        ) from error
    if entry.version > VERSION:
        raise ArchiveError(
            coded(
                "archive-entry-newer",
                "the archive {place} was written by a newer version of Muster ({version}): use "
                "that one",
                place=where,
                version=entry.muster_version,
            )
        )
    return entry


def require_entry(store: ArchiveStore, incident_id: str) -> CatalogueEntry:
    """Read the entry of an incident.  Raises ArchiveError, which names the incidents that there
    are.
    """
    entry = read_entry(store, incident_id)
    if entry is None:
        known = ", ".join(archived_ids(store))
        raise ArchiveError(
            coded(
                "archive-no-copy",
                "the archive {archive} has no complete copy of {incident}; it has: {known}",
                archive=store.address,
                incident=incident_id,
                known=known or coded("archive-has-none", "none"),
            )
        )
    return entry


def archived_ids(store: ArchiveStore) -> Sequence[str]:
    """Ids of incidents with a complete copy."""
    ends = f"/{ENTRY_NAME}"
    return sorted(one.removesuffix(ends) for one in store.names() if one.endswith(ends))


def unfinished_ids(store: ArchiveStore) -> Sequence[str]:
    """Ids of incidents with files but without an entry, whose copy is incomplete."""
    there = {one.partition("/")[0] for one in store.names() if "/" in one}
    return sorted(there - set(archived_ids(store)))
