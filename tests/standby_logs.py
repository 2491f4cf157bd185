"""Events for the logs of two stations, and writing them with what is decided from them."""

from __future__ import annotations

from base_station.feed import LogFeed
from base_station.recorder import Recorder
from base_station.standby.shared_log import SharedLog
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
    return LogFeed(recorder.folder, recorder.flush)
