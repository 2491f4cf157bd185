"""A log with what consoles were shown, of records that a script gave."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Sequence
from itertools import groupby

from base_station.core.events import event_of, is_decision
from base_station.core.pipeline import StationPipeline
from base_station.engine.console_recorder import ConsoleRecorder
from base_station.replay.playback import ReadLog
from shared.channels import OPERATOR
from shared.mcap_log import is_derived
from shared.messages import STATION_ID
from tests.rig.station_script import Record


class ListedLog:
    """A ``Log`` that keeps its records in a list."""

    problem, low_disk_space, is_behind, refuses = "", "", False, False

    def __init__(self) -> None:
        self.records: list[Record] = []

    def write(self, t_ns: int, key: str, payload: bytes) -> bool:
        self.records.append((t_ns, key, payload))
        return True

    def flush(self) -> bool:
        return True


def with_console(records: Iterable[Record], pipeline: StationPipeline) -> tuple[Record, ...]:
    """The records, and behind those of one time what an engine would write of consoles."""
    log = ListedLog()
    recorder = ConsoleRecorder(pipeline, log)
    for _, of_one_time in groupby(records, key=lambda record: record[0]):
        acted = False
        for record in of_one_time:
            log.write(*record)
            if not is_decision(record[1]):
                recorder.publisher.mark_changed(pipeline.step(event_of(*record)))
                acted = acted or record[1] == OPERATOR.key(STATION_ID)
        recorder.record(at_once=acted)
    return tuple(log.records)


def reader(records: Sequence[Record]) -> ReadLog:
    def read(start_ns: int, end_ns: int | None, topics: Collection[str] | None) -> Iterator[Record]:
        for record in records:
            t_ns, key, _ = record
            is_wanted = not is_derived(key) if topics is None else key in topics
            if is_wanted and start_ns <= t_ns and (end_ns is None or t_ns < end_ns):
                yield record

    return read
