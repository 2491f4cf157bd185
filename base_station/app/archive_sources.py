"""Sources of the archive's commands: a station's folder, or a copy in the archive itself."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

from base_station.app.offline_log import OfflineLog, Report
from base_station.archive.archived_files import ArchivedImports, ArchivedRadio
from base_station.archive.catalogue import require_entry
from base_station.archive.copying import ArchiveCopier
from base_station.archive.feed import ArchivedFeed
from base_station.archive.store import ArchiveStore, open_store
from base_station.engine.log_feed import FolderFeed
from base_station.radio.radio_log import RadioLog
from base_station.storage.data_folder import DataFolder
from base_station.storage.db.incident_rows import put_rows
from base_station.storage.db.opening import open_database
from base_station.storage.db.roster import Roster
from base_station.storage.db.store import Store
from base_station.storage.imports import ImportFolder
from base_station.storage.log_defects import LogDefects
from shared.clock import SystemClock
from shared.coded_text import coded


@contextmanager
def open_copier(archive: str, data: Path, *, with_radio: bool = False) -> Iterator[ArchiveCopier]:
    """Open what makes copies from a folder, beside a running station or without one."""
    folder = DataFolder(data)
    folder.require()
    target = open_store(archive)
    with open_database(folder.require_database()) as store:
        yield ArchiveCopier(
            target, store, FolderFeed(folder.log), SystemClock(), ImportFolder(folder.imports),
            RadioLog(folder.radio) if with_radio else None,
        )  # fmt: skip


NOT_FETCHED = coded(
    "replay-from-archive",
    "it is shown from the archive: tracks, reports and assessments need all of it, which "
    "muster base archive fetch brings",
)


def open_archived_log(
    archive: ArchiveStore, incident_id: str, closing: ExitStack, report: Report
) -> OfflineLog:
    """Open the log of an archived incident; its content is fetched when it is read.  Raises
    ArchiveError.
    """
    entry = require_entry(archive, incident_id)
    scratch = Path(closing.enter_context(TemporaryDirectory(prefix="muster-archived-")))
    folder = DataFolder(scratch)
    store = closing.enter_context(Store(folder.database))
    put_rows(store, entry.tables)
    Roster(store, SystemClock()).add_unknown_people(entry.people)
    defects = LogDefects(folder.log, (), is_written=False, on_defect=report)
    for words in (*entry.damage_texts(), NOT_FETCHED):
        defects.note(words)
    files = {one.name: one for one in entry.files}
    log = ArchivedFeed(archive, incident_id, files, entry.log_id, defects.note_damage)
    return OfflineLog(
        folder,
        store,
        folder.database,
        keeps_result=False,
        scratch=scratch,
        log=log,
        defects=defects,
        report=report,
        imports=ArchivedImports(folder.imports, archive, entry),
        radio=ArchivedRadio(folder.radio, archive, entry),
        log_of=lambda _: (log, defects),
    )
