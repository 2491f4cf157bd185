"""Capture of a device's samples through the kernel's buffer, ``/dev/iio:deviceN``.

The buffer is set up below ``/sys``: which channels it has (``scan_elements``), how many samples it
holds, after how many it wakes its reader, and, where the driver needs one, the trigger by whose
interrupts it samples.
"""

from __future__ import annotations

import errno
import os
from collections.abc import Iterable
from contextlib import ExitStack, suppress
from pathlib import Path

import numpy as np

from edge.samples import Floats
from edge.sources.iio.attributes import UnusableDeviceError, read_shared_number
from edge.sources.iio.block import Block
from edge.sources.iio.conversion import (
    MAG,
    TEMPERATURE,
    TIMESTAMP,
    UT_PER_GAUSS,
    axes_of,
    read_conversion,
)
from edge.sources.iio.plan import CapturePlan
from edge.sources.iio.sample_times import choose_clock
from edge.sources.iio.scan_elements import FrameLayout, element_names, enabled_elements
from edge.sources.iio.stream_monitor import StreamMonitor
from edge.sources.iio.trigger import Trigger
from edge.sources.sysfs import write_text
from shared.clock import Clock
from shared.coded_text import coded

_WAKE_S = 0.05  # between two reads of a buffer
_HELD_S = 2.0  # in the buffer between two reads: a machine that is busy loses nothing
_WAIT_S = 0.2  # after which a buffer is read without a signal, to detect that it is gone
_CHUNK = 1 << 16
_DEGC = 1e-3  # of the unit of temperatures


def can_be_captured(device: Path, kinds: Iterable[str]) -> bool:
    """Return True where the device has a buffer with these channels and with times."""
    wanted = {TIMESTAMP, *(axis for kind in kinds for axis in axes_of(kind))}
    has_buffer = (device / "buffer" / "enable").exists()
    return has_buffer and wanted.issubset(element_names(device / "scan_elements"))


class BufferReader:
    """Reader of a device whose buffer runs from now until it is closed."""

    def __init__(
        self,
        device: Path,
        node: Path,
        kinds: tuple[str, ...],
        plan: CapturePlan,
        trigger: Trigger | None,
        clock: Clock,
    ) -> None:
        """Raises OSError and UnusableDeviceError."""
        self._device = device
        self._clock = clock
        self._rest = b""  # of a frame
        self.rate_hz = plan.rate_hz
        # It is opened first: one that another program reads is not touched.
        self._descriptor = os.open(node, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC)
        with ExitStack() as undo:
            undo.callback(self.close)
            self._enable(is_on=False)  # a program that was killed leaves it on
            plan.carry_out()
            if trigger is not None:
                trigger.attach(device, plan.rate_hz)
            self._times = choose_clock(device)
            self._axes = {kind: axes_of(kind) for kind in kinds}
            self._layout = self._choose_elements()
            self._conversions = {kind: read_conversion(device, kind) for kind in kinds}
            self._temperature = self._read_temperature_scale()
            self._set_length()
            self._enable(is_on=True)
            undo.pop_all()
        self._monitor = StreamMonitor(self.rate_hz)

    @property
    def descriptor(self) -> int:
        return self._descriptor

    def wait_s(self, now_ns: int) -> float:  # noqa: ARG002  # it wakes the reader itself
        return _WAIT_S

    def take(self) -> Block:
        data = self._rest + self._read()
        arrival_ns = self._clock.monotonic_ns()
        count = len(data) // self._layout.size
        frames, self._rest = data[: count * self._layout.size], data[count * self._layout.size :]
        return self._block(frames, count, arrival_ns)

    def take_events(self) -> list[str]:
        return [*self._times.take_events(), *self._monitor.take_events()]

    def silence_reason(self) -> str:
        if self._times.implausible:
            return coded(
                "iio-times-impossible",
                "its samples have times that cannot be; its driver does not stamp them",
            )
        return coded(
            "iio-nothing",
            "its buffer is on and nothing comes; check its interrupt line, and interrupts in the "
            "device tree",
        )

    def close(self) -> None:
        with suppress(OSError):  # it may be gone
            self._enable(is_on=False)
        os.close(self._descriptor)

    def _enable(self, *, is_on: bool) -> None:
        try:
            write_text(self._device / "buffer" / "enable", "1" if is_on else "0")
        except OSError as error:
            if is_on and error.errno == errno.EINVAL:
                raise UnusableDeviceError(
                    coded(
                        "iio-no-capture",
                        "its driver does not start the capture (invalid argument); it may need a "
                        "trigger: write ?trigger=NAME",
                    )
                ) from error
            raise

    def _choose_elements(self) -> FrameLayout:
        """Capture what is needed alone, and return how that comes."""
        folder = self._device / "scan_elements"
        needed = {TIMESTAMP, *(axis for axes in self._axes.values() for axis in axes)}
        for name in element_names(folder):
            is_wanted = name in needed or name == TEMPERATURE
            write_text(folder / f"{name}_en", "1" if is_wanted else "0")
        captured = enabled_elements(folder)
        missing = needed - {element.name for element in captured}
        if missing:
            raise UnusableDeviceError(
                coded(
                    "iio-not-captured",
                    "its driver does not capture {channels}",
                    channels=", ".join(sorted(missing)),
                )
            )
        return FrameLayout(captured)

    def _read_temperature_scale(self) -> tuple[float, float] | None:
        """Return offset and scale of the temperature; None where it is not captured."""
        if TEMPERATURE not in self._layout.names:
            return None
        of = (self._device, TEMPERATURE, TEMPERATURE)
        return read_shared_number(*of, "offset", 0.0), read_shared_number(*of, "scale", 1.0)

    def _set_length(self) -> None:
        buffer = self._device / "buffer"
        held = 1 << int(np.ceil(np.log2(self.rate_hz * _HELD_S)))
        write_text(buffer / "length", str(held))
        if (buffer / "watermark").exists():
            write_text(buffer / "watermark", str(max(1, int(self.rate_hz * _WAKE_S))))

    def _read(self) -> bytes:
        try:
            data = os.read(self._descriptor, _CHUNK // self._layout.size * self._layout.size)
        except BlockingIOError:
            return b""
        if not data:
            raise OSError(errno.ENODEV, os.strerror(errno.ENODEV), self._device.name)
        return data

    def _block(self, frames: bytes, count: int, arrival_ns: int) -> Block:
        if not count:
            return Block()
        raw = self._layout.decode(frames)
        times_ns, is_placed = self._times.to_monotonic(raw[TIMESTAMP], arrival_ns)
        self._monitor.count(times_ns, count - len(times_ns))
        values: dict[str, Floats] = {}
        for kind, axes in self._axes.items():
            columns = np.stack([raw[axis][is_placed] for axis in axes], axis=1)
            values[kind] = self._conversions[kind].apply(columns.astype(np.float64))
        if MAG in values:
            values[MAG] *= UT_PER_GAUSS
        degc: Floats | None = None
        if self._temperature is not None:
            offset, scale = self._temperature
            degc = _DEGC * scale * (raw[TEMPERATURE][is_placed].astype(np.float64) + offset)
        return Block(times_ns, values, degc)
