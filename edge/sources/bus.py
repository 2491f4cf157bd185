"""Source of the samples of another unit on the bus, for the agent that tracks for it."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from threading import Event

from edge.sample_codec.codec import batch_of
from edge.sample_codec.listener import RawStreamListener
from edge.samples import SensorBatch, SensorDescription
from edge.sources.interface import OfflineSource
from shared.channels import validate_unit_id
from shared.errors import BusError, RecordingError, WireError
from shared.messages import RawImu

logger = logging.getLogger(__name__)

_POLL_S = 0.1
_HOLE_NS = 45_000_000  # a message has 50 ms of samples


class BusSource(OfflineSource):
    """Source of one boot of the unit's agent, from its first message until the unit starts
    again.

    Its times are the unit's clock, not this machine's, so it is placed in time like a recording
    and not live.  Raises ConfigError for what cannot be a unit's id.
    """

    def __init__(self, unit_id: str) -> None:
        self.unit_id = validate_unit_id(unit_id)
        self._listener: RawStreamListener | None = None
        self._boot: tuple[int, dict[str, SensorDescription]] | None = None
        self._closed = Event()
        self._last: dict[str, RawImu] = {}  # by sensor
        self.fetched = 0  # messages that the radio lost, out of the unit's journal
        self.late = 0  # messages that came after later ones, left out

    def follow(self, listener: RawStreamListener, stop: Event) -> bool:
        """Wait for the unit; return False when stopped before."""
        self._listener = listener
        self._boot = listener.next_boot(stop)
        return self._boot is not None

    @property
    def description(self) -> SensorDescription:
        return next(iter(self.sensors.values()))

    @property
    def sensors(self) -> dict[str, SensorDescription]:
        return self._followed()[2]

    def batches(self) -> Iterator[SensorBatch]:
        listener, boot_id, _ = self._followed()
        while not self._closed.is_set():
            raw = listener.take(boot_id, _POLL_S)
            if raw is None:
                if listener.has_restarted(boot_id):
                    logger.info("%s has started again", self.unit_id)
                    return
            elif self._is_late(raw):
                self.late += 1
            else:
                yield from self._backfill(listener, raw)
                yield self._accept(raw)

    def _backfill(self, listener: RawStreamListener, raw: RawImu) -> Iterator[SensorBatch]:
        """Yield from the unit's journal what the radio lost before this message."""
        last = self._last.get(raw.sensor)
        if last is None or raw.header.seq == last.header.seq + 1:
            return
        if int(raw.t_ns[0]) - int(last.t_ns[-1]) <= _HOLE_NS:
            return
        fetched = 0
        try:
            for one in listener.fetch(raw.header.boot_id, last.header.seq, raw.header.seq):
                if not self._is_late(one):  # of another sensor, which was not lost
                    fetched += 1
                    yield self._accept(one)
        except (BusError, WireError) as error:
            logger.warning("what was missed of %s cannot be fetched: %s", self.unit_id, error)
        self.fetched += fetched

    def _is_late(self, raw: RawImu) -> bool:
        last = self._last.get(raw.sensor)
        return last is not None and raw.header.seq <= last.header.seq

    def _accept(self, raw: RawImu) -> SensorBatch:
        self._last[raw.sensor] = raw
        return batch_of((raw,))

    def close(self) -> None:
        self._closed.set()

    def _followed(self) -> tuple[RawStreamListener, int, dict[str, SensorDescription]]:
        if self._listener is None or self._boot is None:
            raise RecordingError(
                f"bus:{self.unit_id} is received by `muster edge run` only, while the unit sends"
            )
        return self._listener, *self._boot
