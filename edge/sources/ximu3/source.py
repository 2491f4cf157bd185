"""Source of an x-io x-IMU3, over Wi-Fi (TCP) or a cable (USB, serial).

The device is read and never configured: its settings are its owner's.  While it is off, out of
reach or sends nonsense, the source reports why and tries again, and never ends.
"""

from __future__ import annotations

import logging
from collections import deque
from collections.abc import Iterator
from contextlib import closing
from dataclasses import dataclass
from threading import Event

import numpy as np

from edge.fault_texts import fault_of, no_samples
from edge.samples import (
    ACKNOWLEDGE,
    BatterySample,
    ButtonPress,
    ElectronicsSample,
    ImuBatch,
    OtherSample,
    SensorBatch,
    SensorDescription,
)
from edge.sources.device_clock import DeviceClock
from edge.sources.interface import Outage
from edge.sources.transport.address import (
    BAUD,
    TransportAddress,
    explain_os_error,
    parse_address,
    parse_options,
)
from edge.sources.transport.connection import Connection
from edge.sources.ximu3.message_monitor import MessageMonitor
from edge.sources.ximu3.messages import (
    ACCEL_FULL_SCALE_G,
    GYRO_FULL_SCALE_DPS,
    BatteryMessage,
    Button,
    Frames,
    Inertial,
    MagnetometerMessage,
    Message,
    Notification,
    TemperatureMessage,
    Vector,
    message_of,
)
from shared.clock import NS_PER_S, Clock, SystemClock
from shared.coded_text import coded
from shared.errors import WireError

logger = logging.getLogger(__name__)

_PORT = 7000
_BAUD = 115200
_RATE_HZ = 400.0
_OPTIONS = {"baud": BAUD, "rate": (10.0, 400.0), "field": (10.0, 100.0)}  # least, most
_G_MPS2 = 9.80665
_BATCH_NS = NS_PER_S // 20
_SILENT_NS = 3 * NS_PER_S
_RETRY_S = 1.0
_FAULTS_MAX = 100  # faults that were not taken; the oldest are dropped
_ERRORS_MAX = 20  # different errors of the device that are reported
_SENSOR = "x-IMU3"  # name of its temperature
_NOTHING: Vector = (np.nan, np.nan, np.nan)


@dataclass(frozen=True, slots=True)
class Ximu3Settings:
    line: TransportAddress
    rate_hz: float
    field_ut: float | None  # where its magnetometer was calibrated; None: it is not used

    def __str__(self) -> str:
        return f"x-IMU3 at {self.line}"


def parse_settings(text: str) -> Ximu3Settings:
    """Return the settings in ``tcp://HOST[:PORT]`` or ``/dev/PATH``, with
    ``?baud=&rate=&field=``.

    Raises ConfigError.
    """
    values = parse_options("ximu3", text, _OPTIONS)
    line = parse_address("ximu3", text, values, port=_PORT, baud=_BAUD)
    return Ximu3Settings(line, values.get("rate", _RATE_HZ), values.get("field"))


