"""A station's log as an erasure reads it: files, actions of operators, logs that were set aside."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Sequence
from contextlib import AbstractContextManager
from pathlib import Path
from threading import Lock
from typing import Protocol

from base_station.core.erasure.erasure import Record, actions_of
from base_station.storage.data_folder import DataFolder
from shared.channels import CHANNELS, OPERATOR, Direction, tracker_id
from shared.mcap_log import (
    SegmentReader,
    missing_segments,
    read_log,
    segment_number,
    segment_paths,
)
from shared.messages import STATION_ID
from shared.messages.station import OpenIncident, RegisterUnit

_ACTIONS = OPERATOR.key(STATION_ID)


class LogFiles(Protocol):
    """Files of a log; a running station writes on in a new segment while they are rewritten."""

    @property
    def folder(self) -> Path:
        """Folder of the segments."""
        ...

    @property
    def rewriting(self) -> AbstractContextManager[object]:
        """Lock that is held while complete segments are replaced."""
        ...

    def flush(self) -> bool:
        """Bring records in memory to the disk.  True if that was done in time."""
        ...

    def complete_segments(self) -> Collection[Path]:
        """Segments that are not written to any more, in order, without a gap."""
        ...

    def note_rewritten(self, path: Path) -> None:
        """Note that the content of this segment was replaced."""
        ...


class ClosedLog:
    """The log of a folder that no station runs on."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.rewriting = Lock()

    def flush(self) -> bool:
        return True

    def complete_segments(self) -> Collection[Path]:
        return segment_paths(self.folder)

    def note_rewritten(self, path: Path) -> None:
        """Do nothing: no running station has this segment in memory."""


class LogReading:
    """Reading of a log before an erasure rewrites it."""

    def __init__(self, log: LogFiles) -> None:
        self._log = log

    def actions(self) -> Sequence[Record]:
        """Actions of operators in the log, in order; with those that were in memory until now."""
        self._log.flush()
        return list(read_log(self._log.folder, keys={_ACTIONS}))

    def actions_set_aside(self) -> Iterator[Record]:
        """Actions in the logs that stand beside the log."""
        for path in self.set_aside():
            yield from actions_in(path)

    def set_aside(self) -> list[Path]:
        """Parts of logs that stand beside the log in the station's folder."""
        station = self._log.folder.parent
        known = (self._log.folder, DataFolder(station).recordings, DataFolder(station).radio)
        return sorted(
            path
            for path in station.rglob("*.mcap")
            if not any(path.is_relative_to(folder) for folder in known)
        )

    def is_whole(self) -> bool:
        """True where no segment of the log is missing, and the first is there."""
        segments = self._log.complete_segments()
        first = min(map(segment_number, segments), default=None)
        return first is not None and first <= 1 and not missing_segments(segments)

    def first_message_ns(self, actions: Iterable[Record]) -> dict[str, int]:
        """Times of the first messages by unit, of units received before they were registered: such
        a unit belongs to the incident that was then open alone.
        """
        registered_ns: dict[str, int] = {}
        several = False
        for t_ns, action in actions_of(actions):
            match action.action:
                case RegisterUnit(unit_id=unit_id):
                    registered_ns.setdefault(unit_id, t_ns)
                case OpenIncident(beside_others=beside_others):
                    several |= beside_others
        if not (several and registered_ns):
            return {}
        units = {key: one for one in registered_ns for key in _keys_of(one)}
        received_ns: dict[str, int] = {}
        for t_ns, key, _ in read_log(
            self._log.folder, end_ns=max(registered_ns.values()), keys=units
        ):
            if t_ns < registered_ns[units[key]]:
                received_ns.setdefault(units[key], t_ns)
        return received_ns


def actions_in(path: Path) -> Iterator[Record]:
    """Actions of operators in one segment."""
    with SegmentReader(path) as segment:
        yield from segment.records(keys={_ACTIONS})


def _keys_of(unit_id: str) -> list[str]:
    """Log keys of the live messages of a unit, and of an agent that tracks for it."""
    upwards = [one for one in CHANNELS if one.logged and one.direction is Direction.UP]
    return [channel.key(one) for channel in upwards for one in (unit_id, tracker_id(unit_id))]
