"""An x-io x-IMU3 worn by this unit's wearer, over Wi-Fi (TCP) or a cable (USB, serial).

The device is listened to and never told anything: how it is set is its owner's business.  While it
is off, out of reach or talks nonsense, the source says why and tries again, and never ends.
"""

from __future__ import annotations

import logging
from collections import deque
from collections.abc import Iterator
from contextlib import closing
from threading import Event

import numpy as np

from edge.samples import BatterySample, ImuBatch, SensorBatch, SensorDescription
from edge.sources.device_clock import DeviceClock
from edge.sources.line import Line
from edge.sources.line_place import why_not
from edge.sources.port import Outage
from edge.sources.ximu3_messages import (
    ACCEL_FULL_SCALE_G,
    GYRO_FULL_SCALE_DPS,
    Battery,
    Frames,
    Inertial,
    Magnetometer,
    Message,
    Notice,
    Temperature,
    Vector,
    message_of,
)
from edge.sources.ximu3_place import Place, place_of
from edge.sources.ximu3_watch import Watch
from shared.clock import NS_PER_S, Clock, SystemClock
from shared.errors import WireError

logger = logging.getLogger(__name__)

_G_MPS2 = 9.80665
_BATCH_NS = NS_PER_S // 20
_SILENT_NS = 3 * NS_PER_S
_AGAIN_S = 1.0
_MOST_TOLD = 100  # faults that nobody took; the oldest are left out
_MOST_REPORTED = 20  # errors of the device that are told from one another
_NOTHING: Vector = (np.nan, np.nan, np.nan)


class Ximu3Source:
    """``text`` is ``tcp://HOST:PORT`` or a serial port's path, with ``?rate=400`` and others.

    Raises ConfigError for what names neither.
    """

    def __init__(self, text: str, clock: Clock | None = None) -> None:
        self._place: Place = place_of(text)
        self._clock = clock or SystemClock()
        self._closed = Event()
        self._device_clock = DeviceClock()
        self._watch = Watch(self._place.rate_hz)
        self._rows = _Rows(self._place.field_ut)
        self._faults: deque[str] = deque(maxlen=_MOST_TOLD)
        self._gone: set[str] = set()  # why there have been no samples since the last one
        self._reported: deque[str] = deque(maxlen=_MOST_REPORTED)  # since the line is open
        self.taken = 0  # inertial samples

    @property
    def garbled(self) -> int:
        """What was said that is no message, or had an impossible time."""
        return self._watch.garbled + self._device_clock.doubted

    @property
    def repeated(self) -> int:
        """Inertial messages of a time that had been, left out."""
        return self._device_clock.repeated

    @property
    def description(self) -> SensorDescription:
        return SensorDescription(
            name="x-io x-IMU3",
            rate_hz=self._place.rate_hz,
            accel_full_scale_mps2=ACCEL_FULL_SCALE_G * _G_MPS2,
            gyro_full_scale_radps=float(np.radians(GYRO_FULL_SCALE_DPS)),
            mag_present=self._place.field_ut is not None,
        )

    @property
    def is_live(self) -> bool:
        return True

    @property
    def radio_outages(self) -> tuple[Outage, ...]:
        return ()

    def take_faults(self) -> tuple[str, ...]:
        """What a person must hear of the device, once each; from any thread."""
        return tuple(self._faults.popleft() for _ in range(len(self._faults)))

    def close(self) -> None:
        self._closed.set()

    def batches(self) -> Iterator[SensorBatch]:
        """Until it is closed; waits for the device as long as that takes."""
        while not self._closed.is_set():
            try:
                with closing(self._place.line.open()) as line:
                    yield from self._listened(line)
            except OSError as error:
                self._say_gone(why_not(error, self._place.line))
            if len(self._rows):
                yield self._rows.cut()
            self._closed.wait(_AGAIN_S)
        logger.info(
            "%s: %d samples; %d messages could not be read or placed, %d came twice",
            self._place,
            self.taken,
            self.garbled,
            self.repeated,
        )

    def _listened(self, line: Line) -> Iterator[SensorBatch]:
        """From a line that has just been opened, until it is of no use any more."""
        frames = Frames()
        self._device_clock.reopened()
        self._watch.opened()
        self._reported.clear()
        last_ns = self._clock.monotonic_ns()
        while not self._closed.is_set():
            said = line.read()
            if said == b"":
                self._say_gone("it has ended the connection; is it on, and charged?")
                return
            arrival_ns = self._clock.monotonic_ns()
            before = self.taken
            self._take_all(self._messages(frames.push(said or b"")), arrival_ns)
            if self.taken > before:
                last_ns = arrival_ns
                self._say_back()
            elif arrival_ns - last_ns > _SILENT_NS:
                self._say_gone(self._watch.why_no_samples())
                return
            for fault in (*self._device_clock.told(), *self._watch.told(arrival_ns)):
                self._say(fault)
            if len(self._rows) and (said is None or self._rows.span_ns >= _BATCH_NS):
                yield self._rows.cut()

    def _messages(self, frames: list[bytes]) -> list[Message]:
        messages = []
        for frame in frames:
            try:
                message = message_of(frame)
            except WireError as error:
                self._watch.note_garbled(frame, error)
                continue
            self._watch.note(message)
            messages.append(message)
        return messages

    def _take_all(self, messages: list[Message], arrival_ns: int) -> None:
        """Of messages that came at once the newest says how late they are: others had to wait."""
        newest_us = max((one.t_us for one in messages if isinstance(one, Inertial)), default=0)
        for message in messages:
            waited_ns = 0
            if isinstance(message, Inertial):
                waited_ns = 1000 * (newest_us - message.t_us)
            self._take(message, arrival_ns - (waited_ns if waited_ns < NS_PER_S else 0))

    def _take(self, message: Message, arrival_ns: int) -> None:
        match message:
            case Inertial():
                t_ns = self._device_clock.place(message.t_us * 1000, arrival_ns)
                if t_ns is not None:
                    self._rows.add(t_ns, message)
                    self.taken += 1
            case Magnetometer():
                self._rows.mag = message.field
            case Temperature():
                self._rows.temperature_degc = message.temperature_degc
            case Battery():
                self._rows.battery = message.level
            case Notice(text=text, is_error=True) if text not in self._reported:
                self._reported.append(text)
                self._say(f"it reports an error: {text}")
            case Notice(text=text):
                logger.info("%s says: %s", self._place, text)

    def _say_gone(self, why: str) -> None:
        """Each reason once, however often it is tried again."""
        if why not in self._gone:
            self._gone.add(why)
            self._say(f"no samples: {why}")

    def _say_back(self) -> None:
        if self._gone:
            logger.info("%s sends samples again", self._place)
        self._gone.clear()

    def _say(self, fault: str) -> None:
        logger.warning("%s: %s", self._place, fault)
        self._faults.append(f"{self._place}: {fault}")