class Ximu3Source:
    """``text`` is ``tcp://HOST:PORT`` or a serial port's path, with ``?rate=400`` and others.

    Raises ConfigError for what names neither.
    """

    def __init__(self, text: str, clock: Clock | None = None) -> None:
        self._settings: Ximu3Settings = parse_settings(text)
        self._clock = clock or SystemClock()
        self._closed = Event()
        self._device_clock = DeviceClock()
        self._monitor = MessageMonitor(self._settings.rate_hz)
        self._rows = _Rows(self._settings.field_ut)
        self._faults: deque[str] = deque(maxlen=_FAULTS_MAX)
        self._silence_reasons: set[str] = set()  # why there have been no samples since the last one
        self._reported: deque[str] = deque(maxlen=_ERRORS_MAX)  # since the line is open
        self.taken = 0  # inertial samples

    @property
    def garbled(self) -> int:
        """Messages that could not be parsed, or had an impossible time."""
        return self._monitor.garbled + self._device_clock.implausible

    @property
    def repeated(self) -> int:
        """Inertial messages of a time that had been, left out."""
        return self._device_clock.repeated

    @property
    def description(self) -> SensorDescription:
        return SensorDescription(
            name="x-io x-IMU3",
            rate_hz=self._settings.rate_hz,
            accel_full_scale_mps2=ACCEL_FULL_SCALE_G * _G_MPS2,
            gyro_full_scale_radps=float(np.radians(GYRO_FULL_SCALE_DPS)),
            mag_present=self._settings.field_ut is not None,
        )

    @property
    def is_live(self) -> bool:
        return True

    @property
    def radio_outages(self) -> tuple[Outage, ...]:
        return ()

    def take_faults(self) -> tuple[str, ...]:
        """Return faults of the device, once each, for a person; from any thread."""
        return tuple(self._faults.popleft() for _ in range(len(self._faults)))

    def close(self) -> None:
        self._closed.set()

    def batches(self) -> Iterator[SensorBatch]:
        """Yield batches until it is closed; wait for the device as long as that takes."""
        while not self._closed.is_set():
            try:
                with closing(self._settings.line.open()) as line:
                    yield from self._read(line)
            except OSError as error:
                self._report_silence(explain_os_error(error, self._settings.line))
            if len(self._rows):
                yield self._rows.cut()
            self._closed.wait(_RETRY_S)
        logger.info(
            "%s: %d samples; %d messages could not be read or placed, %d came twice",
            self._settings,
            self.taken,
            self.garbled,
            self.repeated,
        )

    def _read(self, line: Connection) -> Iterator[SensorBatch]:
        """Read a connection that has just been opened, until it is of no use any more."""
        frames = Frames()
        self._device_clock.reopened()
        self._monitor.on_open()
        self._reported.clear()
        last_ns = self._clock.monotonic_ns()
        while not self._closed.is_set():
            data = line.read()
            if data == b"":
                self._report_silence(
                    coded("ximu-ended", "it has ended the connection; is it on, and charged?")
                )
                return
            arrival_ns = self._clock.monotonic_ns()
            before = self.taken
            self._take_all(self._messages(frames.push(data or b"")), arrival_ns)
            if self.taken > before:
                last_ns = arrival_ns
                self._report_return()
            elif arrival_ns - last_ns > _SILENT_NS:
                self._report_silence(self._monitor.silence_reason())
                return
            for fault in (
                *self._device_clock.take_events(),
                *self._monitor.take_events(arrival_ns),
            ):
                self._report_fault(fault)
            if len(self._rows) and (data is None or self._rows.span_ns >= _BATCH_NS):
                yield self._rows.cut()

    def _messages(self, frames: list[bytes]) -> list[Message]:
        messages = []
        for frame in frames:
            try:
                message = message_of(frame)
            except WireError as error:
                self._monitor.count_garbled(frame, error)
                continue
            self._monitor.count(message)
            messages.append(message)
        return messages

    def _take_all(self, messages: list[Message], arrival_ns: int) -> None:
        """Take messages that came at once: the newest shows the delay of the others."""
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
            case MagnetometerMessage():
                self._rows.mag = message.field
            case TemperatureMessage():
                self._rows.temperature_degc = message.temperature_degc
            case BatteryMessage():
                self._rows.battery = message
            case Button():
                self._rows.take_button(is_down=message.is_down)
            case Notification(text=text, is_error=True) if text not in self._reported:
                self._reported.append(text)
                self._report_fault(coded("ximu-error", "it reports an error: {error}", error=text))
            case Notification(text=text):
                logger.info("%s says: %s", self._settings, text)

    def _report_silence(self, reason: str) -> None:
        """Report each reason once, however often it is tried again."""
        if reason not in self._silence_reasons:
            self._silence_reasons.add(reason)
            self._report_fault(no_samples(reason))

    def _report_return(self) -> None:
        if self._silence_reasons:
            logger.info("%s sends samples again", self._settings)
        self._silence_reasons.clear()

    def _report_fault(self, fault: str) -> None:
        logger.warning("%s: %s", self._settings, fault)
        self._faults.append(fault_of(str(self._settings), fault))


class _Rows:
    """Collector of the samples of the next batch.

    What comes more rarely stands in the row that follows it; elsewhere it is NaN.
    """

    def __init__(self, field_ut: float | None) -> None:
        self._field_ut = field_ut
        self._t_ns: list[int] = []
        self._inertial: list[Vector] = []
        self._mag: list[Vector] = []
        self._degc: list[float] = []
        self._others: list[OtherSample] = []
        self._button_is_down = False
        self._is_pressed = False  # since the row before
        self.mag: Vector | None = None
        self.temperature_degc: float | None = None
        self.battery: BatteryMessage | None = None

    def __len__(self) -> int:
        return len(self._t_ns)

    @property
    def span_ns(self) -> int:
        return self._t_ns[-1] - self._t_ns[0]

    def take_button(self, *, is_down: bool) -> None:
        """Held, it switches the device off: a press of any length acknowledges."""
        self._is_pressed = self._is_pressed or (is_down and not self._button_is_down)
        self._button_is_down = is_down

    def add(self, t_ns: int, inertial: Inertial) -> None:
        self._t_ns.append(t_ns)
        self._inertial += [inertial.accel_g, inertial.gyro_dps]
        self._mag.append(self.mag or _NOTHING)
        self._degc.append(np.nan if self.temperature_degc is None else self.temperature_degc)
        if self.temperature_degc is not None:
            self._others.append(ElectronicsSample(t_ns, self.temperature_degc, _SENSOR))
        if self.battery is not None:
            level, state = self.battery.level, self.battery.state
            self._others.append(BatterySample(t_ns, level, state=state))
        if self._is_pressed:
            self._others.append(ButtonPress(t_ns, ACKNOWLEDGE))
        self.mag = self.temperature_degc = self.battery = None
        self._is_pressed = False

    def cut(self) -> SensorBatch:
        """Return everything so far."""
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
