"""Source of an inertial sensor that the kernel's Industrial I/O drives.

While a device is missing, does not answer or gives unusable values, the source reports the reason
and tries again; it never ends.  Every sample was measured: none is interpolated or repeated.
"""

from __future__ import annotations

import logging
import select
from collections import deque
from collections.abc import Iterator
from contextlib import ExitStack, closing
from pathlib import Path
from threading import Event

from edge.fault_texts import fault_of, no_samples
from edge.samples import SensorBatch, SensorDescription
from edge.sources.iio.attributes import UnusableDeviceError
from edge.sources.iio.block import Block, DeviceReader
from edge.sources.iio.captured_mag import CapturedMagnetometer
from edge.sources.iio.conversion import ACCEL, GYRO, MAG
from edge.sources.iio.device import InertialDevice, Machine, find_inertial_devices
from edge.sources.iio.joined_timeline import JoinedTimeline
from edge.sources.iio.plan import USUAL_RATE_HZ
from edge.sources.iio.rows import Rows
from edge.sources.iio.settings import IioSettings, parse_settings
from edge.sources.iio.slow_sensors import SlowSensor, open_barometer, open_magnetometer
from edge.sources.interface import Outage
from edge.sources.sysfs import SYSFS, explain_read_error
from shared.clock import NS_PER_S, Clock, SystemClock
from shared.coded_text import CodedText, coded, text_of_error

logger = logging.getLogger(__name__)

_DEVICES = Path("/dev")
_BATCH_NS = NS_PER_S // 25  # and a period or two more
_SILENT_NS = 3 * NS_PER_S
_RETRY_S = 1.0
_QUICK_RETRY_S = 0.05  # after samples: a single read may fail
_FAULTS_MAX = 100  # faults that were not taken; the oldest are dropped
_RATE_OFF = 0.05  # of the rate that was described


