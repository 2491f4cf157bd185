"""Layout of a station's data folder."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator
from pathlib import Path

from base_station.storage.db.server_address import noted_server
from base_station.storage.recorder import LOG_FOLDER
from shared.errors import LogError, StoreError
from shared.folder_lock import FolderLock
from shared.mcap_log import SegmentInfo, SegmentReader, SegmentState, own_segments
from shared.own_files import refuse_links


class DataFolder:
    def __init__(self, path: Path) -> None:
        self.path = path
        self.log = path / LOG_FOLDER
        self.checkpoints = path / "checkpoints"
        self.recordings = path / "recordings"  # of units' raw sensors, pulled on request
        self.radio = path / "radio"  # audio of radio channels
        self.imports = path / "imports"  # files imported into incidents
        self.database = path / "station.sqlite"
        self.tables_behind = path / "tables-behind"  # since when, while the server is away
        self.erasure_jobs = path / "forgetting.json"
        # Erasures of incidents in progress, with the people that they concern
        self.pending_erasures = path / "forgetting-begun.json"
        # Erasures that wait at the leader of a pair, copied from it
        self.leader_requests = path / "forgetting-of-leader.json"
        self.first_login = path / "first-login.txt"

    def require(self) -> None:
        """LogError where there is nothing to read, LinkRefusedError where links lead out."""
        if not self.log.is_dir():
            raise LogError(f"there is no station's log in {self.path}; give the folder with --data")
        refuse_links(self.path)

    def require_database(self) -> Path:
        """The file, beside which a note may name a server instead (``db.opening``); StoreError
        where no station has ever run here.
        """
        if not self.has_database():
            raise StoreError(
                f"there is no station's database in {self.path}; give the folder with --data, or "
                "start the station there once"
            )
        refuse_links(self.path)
        return self.database

    def has_database(self) -> bool:
        return self.database.exists() or noted_server(self.database) is not None

    def segments(self) -> Iterator[SegmentInfo]:
        """Segments of the log, in the order of writing; the last one is open while a station writes
        it.  Raises LogError when one is removed meanwhile.
        """
        is_written = FolderLock.is_held(self.path)
        paths, _ = own_segments(self.log)
        for path in paths:
            with SegmentReader(path) as reader:
                info = reader.info()
            if is_written and path == paths[-1] and info.state is SegmentState.TORN:
                info = dataclasses.replace(info, state=SegmentState.OPEN)
            yield info

    def recorded_until_ns(self) -> int:
        """Last log time, in station time: the station's clock may be another than this machine's,
        or have stopped; 0: nothing is recorded.
        """
        return max((segment.end_ns for segment in self.segments()), default=0)

    def lock(self) -> FolderLock:
        """Lock the folder to change it; DataFolderInUseError while a station uses it."""
        return FolderLock(self.path, "station", "stop it first")
