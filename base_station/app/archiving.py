"""Archive of a live station: copies incidents into it."""

from __future__ import annotations

from collections.abc import Callable

from base_station.app.resources import Resources
from base_station.archive.automatic import ArchivingContext, AutomaticArchive
from base_station.replay.processes.server import ReplayProcesses
from base_station.storage.db.archived import ArchivedCopies


def automatic_archive(
    resources: Resources, processes: ReplayProcesses, leads: Callable[[], bool]
) -> AutomaticArchive | None:
    """Return the archive of the settings; None if they have none.  Raises ConfigError if it needs a
    library that is missing.
    """
    config, disk = resources.config.archive, resources.disk
    if config is None:
        return None
    place = ArchivingContext(
        start=processes.start,
        log=str(disk.folder.log),
        database=str(disk.folder.database),
        prepare=disk.recorder.flush,
        note_damage=disk.check.recheck,
        leads=leads,
    )
    return AutomaticArchive(config, place, ArchivedCopies(disk.store), disk.clock)