class IioSource:
    """``text`` is ``DEVICE`` or ``ACCEL+GYRO``, with ``?rate=400`` and others.

    Raises ConfigError for what names neither.
    """

    def __init__(
        self,
        text: str,
        clock: Clock | None = None,
        sysfs: Path = SYSFS,
        devices: Path = _DEVICES,
    ) -> None:
        self._settings: IioSettings = parse_settings(text)
        self._clock = clock or SystemClock()
        self._machine = Machine(sysfs, devices)
        self._closed = Event()
        self._faults: deque[str] = deque(maxlen=_FAULTS_MAX)
        self._silence_reasons: set[str] = set()  # why there have been no samples since the last one
        self._remarks: set[str] = set()  # on how it is set; once each
        mag, pressure = self._settings.separate_mag, self._settings.pressure
        self._mag: SlowSensor | None = None  # one that is read apart
        if mag is not None:
            self._mag = open_magnetometer(mag, sysfs, self._clock)
        self._captured_mag = CapturedMagnetometer()
        self._barometer: SlowSensor | None = None
        if pressure is not None:
            self._barometer = open_barometer(pressure, sysfs, self._clock)
        self._description = self._describe()
        self._rows = Rows(
            str(self._settings), mag=self._description.mag_present, pressure=pressure is not None
        )
        self.taken = 0  # inertial samples
        self.left_out = 0  # of the gyroscope, as there was no acceleration beside them

    @property
    def description(self) -> SensorDescription:
        return self._description

    @property
    def is_live(self) -> bool:
        return True

    @property
    def radio_outages(self) -> tuple[Outage, ...]:
        return ()

    def take_faults(self) -> tuple[str, ...]:
        """Return faults of the devices, once each, for a person; from any thread."""
        own = tuple(self._faults.popleft() for _ in range(len(self._faults)))
        return own + tuple(fault for sensor in self._slow() for fault in sensor.take_faults())

    def close(self) -> None:
        self._closed.set()

    def batches(self) -> Iterator[SensorBatch]:
        """Yield batches until it is closed; wait for the devices as long as that takes."""
        with ExitStack() as stack:
            for sensor in self._slow():
                stack.enter_context(closing(sensor))
                sensor.start()
            while not self._closed.is_set():
                before = self.taken
                try:
                    yield from self._read()
                except OSError as error:
                    self._report_silence(explain_read_error(error))
                except UnusableDeviceError as error:
                    self._report_silence(text_of_error(error))
                if len(self._rows):
                    yield self._cut()
                self._closed.wait(_RETRY_S if self.taken == before else _QUICK_RETRY_S)
        logger.info(
            "%s: %d samples; %d of the gyroscope had no acceleration beside them",
            *(self, self.taken, self.left_out),
        )

    def __str__(self) -> str:
        return str(self._title)

    @property
    def _title(self) -> CodedText:
        return coded("device-inertial", "inertial sensor {name}", name=str(self._settings))

    def _slow(self) -> tuple[SlowSensor, ...]:
        return tuple(sensor for sensor in (self._mag, self._barometer) if sensor is not None)

    def _describe(self) -> SensorDescription:
        """Describe the present devices; others are described by the settings alone."""
        rate_hz = self._settings.rate_hz or USUAL_RATE_HZ
        full_scales: dict[str, float] = {}
        has_mag = self._settings.mag is not None
        try:
            devices = find_inertial_devices(self._settings, self._machine)
            rate_hz = devices[-1].plan.rate_hz
            for device in devices:
                full_scales |= device.plan.full_scales
                has_mag = has_mag or device.has_mag
        except (OSError, UnusableDeviceError) as error:
            logger.info("%s is not described: %s", self, error)
        return SensorDescription(
            name=str(self._settings),
            rate_hz=rate_hz,
            accel_full_scale_mps2=full_scales.get(ACCEL),
            gyro_full_scale_radps=full_scales.get(GYRO),
            mag_present=has_mag,
            barometer_present=self._barometer is not None,
        )

    def _read(self) -> Iterator[SensorBatch]:
        """Open the devices and read them, until one is of no use any more.

        Raises OSError and UnusableDeviceError.
        """
        devices = find_inertial_devices(self._settings, self._machine)
        with ExitStack() as stack:
            readers = [stack.enter_context(closing(one.open(self._clock))) for one in devices]
            self._report_remarks(devices)
            self._open_own_mag(devices, stack)
            joined = JoinedTimeline(readers[0].rate_hz) if len(readers) > 1 else None
            last_ns = [self._clock.monotonic_ns()] * len(readers)
            while not self._closed.is_set():
                has_waited = self._wait(readers)
                for number, reader in enumerate(readers):
                    block = reader.take()
                    if len(block):
                        last_ns[number] = self._clock.monotonic_ns()
                    self._take(block, joined)
                    self._report_events(devices[number], reader)
                if len(self._rows) and (has_waited or self._rows.span_ns >= _BATCH_NS):
                    yield self._cut()
                self._require_samples(devices, readers, last_ns)

    def _open_own_mag(self, devices: list[InertialDevice], stack: ExitStack) -> None:
        """Read the magnetometer of a device that is polled in a thread of its own."""
        own = next((one for one in devices if one.has_mag and not one.is_captured), None)
        if own is None:
            return
        sensor = open_magnetometer(own.name, self._machine.sysfs, self._clock)
        stack.enter_context(closing(sensor))
        stack.callback(setattr, self, "_mag", None)
        self._mag = sensor
        sensor.start()

    def _wait(self, readers: list[DeviceReader]) -> bool:
        """Wait until one of them has samples; return True where none has in time."""
        now_ns = self._clock.monotonic_ns()
        descriptors = [one.descriptor for one in readers if one.descriptor is not None]
        wait_s = min(reader.wait_s(now_ns) for reader in readers)
        ready, _, _ = select.select(descriptors, [], [], wait_s)
        return bool(descriptors) and not ready

    def _take(self, block: Block, joined: JoinedTimeline | None) -> None:
        if MAG in block.values:
            self._rows.add_mag(self._captured_mag.take(block))
            block = block.without(MAG)
        if joined is not None:
            joined.push(block)
            block = joined.take()
            self.left_out += joined.take_left_out()
        count = self._rows.add(block)
        if count:
            self.taken += count
            self._report_return()

    def _cut(self) -> SensorBatch:
        if self._mag is not None:
            self._rows.add_mag(self._mag.take())
        if self._barometer is not None:
            self._rows.add_pressure(self._barometer.take())
        return self._rows.cut()

    def _require_samples(
        self, devices: list[InertialDevice], readers: list[DeviceReader], last_ns: list[int]
    ) -> None:
        """Raises UnusableDeviceError for a device that has been silent for a while."""
        now_ns = self._clock.monotonic_ns()
        for device, reader, at_ns in zip(devices, readers, last_ns, strict=True):
            if now_ns - at_ns > _SILENT_NS:
                raise UnusableDeviceError(
                    coded(
                        "iio-silent",
                        "the {device} has given none for {silent_s:.0f} s: {reason}",
                        device=device.title,
                        silent_s=_SILENT_NS / NS_PER_S,
                        reason=reader.silence_reason(),
                    )
                )

    def _report_remarks(self, devices: list[InertialDevice]) -> None:
        for device in devices:
            how = "captured" if device.is_captured else "polled, as it has no buffer or no trigger"
            logger.info("%s: %s at %g samples/s", device, how, device.plan.rate_hz)
            for remark in (device.plan.remark, self._mag_remark(device)):
                self._report_once(remark and fault_of(device.title, remark))
        rate_hz, described_hz = devices[-1].plan.rate_hz, self._description.rate_hz
        if abs(rate_hz / described_hz - 1.0) > _RATE_OFF:
            self._report_once(
                coded(
                    "iio-rate-changed",
                    "it gives {rate_hz:g} samples a second and was taken for one of "
                    "{described_hz:g} before it was there: restart the unit's agent",
                    rate_hz=rate_hz,
                    described_hz=described_hz,
                )
            )

    def _mag_remark(self, device: InertialDevice) -> str:
        if device.has_mag and device.is_captured and not device.captures_mag:
            return coded(
                "iio-mag-not-captured",
                "its driver does not capture its magnetometer: that is not read",
            )
        if device.has_mag and not self._description.mag_present:
            return coded(
                "iio-mag-found",
                "it has a magnetometer, and was taken for one without before it was there: restart "
                "the unit's agent",
            )
        if self._settings.mag == device.name and not device.has_mag:
            return coded("iio-no-mag", "it has no magnetometer")
        return ""

    def _report_once(self, remark: str) -> None:
        if remark and remark not in self._remarks:
            self._remarks.add(remark)
            self._report_fault(remark)

    def _report_events(self, device: InertialDevice, reader: DeviceReader) -> None:
        for event in (*reader.take_events(), *self._captured_mag.take_events()):
            self._report_fault(fault_of(device.title, event))

    def _report_silence(self, reason: str) -> None:
        """Report each reason once, however often it is tried again."""
        if reason not in self._silence_reasons:
            self._silence_reasons.add(reason)
            self._report_fault(no_samples(reason))

    def _report_return(self) -> None:
        if self._silence_reasons:
            logger.info("%s gives samples again", self)
        self._silence_reasons.clear()

    def _report_fault(self, fault: str) -> None:
        logger.warning("%s: %s", self, fault)
        self._faults.append(fault_of(self._title, fault))
