"""Live view of a station in Foxglove: follows its log, where everything is within half a second."""

from __future__ import annotations

import logging
from collections.abc import Callable
from pathlib import Path
from threading import Event

from base_station.foxglove.server import FoxgloveServer
from shared.mcap_log import LogRecord, LogTail

logger = logging.getLogger(__name__)

_TURN_S = 0.1


def follow(log: Path, server: FoxgloveServer, stop: Event) -> None:
    """Publish the records that a station writes to its log, until ``stop`` is set.

    It begins with the newest message of each topic of the newest segment.
    """
    with LogTail(log) as tail:
        server.publish(_newest_of_each_topic(tail.read))
        while not stop.is_set():
            records = tail.read()
            server.publish(records)
            server.work()
            while tail.damage:
                logger.warning("%s", tail.damage.pop())
            if not records:
                stop.wait(_TURN_S)


def _newest_of_each_topic(read: Callable[[], list[LogRecord]]) -> list[LogRecord]:
    newest: dict[str, LogRecord] = {}
    while records := read():
        newest |= {record[1]: record for record in records}
    return sorted(newest.values())
