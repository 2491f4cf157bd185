"""Button as an input device of the Linux kernel: at a pin (``gpio-keys``), on USB, by Bluetooth.

Read through the library ``evdev``, which is an optional part (``muster[button]``): it is compiled
on the machine.  ``/dev/input/eventN`` changes from start to start; a device keeps its name, and
``/dev/input/by-id`` and ``by-path`` keep theirs.
"""

from __future__ import annotations

import errno
import fcntl
import logging
import select
import struct
import time
from collections.abc import Iterable, Iterator
from contextlib import ExitStack
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any

from edge.sources.device_name import listing
from edge.wearer.interface import ButtonError, ContactChange
from shared.clock import NS_PER_MS, NS_PER_S, Clock
from shared.coded_text import coded
from shared.errors import ConfigError

logger = logging.getLogger(__name__)

_FOLDER = Path("/dev/input")
_SET_CLOCK = 0x400445A0  # EVIOCSCLOCKID: of the times that events have
_LISTED_MAX = 8


class EvdevButton:
    """Key of the device at a path, or of the one with a name; see ``ButtonDriver``."""

    def __init__(self, place: str, options: dict[str, str], clock: Clock) -> None:
        """``options``: ``key`` by its name in ``input-event-codes.h``; without it the device has
        one only.  Raises ConfigError.
        """
        unknown = next((option for option in options if option != "key"), None)
        if unknown is not None:
            raise ConfigError(f"evdev:{place}: unknown option {unknown!r}; known is key")
        key = options.get("key")
        if key is not None and not key.startswith(("KEY_", "BTN_")):
            raise ConfigError(
                f"evdev:{place}: {key!r} names no key; write it as evtest shows it, such as "
                "KEY_POWER or BTN_0"
            )
        self._place = place
        self._key = key
        self._clock = clock
        self._code = 0
        self._device: Any = None  # of the library's InputDevice
        self._first: tuple[ContactChange, ...] = ()  # the state when it was opened
        self._has_times = False  # events carry monotonic time

    def open(self) -> None:
        library = _library()
        wanted = None if self._key is None else _code_of(library, self._key)
        device, self._code = self._find(library, wanted)
        self._device = device
        self._has_times = _set_monotonic(device)
        _grab(device)
        self._first = (self._state(),)
        logger.info("button: %s (%s) at %s", device.name, self._key or self._code, device.path)

    def wait(self, timeout_s: float) -> None:
        waiting = select.poll()
        waiting.register(self._device.fd, select.POLLIN)
        waiting.poll(timeout_s * 1000.0)

    def read(self) -> tuple[ContactChange, ...]:
        codes = _library().ecodes
        changes = [*self._first]
        self._first = ()
        for event in self._events():
            if event.type == codes.EV_SYN and event.code == codes.SYN_DROPPED:
                return (*changes, self._state())  # what follows is the rest of something
            is_of_key = event.type == codes.EV_KEY and event.code == self._code
            if is_of_key and event.value in (0, 1):  # 2: it repeats
                changes.append(ContactChange(self._time_ns(event), event.value == 1))
        return tuple(changes)

    def close(self) -> None:
        if self._device is not None:
            self._device.close()
        self._device = None

    def _state(self) -> ContactChange:
        """Return the state now; the kernel drops the events of keys that wait."""
        is_pressed = self._code in self._device.active_keys()
        return ContactChange(self._clock.monotonic_ns(), is_pressed)

    def _events(self) -> Iterable[Any]:
        try:
            return list(self._device.read())
        except BlockingIOError:
            return ()

    def _time_ns(self, event: Any) -> int:
        """Return when it was; where the kernel does not tell in monotonic time, when it came."""
        if not self._has_times:
            return self._clock.monotonic_ns()
        return int(event.sec) * NS_PER_S + int(event.usec) * (NS_PER_MS // 1000)

    def _find(self, library: ModuleType, wanted: int | None) -> tuple[Any, int]:
        """Return the device, opened, and the code of its key."""
        if self._place.startswith("/"):
            device = _opened(library, self._place)
            with ExitStack() as on_error:
                on_error.callback(device.close)
                code = self._code_on(library, device, wanted)
                on_error.pop_all()
            return device, code
        return self._find_by_name(library, wanted)

    def _find_by_name(self, library: ModuleType, wanted: int | None) -> tuple[Any, int]:
        """Device with the key, of several that have the name, as parts of a keyboard do."""
        with ExitStack() as opened:
            there = list(_all_devices(library, opened))
            named = [device for device in there if device.name == self._place]
            if not named:
                raise ButtonError(
                    coded(
                        "button-unknown",
                        "there is no input device named {name}; {listed}",
                        name=self._place,
                        listed=_listing(device.name for device in there),
                    )
                )
            having = [device for device in named if wanted is None or wanted in _keys(device)]
            if len(having) > 1:
                paths = ", ".join(str(device.path) for device in having)
                raise ButtonError(
                    coded(
                        "buttons-several",
                        "there are {count} input devices named {name} ({paths}); write the path of "
                        "one, from /dev/input/by-id or by-path",
                        count=len(having),
                        name=self._place,
                        paths=paths,
                    )
                )
            found = (having or named)[0]
            code = self._code_on(library, found, wanted)
            opened.pop_all()
        for device in there:
            if device is not found:
                device.close()
        return found, code

    def _code_on(self, library: ModuleType, device: Any, wanted: int | None) -> int:
        keys = _keys(device)
        if wanted is not None and wanted in keys:
            return wanted
        there = _listing(_key_name(library, code) for code in keys)
        if wanted is not None:
            raise ButtonError(
                coded(
                    "button-no-key",
                    "{device} has no key {key}; {listed}",
                    device=str(device.name),
                    key=str(self._key),
                    listed=there,
                )
            )
        if len(keys) != 1:
            raise ButtonError(
                coded(
                    "button-several-keys",
                    "{device} has {count} keys; name one by ?key=; {listed}",
                    device=str(device.name),
                    count=len(keys),
                    listed=there,
                )
            )
        return keys[0]


def _library() -> ModuleType:
    try:
        return import_module("evdev")
    except ImportError as error:
        raise ButtonError(
            coded(
                "button-not-installed",
                "the library evdev is not installed: pip install -r "
                "deploy/requirements-button.lock, which compiles it (Debian: apt-get install gcc "
                "python3-dev linux-libc-dev) ({error})",
                error=str(error),
            )
        ) from error


def _code_of(library: ModuleType, key: str) -> int:
    code = library.ecodes.ecodes.get(key)
    if code is None:
        raise ButtonError(
            coded(
                "button-key-unknown",
                "there is no key {key}; evtest shows what a button's is called",
                key=key,
            )
        )
    return int(code)


def _opened(library: ModuleType, path: str) -> Any:
    """Return the device at a path.  Raises ButtonError, OSError."""
    if not Path(path).exists():
        raise ButtonError(
            coded(
                "button-gone",
                "there is no {path}: it is not connected, asleep or has another number now",
                path=path,
            )
        )
    try:
        return library.InputDevice(path, readonly=True)
    except PermissionError as error:
        raise ButtonError(
            coded(
                "button-not-permitted",
                "this program may not open {path}; install deploy/udev/60-muster.rules in "
                "/etc/udev/rules.d, or add the user to the group input",
                path=path,
            )
        ) from error
    except OSError as error:
        if error.errno in (errno.ENOTTY, errno.EINVAL):
            raise ButtonError(
                coded("button-no-input", "{path} is no input device", path=path)
            ) from error
        raise


def _all_devices(library: ModuleType, opened: ExitStack) -> Iterator[Any]:
    """Yield every device that may be opened; where there is none of those, raise the reason."""
    refusal: ButtonError | None = None
    are_any = False
    for path in sorted(_FOLDER.glob("event*")):
        try:
            device = _opened(library, str(path))
        except ButtonError as error:
            refusal = error
            continue
        except OSError:  # it is being unplugged
            continue
        opened.callback(device.close)
        are_any = True
        yield device
    if refusal is not None and not are_any:
        raise refusal


def _keys(device: Any) -> list[int]:
    """Return the codes of its keys."""
    capabilities: dict[int, list[int]] = device.capabilities(absinfo=False)
    return [int(code) for code in capabilities.get(1, [])]


def _key_name(library: ModuleType, code: int) -> str:
    name = library.ecodes.keys.get(code, str(code))
    return name if isinstance(name, str) else str(name[0])


def _listing(names: Iterable[str]) -> str:
    there = list(dict.fromkeys(names))
    if not there:
        return listing(())
    if len(there) <= _LISTED_MAX:
        return listing(there)
    return coded(
        "devices-more",
        "there are {there} and {more} more",
        there=", ".join(there[:_LISTED_MAX]),
        more=len(there) - _LISTED_MAX,
    )


def _set_monotonic(device: Any) -> bool:
    """Have events stamped with monotonic time: a press and its release that are read late, both at
    once, have lasted as long as they have.
    """
    try:
        fcntl.ioctl(device.fd, _SET_CLOCK, struct.pack("i", time.CLOCK_MONOTONIC))
    except OSError:
        return False
    return True


def _grab(device: Any) -> None:
    """Take the button for this program alone: nothing else types with it or switches off."""
    try:
        device.grab()
    except OSError as error:
        if error.errno == errno.EBUSY:
            raise ButtonError(
                coded("button-taken", "another program has it for itself; end that one")
            ) from error
        logger.warning("button: %s may be read by others, too: %s", device.path, error)
