"""Emulated inertial sensors of the kernel's Industrial I/O: attributes, and frames from a buffer.

The character device is a pseudo terminal that is linked to as ``/dev/iio:deviceN``.  As a driver
does, it gives frames while ``buffer/enable`` is 1, as many at once as ``buffer/watermark`` says.
"""

from __future__ import annotations

import os
import pty
import select
import struct
import time
import tty
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from threading import Event, Thread

from tests.rig.kernel_devices import IO_ERROR, SysfsTree, write_attributes

NS_PER_S = 10**9
Raw = tuple[int, ...]
GYRO = ("in_anglvel_x", "in_anglvel_y", "in_anglvel_z")
ACCEL = ("in_accel_x", "in_accel_y", "in_accel_z")
MAG = ("in_magn_x", "in_magn_y", "in_magn_z")
_LE16, _BE16, _TIME = "le:s16/16>>0", "be:s16/16>>0", "le:s64/64>>0"


@dataclass(frozen=True)
class Model:
    """Device as its driver shows it."""

    name: str
    elements: dict[str, str]  # types, in the order of a frame
    frame: struct.Struct  # of all elements, the time last and packed apart
    attributes: dict[str, str]
    rest: Raw  # raw values of a device that lies still, z up


_MATRIX = "1, 0, 0; 0, 1, 0; 0, 0, 1"
BMI160 = Model(
    "bmi160",
    dict.fromkeys((*GYRO, *ACCEL), _LE16),
    struct.Struct("<6h4x"),
    {
        "in_accel_scale": "0.000598",
        "in_accel_scale_available": "0.000598 0.001197 0.002394 0.004788",
        "in_accel_sampling_frequency": "100.000000",
        "in_accel_sampling_frequency_available": "25 50 100 200 400 800 1600",
        "in_anglvel_scale": "0.000133",
        "in_anglvel_scale_available": "0.001065 0.000532 0.000266 0.000133",
        "in_anglvel_sampling_frequency": "100.000000",
        "in_anglvel_sampling_frequency_available": "25 50 100 200 400 800 1600 3200",
        "in_mount_matrix": _MATRIX,
    },
    (1, -2, 3, 5, -7, 2048),
)
ICM_ACCEL = Model(
    "icm42688-accel",
    dict.fromkeys((*ACCEL, "in_temp"), _BE16),
    struct.Struct(">4h"),
    {
        "in_accel_scale": "0.000598550",
        "in_accel_scale_available": "0.004788403 0.002394202 0.001197101 0.000598550",
        "sampling_frequency": "50.000000",
        "sampling_frequency_available": "12.5 25 50 100 200 1000 2000 4000",
        "in_temp_scale": "7.548309179",
        "in_temp_offset": "3312.0",
        "mount_matrix": _MATRIX,
    },
    (5, -7, 2048, 0),
)
ICM_GYRO = Model(
    "icm42688-gyro",
    dict.fromkeys(GYRO, _BE16),
    struct.Struct(">3h2x"),
    {
        "in_anglvel_scale": "0.001065264",
        "in_anglvel_scale_available": "0.001065264 0.000532632",
        "sampling_frequency": "50.000000",
        "sampling_frequency_available": "12.5 25 50 100 200 1000 2000 4000",
        "mount_matrix": _MATRIX,
    },
    (1, -2, 3),
)

MPU9250 = Model(  # its magnetometer is a chip within the chip, with axes of its own
    "mpu9250",
    dict.fromkeys((*GYRO, *ACCEL, *MAG), _LE16),
    struct.Struct("<9h6x"),
    {
        "in_accel_scale": "0.004785",
        "in_accel_scale_available": "0.000598 0.001196 0.002392 0.004785",
        "in_anglvel_scale": "0.001064724",
        "in_anglvel_scale_available": "0.000133090 0.001064724",
        "sampling_frequency": "50",
        "sampling_frequency_available": "10 20 50 100 200 500",
        "in_accel_mount_matrix": _MATRIX,
        "in_anglvel_mount_matrix": _MATRIX,
        "in_magn_x_scale": "0.001500",
        "in_magn_y_scale": "0.001500",
        "in_magn_z_scale": "0.001500",
        "in_magn_mount_matrix": "0, 1, 0; 1, 0, 0; 0, 0, -1",
    },
    (1, -2, 3, 5, -7, 2048, 0, 133, -267),
)


def without_buffer(tree: SysfsTree, model: Model, **attributes: str) -> Path:
    """Make a device whose driver has no buffer, and return its folder."""
    raw = {
        f"{name}_raw": str(value) for name, value in zip(model.elements, model.rest, strict=True)
    }
    return tree.iio(0, name=model.name, **model.attributes, **raw, **attributes)


