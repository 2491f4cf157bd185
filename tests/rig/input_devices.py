"""Emulated input devices: in the place of the library ``evdev`` and of ``/dev/input``."""

from __future__ import annotations

import errno
import os
from collections import deque
from collections.abc import Sequence
from pathlib import Path
from types import ModuleType, SimpleNamespace

import pytest

from edge.wearer import evdev_button

EV_SYN, EV_KEY, SYN_DROPPED = 0, 1, 3
KEYS = {"KEY_A": 30, "KEY_POWER": 116, "BTN_0": 256, "KEY_VOLUMEUP": 115}


class Device:
    """A device as the kernel has it; ``press`` and ``release`` are its wearer's."""

    def __init__(self, path: Path, name: str, keys: Sequence[str]) -> None:
        self.path = path
        self.name = name
        self.keys = [KEYS[key] for key in keys]
        self.down: set[int] = set()
        self.events: deque[SimpleNamespace] = deque()
        self.is_gone = False
        self.grabbed_by_another = False
        self.opened: list[Opened] = []

    def press(self, key: str = "KEY_POWER", t_ns: int = 0) -> None:
        self.down.add(KEYS[key])
        self.emit(EV_KEY, KEYS[key], 1, t_ns)

    def release(self, key: str = "KEY_POWER", t_ns: int = 0) -> None:
        self.down.discard(KEYS[key])
        self.emit(EV_KEY, KEYS[key], 0, t_ns)

    def emit(self, kind: int, code: int, value: int, t_ns: int = 0) -> None:
        sec, rest_ns = divmod(t_ns, 10**9)
        self.events.append(
            SimpleNamespace(type=kind, code=code, value=value, sec=sec, usec=rest_ns // 1000)
        )
        for one in self.opened:
            os.write(one.signal, b"!")

    def unplug(self) -> None:
        self.is_gone = True
        self.path.unlink()
        for one in self.opened:
            os.write(one.signal, b"!")


class Opened:
    """Replacement of ``evdev.InputDevice``."""

    def __init__(self, device: Device) -> None:
        self._device = device
        self.path, self.name = str(device.path), device.name
        self.fd, self.signal = os.pipe()
        os.set_blocking(self.fd, False)
        device.opened.append(self)

    def capabilities(self, *, absinfo: bool) -> dict[int, list[int]]:
        assert not absinfo
        return {EV_SYN: [0], EV_KEY: self._device.keys}

    def active_keys(self) -> list[int]:
        return sorted(self._device.down)

    def grab(self) -> None:
        if self._device.grabbed_by_another:
            raise OSError(errno.EBUSY, "Device or resource busy")

    def read(self) -> list[SimpleNamespace]:
        if self._device.is_gone:
            raise OSError(errno.ENODEV, "No such device")
        os.read(self.fd, 1000)  # raises BlockingIOError where nothing has come
        events = list(self._device.events)
        self._device.events.clear()
        return events

    def close(self) -> None:
        if self in self._device.opened:
            self._device.opened.remove(self)
            os.close(self.fd)
            os.close(self.signal)


class InputDevices:
    """The devices of a machine."""

    def __init__(self, folder: Path, patch: pytest.MonkeyPatch) -> None:
        self.folder = folder
        self.devices: dict[str, Device] = {}
        folder.mkdir()
        library = ModuleType("evdev")
        vars(library)["InputDevice"] = self._open
        vars(library)["ecodes"] = SimpleNamespace(
            EV_SYN=EV_SYN,
            EV_KEY=EV_KEY,
            SYN_DROPPED=SYN_DROPPED,
            ecodes=KEYS,
            keys={code: name for name, code in KEYS.items()},
        )
        patch.setattr(evdev_button, "_library", lambda: library)
        patch.setattr(evdev_button, "_FOLDER", folder)

    def plug_in(
        self, number: int, name: str = "AB Button", keys: Sequence[str] = ("KEY_POWER",)
    ) -> Device:
        path = self.folder / f"event{number}"
        path.touch()
        self.devices[str(path)] = device = Device(path, name, keys)
        return device

    def _open(self, path: str, *, readonly: bool) -> Opened:
        assert readonly  # to write sets its lights
        device = self.devices.get(path)
        if device is None or device.is_gone:
            raise OSError(errno.ENOTTY, "Inappropriate ioctl for device")
        return Opened(device)
