"""Check of an archive against its own checksums, and fetching of copies from it."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator
from pathlib import Path

from base_station.archive.catalogue import (
    LOG_NAME,
    CatalogueEntry,
    archived_ids,
    name_in_archive,
    obsolete_files,
    require_entry,
    unfinished_ids,
)
from base_station.archive.store import ArchiveStore
from base_station.storage.db.archived import ArchivedFile
from shared.coded_text import coded
from shared.errors import ArchiveError
from shared.out_file import whole

_PART_BYTES = 4 << 20


def defects_of(
    store: ArchiveStore, on_progress: Callable[[float], None]
) -> Iterator[tuple[str, str]]:
    """Incidents with the faults of their copies as sentences; reads the whole archive.

    Raises ArchiveError if the archive does not answer.
    """
    for incident_id in unfinished_ids(store):
        yield incident_id, "the copy was cut short: it is made again with the next one"
    ids = archived_ids(store)
    for number, incident_id in enumerate(ids):
        entry = require_entry(store, incident_id)
        if left := obsolete_files(store, entry):
            yield (
                incident_id,
                f"has files of an earlier copy ({', '.join(left)}): copy it once more",
            )
        for file in entry.files:
            defect = defect_of(store, entry, file)
            if defect:
                yield incident_id, defect
        on_progress((number + 1) / len(ids))


def defect_of(store: ArchiveStore, entry: CatalogueEntry, file: ArchivedFile) -> str:
    """Fault of a file as a sentence, after reading all of it; empty if there is none."""
    name = name_in_archive(entry.incident_id, file.stored_name)
    size = store.size(name)
    if size != file.size_bytes:
        if size is None:
            return coded(
                "archive-file-missing",
                "{file} is missing, and should have {bytes} bytes: copy it once more",
                file=file.name,
                bytes=file.size_bytes,
            )
        return coded(
            "archive-file-size",
            "{file} has {there} bytes, and should have {bytes}: copy it once more",
            file=file.name,
            there=size,
            bytes=file.size_bytes,
        )
    digest = hashlib.sha256()
    for part in parts_of(store, entry, file):
        digest.update(part)
    if digest.hexdigest() != file.sha256:
        return coded(
            "archive-file-differs",
            "{file} is not as it was written: copy it once more",
            file=file.name,
        )
    return ""


def fetch_log(
    store: ArchiveStore, entry: CatalogueEntry, out: Path, on_progress: Callable[[float], None]
) -> None:
    """Fetch an incident as one file that stands alone, complete or not at all.

    Raises ArchiveError if it is not as it was written.
    """
    file = entry.file(LOG_NAME)
    digest = hashlib.sha256()
    with whole(out) as making:
        count = 0
        with making.open("wb") as target:
            for part in parts_of(store, entry, file):
                digest.update(part)
                count += target.write(part)
                on_progress(count / file.size_bytes)
        if digest.hexdigest() != file.sha256:
            raise ArchiveError(
                coded(
                    "archive-fetched-differs",
                    "the archive {archive}: {file} of {incident} is not as it was written, and "
                    "{path} was not made: copy it once more while the station has it",
                    archive=store.address,
                    file=file.name,
                    incident=entry.incident_id,
                    path=str(out),
                )
            )


def parts_of(store: ArchiveStore, entry: CatalogueEntry, file: ArchivedFile) -> Iterator[bytes]:
    name = name_in_archive(entry.incident_id, file.stored_name)
    for begin in range(0, file.size_bytes, _PART_BYTES):
        yield store.read(name, begin, min(begin + _PART_BYTES, file.size_bytes))
