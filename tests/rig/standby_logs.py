"""Events for the logs of two stations, written with what is decided from them; a full disk."""

from __future__ import annotations

from base_station.engine.log_feed import FolderFeed, LogFeed
from base_station.standby.shared_log import SharedLog
from base_station.storage.recorder import Recorder
from shared.channels import FUSED, TICK
from shared.messages import STATION_ID

Record = tuple[int, str, bytes]
T0 = 1_700_000_000_000_000_000
TICKED = TICK.key(STATION_ID)


def events(count: int, start: int = 0) -> list[Record]:
    """Every third has the time of the one before it, and decisions stand between them."""
    return [
        (T0 + number - (number % 3 == 2), TICKED, b"event %d" % number)
        for number in range(start, start + count)
    ]


def written(recorder: Recorder, log: SharedLog, records: list[Record]) -> None:
    for t_ns, key, payload in records:
        log.write(t_ns, key, payload)
        log.write(t_ns, FUSED.key(STATION_ID), b"decided")
    assert recorder.flush()


def disk(recorder: Recorder) -> LogFeed:
    return FolderFeed(recorder.folder, recorder.flush)


class FullDisk:
    """A ``Log`` that takes as much as it has room for."""

    problem, low_disk_space = "the log cannot be written", "only 1 MB is free"
    is_behind = refuses = False

    def __init__(self) -> None:
        self.room = 0
        self.kept: list[Record] = []

    def write(self, t_ns: int, key: str, payload: bytes) -> bool:
        self.room -= 1
        if self.room >= 0:
            self.kept.append((t_ns, key, payload))
        return self.room >= 0

    def flush(self) -> bool:
        return True
