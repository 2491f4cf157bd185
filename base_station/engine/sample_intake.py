"""Intake of samples that a unit posts over HTTPS: first into the log, then onto the bus.

The samples go through the engine like those from the bus, and are then published under the unit's
keys for its tracking agent.  A unit that posts sends no description of itself: the intake makes one
for each of its runs, with sequence number 0, which no message of a unit has.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import Future
from concurrent.futures import TimeoutError as FutureTimeoutError
from threading import Lock

import msgspec
import numpy as np

from base_station.core.state.message_stream import BYTES_PER_S
from base_station.engine.admission import Admission
from base_station.engine.ports import DeliveryResult
from base_station.engine.recent_samples import RecentSamples
from base_station.process.token_bucket import TokenBucket
from shared.bus import Bus
from shared.channels import DESCRIPTION, IMU, NO_TRACKER, Channel, raw_journal_key
from shared.clock import NS_PER_S, Clock
from shared.codec import encode
from shared.errors import ConfigError, StoreError, UserError
from shared.messages import Message, RawImu, UnitDescription

BURST_BYTES = 4 * BYTES_PER_S  # samples that a node has kept over a minute without a link
_TIMEOUT_S = 10.0
_SOURCE = "posted"

Deliver = Callable[[Sequence[tuple[str, bytes]]], Future[DeliveryResult]]


class Receipt(msgspec.Struct, frozen=True):
    """Counts of accepted and refused batches of one post."""

    accepted: int  # batches that are in the log now
    repeated: int  # batches that were there already
    samples: int  # of the accepted ones


class _UnitIntake:
    """State of one unit."""

    def __init__(self, now_ns: int) -> None:
        self.lock = Lock()  # one post after the other: the bus has them in the order of the log
        self.allowance = TokenBucket(BYTES_PER_S, BURST_BYTES, now_ns)
        self.description: UnitDescription | None = None  # of the run that posted last
        self.recent = RecentSamples()


class SampleIntake:
    """Intake of all units that post.  Thread-safe."""

    def __init__(self, deliver: Deliver, bus: Bus, clock: Clock) -> None:
        self._deliver = deliver
        self._bus = bus
        self._clock = clock
        self._lock = Lock()
        self._units: dict[str, _UnitIntake] = {}

    def wait_s(self, unit_id: str, size_bytes: int) -> float:
        """Time until the unit may post this amount; 0 if it may now, and then it is counted."""
        unit = self._unit(unit_id)
        now_ns = self._clock.monotonic_ns()
        with self._lock:
            if unit.allowance.take(size_bytes, now_ns):
                return 0.0
        return size_bytes / BYTES_PER_S

    def take(self, unit_id: str, batches: Sequence[RawImu]) -> Receipt:
        """Log and publish batches of one run of the unit, in their order.

        A batch is identified by run and sequence number, and kept once.  Raises UserError if the
        unit has started too often, ConfigError if the sample rate is unknown, and StoreError if the
        samples are not on disk: they are to be posted again.
        """
        unit = self._unit(unit_id)
        with unit.lock:
            description = _description(unit.description, batches)
            messages: list[Message] = [description, *batches]
            encoded = [(_channel(one).key(unit_id), encode(one)) for one in messages]
            admissions = self._delivered(encoded).admissions
            if Admission.RESTART_STORM in admissions:
                raise UserError(
                    f"{unit_id} has started too often within a minute: the boot_id must stay the "
                    "same for as long as its program runs"
                )
            unit.description = description
            for message, (key, payload) in zip(messages, encoded, strict=True):
                if isinstance(message, RawImu):
                    unit.recent.add(message.header.boot_id, message.header.seq, payload)
                self._bus.publish(key, payload, IMU.qos, remote_only=True)
        is_new = [one is not Admission.DUPLICATE for one in admissions[1:]]
        samples = sum(len(one.t_ns) for one, new in zip(batches, is_new, strict=True) if new)
        return Receipt(sum(is_new), len(is_new) - sum(is_new), samples)

    def _delivered(self, encoded: Sequence[tuple[str, bytes]]) -> DeliveryResult:
        try:
            return self._deliver(encoded).result(_TIMEOUT_S)
        except FutureTimeoutError:
            raise StoreError("the station is busy; send the same samples again") from None

    def _unit(self, unit_id: str) -> _UnitIntake:
        with self._lock:
            unit = self._units.get(unit_id)
            if unit is None:
                unit = self._units[unit_id] = _UnitIntake(self._clock.monotonic_ns())
                self._bus.serve(raw_journal_key(unit_id), unit.recent.replies)
            return unit


def _channel(message: Message) -> Channel:
    return DESCRIPTION if isinstance(message, UnitDescription) else IMU


def _description(before: UnitDescription | None, batches: Sequence[RawImu]) -> UnitDescription:
    """Description for the run of the batches.  ``before``: description of the run that posted
    last.
    """
    first = batches[0]
    if before is not None and before.header.boot_id == first.header.boot_id:
        return before
    intervals_ns = np.concatenate([np.diff(batch.t_ns) for batch in batches])
    if not len(intervals_ns):
        raise ConfigError(
            "the first post of a run needs a batch of two samples or more: their times tell the "
            "sample rate"
        )
    return UnitDescription(
        header=msgspec.structs.replace(first.header, seq=0),
        software_version="",
        source=_SOURCE,
        sensor_name="",
        rate_hz=NS_PER_S / float(np.median(intervals_ns)),
        accel_full_scale_mps2=None,
        gyro_full_scale_radps=None,
        tracker=NO_TRACKER,
        calibration="",
        has_magnetometer=first.mag_ut is not None,
        has_barometer=first.pressure_pa is not None,
        has_gps=False,
    )
