"""Emulated devices of the Linux kernel: sysfs trees below a folder, as its drivers make them.

For a program that is started, ``umockdev`` puts such a folder in the place of ``/sys`` and
``/dev``.
"""

from __future__ import annotations

import ctypes
import os
import subprocess
import sys
from pathlib import Path

from tests.rig.processes import cpu_s
from tests.rig.waiting import PATIENCE_S

IO_ERROR = Path("/proc/self/mem")  # reading its beginning fails with EIO


class SysfsTree:
    """Tree of devices; ``root`` stands for ``/sys``."""

    def __init__(self, root: Path) -> None:
        self.root = root
        root.mkdir(parents=True, exist_ok=True)

    def hwmon(self, number: int, address: str = "1-0048", /, **attributes: str) -> Path:
        """Make a chip at an address; ``name`` is among its attributes."""
        parent = self.root / "devices" / "platform" / address
        device = parent / "hwmon" / f"hwmon{number}"
        write_attributes(device, attributes)
        _link(device / "device", parent)
        _link(self.root / "class" / "hwmon" / f"hwmon{number}", device)
        return device

    def iio(self, number: int, address: str = "spi0.0", /, **attributes: str) -> Path:
        device = self.root / "devices" / "platform" / address / f"iio:device{number}"
        write_attributes(device, attributes)
        _link(self.root / "bus" / "iio" / "devices" / f"iio:device{number}", device)
        return device

    def iio_trigger(self, number: int, address: str, /, **attributes: str) -> Path:
        """``address`` of the device whose trigger it is; empty: a timer."""
        folder = self.root / "devices" / ("platform" if address else "") / address
        trigger = folder / f"trigger{number}"
        write_attributes(trigger, attributes)
        _link(self.root / "bus" / "iio" / "devices" / f"trigger{number}", trigger)
        return trigger

    def w1(self, sensor_id: str, /, **attributes: str) -> Path:
        device = self.root / "devices" / "w1_bus_master1" / sensor_id
        write_attributes(device, attributes)
        _link(self.root / "bus" / "w1" / "devices" / sensor_id, device)
        return device

    def led(self, name: str, /, **attributes: str) -> Path:
        device = self.root / "devices" / "platform" / "leds" / name
        write_attributes(device, attributes)
        _link(self.root / "class" / "leds" / name, device)
        return device

    def power_supply(self, name: str, /, **attributes: str) -> Path:
        device = self.root / "devices" / "platform" / "battery" / "power_supply" / name
        write_attributes(device, attributes)
        _link(self.root / "class" / "power_supply" / name, device)
        return device


def write_attributes(device: Path, attributes: dict[str, str]) -> None:
    """Write attributes as the kernel shows them; each becomes the new one at once."""
    device.mkdir(parents=True, exist_ok=True)
    for name, text in attributes.items():
        new = device / f".{name}"
        new.write_text(f"{text}\n")
        new.replace(device / name)


def break_attribute(device: Path, name: str) -> None:
    """Let reading an attribute fail with EIO."""
    (device / name).unlink(missing_ok=True)
    (device / name).symlink_to(IO_ERROR)


def _link(link: Path, target: Path) -> None:
    link.parent.mkdir(parents=True, exist_ok=True)
    if not link.is_symlink():
        link.symlink_to(os.path.relpath(target, link.parent))


UMOCKDEV = "libumockdev-preload.so.0"


def has_umockdev() -> bool:
    try:
        ctypes.CDLL(UMOCKDEV, mode=os.RTLD_LOCAL | os.RTLD_LAZY)
    except OSError:
        return False
    return True


class EmulatedAgent:
    """``muster edge run``, or another command, on a machine with the devices of a folder."""

    def __init__(self, machine: Path, output: Path, *flags: str, command: str = "run") -> None:
        self._output = output
        program = Path(sys.executable).with_name("muster")
        environ = {**os.environ, "LD_PRELOAD": UMOCKDEV, "UMOCKDEV_DIR": str(machine)}
        with output.open("wb") as written:
            self._process = subprocess.Popen(
                [program, "edge", command, *flags], env=environ, stdout=written, stderr=written
            )

    def __enter__(self) -> EmulatedAgent:
        return self

    def __exit__(self, *_: object) -> None:
        self._process.kill()
        self._process.wait()

    def runs(self) -> bool:
        return self._process.poll() is None

    def cpu_s(self) -> float:
        """Return what it has spent so far."""
        return cpu_s(self._process.pid)

    def output(self) -> str:
        return self._output.read_text(errors="replace")

    def stop(self) -> int:
        self._process.terminate()
        return self._process.wait(PATIENCE_S)
