"""The samples of another unit, as it sends them on the bus: for the agent that tracks for it."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from threading import Event

from edge.raw.listener import UnitListener
from edge.raw.stream import batch_of
from edge.samples import SensorBatch, SensorDescription
from edge.sources.port import Played
from shared.channels import validate_unit_id
from shared.errors import BusError, RecordingError, WireError
from shared.messages import RawImu

logger = logging.getLogger(__name__)

_LOOK_S = 0.1
_HOLE_NS = 45_000_000  # a message has 50 ms of samples


class BusSource(Played):
    """One run of the unit's program, from what came first until the unit starts again.

    Its times are the unit's clock, not this machine's, so it is placed in time like a recording
    and not live.  Raises ConfigError for what cannot be a unit's id.
    """

    def __init__(self, unit_id: str) -> None:
        self.unit_id = validate_unit_id(unit_id)
        self._listener: UnitListener | None = None
        self._boot: tuple[int, SensorDescription] | None = None
        self._closed = Event()
        self._last_seq = 0
        self._last_ns: int | None = None  # of the last sample
        self.fetched = 0  # messages that the radio lost, out of the unit's journal
        self.late = 0  # messages that came after later ones, left out

    def follow(self, listener: UnitListener, stop: Event) -> bool:
        """Wait for the unit; False when told to stop before it was heard."""
        self._listener = listener
        self._boot = listener.next_boot(stop)
        return self._boot is not None

    @property
    def description(self) -> SensorDescription:
        return self._heard()[2]

    def batches(self) -> Iterator[SensorBatch]:
        listener, boot_id, _ = self._heard()
        while not self._closed.is_set():
            raw = listener.take(boot_id, _LOOK_S)
            if raw is None:
                if listener.has_restarted(boot_id):
                    logger.info("%s has started again", self.unit_id)
                    return
            elif raw.header.seq <= self._last_seq:
                self.late += 1
            else:
                yield from self._missed(listener, raw)
                yield self._taken(raw)

    def _missed(self, listener: UnitListener, raw: RawImu) -> Iterator[SensorBatch]:
        """What the radio lost before this message, out of the unit's journal."""
        if self._last_ns is None or raw.header.seq == self._last_seq + 1:
            return
        if int(raw.t_ns[0]) - self._last_ns <= _HOLE_NS:
            return
        fetched = 0
        try:
            for missed in listener.fetch(raw.header.boot_id, self._last_seq, raw.header.seq):
                fetched += 1
                yield self._taken(missed)
        except (BusError, WireError) as error:
            logger.warning("what was missed of %s cannot be fetched: %s", self.unit_id, error)
        self.fetched += fetched

    def _taken(self, raw: RawImu) -> SensorBatch:
        self._last_seq, self._last_ns = raw.header.seq, int(raw.t_ns[-1])
        return batch_of((raw,))

    def close(self) -> None:
        self._closed.set()

    def _heard(self) -> tuple[UnitListener, int, SensorDescription]:
        if self._listener is None or self._boot is None:
            raise RecordingError(
                f"bus:{self.unit_id} is heard by `muster edge run` only, when the unit is there"
            )
        return self._listener, *self._boot
