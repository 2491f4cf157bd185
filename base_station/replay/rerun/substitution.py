"""The records of a log with sent messages of units replaced by those of a re-run.

Each message stays at its place in the log, under its own number: radio gaps, delays and late
messages of journals are as they were.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping

from base_station.replay.rerun.black_boxes import Run
from base_station.replay.rerun.recorded_runs import wanted_keys
from base_station.replay.rerun.retracked_run import RetrackedRun
from shared.channels import DESCRIPTION, POSITION, STATUS, parse_key
from shared.codec import decode, encode, header_of
from shared.errors import WireError
from shared.mcap_log import LogRecord
from shared.messages import Message, Position, Status, UnitDescription


class Substitution:
    """Counts positions of each unit: all, and those out of a recording."""

    def __init__(self, runs: Mapping[Run, RetrackedRun], from_ns: int, until_ns: int) -> None:
        """``from_ns``, ``until_ns``: station times; records of other times stay as they are."""
        self._runs = runs
        self._keys = wanted_keys((unit_id for unit_id, _ in runs), (POSITION, STATUS, DESCRIPTION))
        self._from_ns = from_ns
        self._until_ns = until_ns
        self.positions: dict[str, int] = {}
        self.retracked: dict[str, int] = {}

    def log(
        self, open_log: Callable[[int], Iterable[LogRecord]]
    ) -> Callable[[int], Iterable[LogRecord]]:
        """The log with the new messages, from a station time on."""
        return lambda t_ns: self._records(open_log(t_ns))

    def _records(self, records: Iterable[LogRecord]) -> Iterator[LogRecord]:
        for record in records:
            t_ns, key, payload = record
            if key not in self._keys or not self._from_ns <= t_ns <= self._until_ns:
                yield record
                continue
            header = header_of(payload)
            run = None if header is None else self._runs.get((header.unit_id, header.boot_id))
            message = None if run is None else _decoded(key, payload)
            if run is None or message is None:
                yield record
                continue
            new = self._new(run, message)
            if new is not None:
                yield t_ns, key, encode(new)

    def _new(self, run: RetrackedRun, message: Message) -> Message | None:
        """None: there is nothing in its place."""
        match message:
            case Position():
                unit_id = message.header.unit_id
                self.positions[unit_id] = self.positions.get(unit_id, 0) + 1
                new = run.position(message)
                if new is not None and new is not message:
                    self.retracked[unit_id] = self.retracked.get(unit_id, 0) + 1
                return new
            case Status():
                return run.status(message)
            case UnitDescription():
                return run.describe(message)
        return message


def _decoded(key: str, payload: bytes) -> Message | None:
    """None: it cannot be read, and goes on as it is."""
    try:
        return decode(parse_key(key)[1], payload)
    except WireError:
        return None