class EmulatedIio:
    """Device of a model; ``devices`` stands for ``/dev``."""

    def __init__(
        self,
        tree: SysfsTree,
        devices: Path,
        model: Model = BMI160,
        number: int = 0,
        address: str = "spi0.0",
        values: Callable[[int], Raw] | None = None,
        **attributes: str,
    ) -> None:
        """``values``: raw values of the kth sample; None: it lies still."""
        self.model = model
        self.is_stuck = False
        self.clock = time.monotonic_ns  # by which it stamps
        self._values = values or self._noisy
        self._tree, self._attributes = tree, {**model.attributes, **attributes}
        self._address, self._number = address, number
        devices.mkdir(parents=True, exist_ok=True)
        self.node = devices / f"iio:device{number}"
        self._stop = Event()
        self.attach()

    @property
    def path(self) -> Path:
        return self._tree.root / "bus" / "iio" / "devices" / f"iio:device{self._number}"

    def attach(self) -> None:
        """The device is there, and its buffer off."""
        self._device = self._tree.iio(
            *(self._number, self._address), name=self.model.name, **self._attributes
        )
        elements = {**self.model.elements, "in_timestamp": _TIME}
        for index, (name, kind) in enumerate(elements.items()):
            shown = {f"{name}_en": "0", f"{name}_index": str(index), f"{name}_type": kind}
            write_attributes(self._device / "scan_elements", shown)
        for name, raw in zip(self.model.elements, self.model.rest, strict=True):
            write_attributes(self._device, {f"{name}_raw": str(raw)})
        write_attributes(self._device, {"current_timestamp_clock": "realtime"})
        write_attributes(self._device / "buffer", {"enable": "0", "length": "2", "watermark": "1"})
        self._ours, theirs = pty.openpty()
        self._theirs = theirs
        tty.setraw(theirs)
        os.set_blocking(self._ours, False)
        self._link(os.ttyname(theirs))
        self._stop.clear()
        self._thread = Thread(target=self._run, daemon=True)
        self._thread.start()

    def detach(self) -> None:
        """The device is removed: its files are gone, and who reads it is told so."""
        if self._stop.is_set():
            return
        self.node.unlink(missing_ok=True)
        (self._tree.root / "bus" / "iio" / "devices" / self._device.name).unlink()
        self._end()

    def fail(self) -> None:
        """The bus fails: reading the device is an input/output error."""
        self._link(str(IO_ERROR))
        self._end()

    def close(self) -> None:
        if not self._stop.is_set():
            self._end()

    def value(self, attribute: str) -> str:
        return (self._device / attribute).read_text().strip()

    def set(self, folder: str = "", **attributes: str) -> None:
        write_attributes(self._device / folder, attributes)

    def _link(self, target: str) -> None:
        self.node.unlink(missing_ok=True)
        self.node.symlink_to(target)

    def _end(self) -> None:
        self._stop.set()
        self._thread.join(5.0)
        for descriptor in (self._ours, self._theirs):
            with suppress(OSError):
                os.close(descriptor)

    def _run(self) -> None:
        count, begun_ns = 0, None
        while not self._stop.wait(0.002):
            with suppress(OSError):  # an attribute that is being written
                if self.value("buffer/enable") != "1":
                    count, begun_ns = 0, None
                    continue
                if begun_ns is None:
                    begun_ns = self.clock()
                    period_ns = NS_PER_S / self._rate_hz()
                    at_once = int(self.value("buffer/watermark"))
                due = int((self.clock() - begun_ns) / period_ns)
                if due - count >= at_once:
                    frames = (self._frame(k, begun_ns, period_ns) for k in range(count, due))
                    self._send(b"".join(frames))
                    count = due

    def _rate_hz(self) -> float:
        names = ("sampling_frequency", "in_accel_sampling_frequency")
        return next(float(self.value(name)) for name in names if (self._device / name).exists())

    def _frame(self, k: int, begun_ns: int, period_ns: float) -> bytes:
        raw = self.model.rest if self.is_stuck else self._values(k)
        return self.model.frame.pack(*raw) + struct.pack("<q", begun_ns + round(k * period_ns))

    def _noisy(self, k: int) -> Raw:
        return tuple(value + (k * (7 + axis)) % 5 for axis, value in enumerate(self.model.rest))

    def _send(self, frames: bytes) -> None:
        while frames and not self._stop.is_set():
            _, ready, _ = select.select([], [self._ours], [], 0.05)
            if ready:
                frames = frames[os.write(self._ours, frames) :]
