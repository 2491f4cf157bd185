"""Redaction of copies: people who were erased since are removed from them.

If the station does not have the log of an incident any more, its copy is the only one: it is
fetched, and rewritten as the station's log is.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import msgspec

from base_station.archive.catalogue import LOG_NAME, CatalogueEntry, name_in_archive
from base_station.archive.checking import fetch_log
from base_station.archive.store import ArchiveStore
from base_station.core.erasure.erasure import (
    CaptureClocks,
    Erasure,
    Record,
    actions_of,
    erasure_of_person,
)
from base_station.core.erasure.incident_scan import erasure_of_incident
from base_station.core.erasure.names_in_older_logs import has_names
from base_station.core.erasure.redaction import Redactor
from base_station.engine.log_feed import FolderFeed
from base_station.replay.incident_file import AFTER_NS, PEOPLE_NAME
from base_station.storage.db.database import Database
from base_station.storage.db.erasures_done import erased_incidents_since, erasures_done
from base_station.storage.db.window import FOREVER_NS
from shared.channels import OPERATOR
from shared.coded_text import coded
from shared.errors import ArchiveError, UserError
from shared.mcap_log import SegmentReader, channel_of_audio, rewrite_segment, segment_path
from shared.messages import STATION_ID
from shared.own_files import make_folder

_ACTIONS = OPERATOR.key(STATION_ID)


class CopyIncompleteError(ArchiveError):
    """A copy has a part of an erased incident without the ids of the people in it."""


class ErasedSubjects(NamedTuple):
    person_ids: frozenset[str]
    incident_ids: frozenset[str]

    def __bool__(self) -> bool:
        return bool(self.person_ids or self.incident_ids)


def erased_in(archive: ArchiveStore, entry: CatalogueEntry, store: Database) -> ErasedSubjects:
    """People and incidents that were erased and that a copy may still contain.  Raises
    ArchiveError.
    """
    until_ns = entry.closed_ns + AFTER_NS
    return ErasedSubjects(
        erasures_done(store).person_ids & _mentioned(archive, entry),
        erased_incidents_since(store, entry.archived_ns, entry.opened_ns, until_ns),
    )


def _mentioned(archive: ArchiveStore, entry: CatalogueEntry) -> set[str]:
    if PEOPLE_NAME not in entry.attached:
        return {*entry.people}
    name = name_in_archive(entry.incident_id, entry.file(LOG_NAME).stored_name)
    encoded = archive.read(name, *entry.attached[PEOPLE_NAME])
    return {*entry.people, *msgspec.json.decode(encoded, type=dict[str, object])}


def redacted_log(
    archive: ArchiveStore, entry: CatalogueEntry, erased: ErasedSubjects, scratch: Path
) -> FolderFeed:
    """The log of a copy without these, in a folder below ``scratch``.

    Raises ArchiveError if the copy is not as it was written, CopyIncompleteError if it contains a
    part of an erased incident that was open at the same time.
    """
    folder = scratch / "log"
    make_folder(folder)
    fetched = scratch / LOG_NAME
    fetch_log(archive, entry, fetched, lambda _: None)
    with SegmentReader(fetched) as reader:
        path = segment_path(folder, 1, reader.info().start_ns)
    fetched.rename(path)
    log = FolderFeed(folder)
    actions = list(log.records(keys={_ACTIONS}))
    for erasure in _erasures(actions, entry, erased):
        left = list(log.records(keys={_ACTIONS}))
        redactor = Redactor(erasure, CaptureClocks(), erasure.inserted_in(left))
        keeps_audio = erasure.incident_id != entry.incident_id

        def replace(
            record: Record, redactor: Redactor = redactor, keeps_audio: bool = keeps_audio
        ) -> list[Record]:
            if channel_of_audio(record[1]) is not None:
                return [record] if keeps_audio else []
            return redactor(record)

        rewrite_segment(path, replace)
    return log


def _erasures(
    actions: list[Record], entry: CatalogueEntry, erased: ErasedSubjects
) -> Iterator[Erasure]:
    is_older = has_names(one for _, one in actions_of(actions))
    for person_id in sorted(erased.person_ids):
        known = entry.people.get(person_id)
        names = {known.name} if is_older and known is not None else ()
        yield erasure_of_person(actions, person_id, names, FOREVER_NS)
    for incident_id in sorted(erased.incident_ids):
        try:
            yield erasure_of_incident(actions, incident_id, is_whole=False)
        except UserError as error:
            raise CopyIncompleteError(
                coded(
                    "archive-copy-incomplete",
                    "{incident} has people of {erased}, which was erased, and its copy does not "
                    "tell who they are: bring the missing segments back into the log, or remove "
                    "the copy",
                    incident=entry.incident_id,
                    erased=incident_id,
                )
            ) from error
