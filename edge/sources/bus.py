"""The samples of another unit, as it sends them on the bus: for the agent that tracks for it."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from threading import Event

from edge.raw_stream import batch_of
from edge.samples import SensorBatch, SensorDescription
from edge.sources.port import Outage
from edge.unit_listener import UnitListener
from shared.channels import validate_unit_id
from shared.errors import RecordingError

logger = logging.getLogger(__name__)

_LOOK_S = 0.1


class BusSource:
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
        self.late = 0  # messages that came after later ones, left out

    def follow(self, listener: UnitListener, stop: Event) -> bool:
        """Wait for the unit; False when told to stop before it was heard."""
        self._listener = listener
        self._boot = listener.next_boot(stop)
        return self._boot is not None

    @property
    def description(self) -> SensorDescription:
        return self._heard()[2]

    @property
    def is_live(self) -> bool:
        return False

    @property
    def radio_outages(self) -> tuple[Outage, ...]:
        return ()

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
                self._last_seq = raw.header.seq
                yield batch_of((raw,))

    def close(self) -> None:
        self._closed.set()

    def _heard(self) -> tuple[UnitListener, int, SensorDescription]:
        if self._listener is None or self._boot is None:
            raise RecordingError(
                f"bus:{self.unit_id} is heard by `muster edge run` only, when the unit is there"
            )
        return self._listener, *self._boot
