"""Source that replays a unit's black box: the same batches that its tracker saw, to the last
bit.
"""

from __future__ import annotations

import logging
from collections.abc import Iterator
from pathlib import Path

from edge.sample_codec.codec import batch_of
from edge.sample_codec.descriptions import sensors_of
from edge.samples import SensorBatch, SensorDescription
from edge.sources.interface import OfflineSource
from shared.channels import DESCRIPTION, Channel, parse_key
from shared.codec import decode
from shared.errors import RecordingError, UnknownChannelError, WireError
from shared.mcap_log import LogRecord, SegmentReader, read_log, segment_paths
from shared.messages import Message, RawImu, UnitDescription

logger = logging.getLogger(__name__)


class BlackBoxSource(OfflineSource):
    """Source; ``path`` is a segment, or the folder of segments of one boot of one unit.

    A black box that is torn is played up to the tear.  Raises RecordingError for what is none.
    """

    def __init__(self, path: Path | str) -> None:
        self._path = Path(path)
        _check(self._path)
        self._unit_id, self._recorded = self._read_description()
        self._sensors = sensors_of(self._recorded)

    @property
    def description(self) -> SensorDescription:
        return next(iter(self._sensors.values()))

    @property
    def sensors(self) -> dict[str, SensorDescription]:
        return self._sensors

    @property
    def unit_id(self) -> str:
        """Sender of the samples: a unit, or the agent that tracked for one."""
        return self._unit_id

    @property
    def recorded(self) -> UnitDescription:
        """Description of the unit by the agent that recorded: its boot, tracker, calibrations."""
        return self._recorded

    def batches(self) -> Iterator[SensorBatch]:
        """Yield batches as they were written: at one instant, inertial samples first; there may
        be none.
        """
        return (batch for _, batch in self.logged_batches())

    def logged_batches(self) -> Iterator[tuple[int, SensorBatch]]:
        """Yield the same with the log time at which each was written."""
        group: list[Message] = []
        group_ns = 0
        for log_ns, message in self._messages():
            if group and (isinstance(message, RawImu) or log_ns != group_ns):
                yield group_ns, batch_of(tuple(group))
                group = []
            group_ns = log_ns
            group.append(message)
        if group:
            yield group_ns, batch_of(tuple(group))

    def _read_description(self) -> tuple[str, UnitDescription]:
        for _, unit_id, channel, payload in self._records():
            if channel is DESCRIPTION:
                description = decode(channel, payload)
                assert isinstance(description, UnitDescription)
                return unit_id, description
        raise RecordingError(
            f"{self._path} does not say which sensor it is from; it is no black box of a unit"
        )

    def _messages(self) -> Iterator[tuple[int, Message]]:
        unreadable = 0
        for log_ns, unit_id, channel, payload in self._records():
            if unit_id != self._unit_id:
                raise RecordingError(
                    f"{self._path} holds several units ({self._unit_id}, {unit_id}); a black box "
                    "holds one"
                )
            if channel is DESCRIPTION:
                continue
            try:
                yield log_ns, decode(channel, payload)
            except WireError:
                unreadable += 1
        if unreadable:
            logger.warning("%s: %d records cannot be understood", self._path, unreadable)

    def _records(self) -> Iterator[tuple[int, str, Channel, bytes]]:
        for log_ns, key, payload in _log_records(self._path):
            try:
                yield log_ns, *parse_key(key), payload
            except UnknownChannelError:
                logger.warning("%s: a record under %s, which is no channel", self._path, key)


def _log_records(path: Path) -> Iterator[LogRecord]:
    if path.is_dir():
        yield from read_log(path, on_damage=logger.warning)
        return
    with SegmentReader(path) as segment:
        yield from segment.records()
        for note in segment.damage:
            logger.warning(note)


def _check(path: Path) -> None:
    if not path.exists():
        raise RecordingError(f"there is no black box at {path}; check the path")
    if path.is_dir() and not segment_paths(path):
        inside = sorted(folder.name for folder in path.glob("*/") if segment_paths(folder))
        hint = f"; choose one of {', '.join(inside)} in it" if inside else ""
        raise RecordingError(f"{path} holds no segments of a black box{hint}")