class _Rows:
    """Samples that make the next batch.

    What comes more rarely stands in the row that follows it; elsewhere it is NaN.
    """

    def __init__(self, field_ut: float | None) -> None:
        self._field_ut = field_ut
        self._t_ns: list[int] = []
        self._inertial: list[Vector] = []
        self._mag: list[Vector] = []
        self._degc: list[float] = []
        self._others: list[BatterySample] = []
        self.mag: Vector | None = None
        self.temperature_degc: float | None = None
        self.battery: float | None = None

    def __len__(self) -> int:
        return len(self._t_ns)

    @property
    def span_ns(self) -> int:
        return self._t_ns[-1] - self._t_ns[0]

    def add(self, t_ns: int, inertial: Inertial) -> None:
        self._t_ns.append(t_ns)
        self._inertial += [inertial.accel_g, inertial.gyro_dps]
        self._mag.append(self.mag or _NOTHING)
        self._degc.append(np.nan if self.temperature_degc is None else self.temperature_degc)
        if self.battery is not None:
            self._others.append(BatterySample(t_ns, self.battery))
        self.mag = self.temperature_degc = self.battery = None

    def cut(self) -> SensorBatch:
        """Everything so far."""
        inertial = np.array(self._inertial).reshape(-1, 2, 3)
        mag_ut = None if self._field_ut is None else self._field_ut * np.array(self._mag)
        imu = ImuBatch(
            t_ns=np.array(self._t_ns, dtype=np.int64),
            accel_mps2=_G_MPS2 * inertial[:, 0],
            gyro_radps=np.radians(inertial[:, 1]),
            mag_ut=mag_ut,
            imu_temperature_degc=np.array(self._degc),
        )
        batch = SensorBatch(imu, tuple(self._others))
        for column in (self._t_ns, self._inertial, self._mag, self._degc, self._others):
            column.clear()
        return batch
