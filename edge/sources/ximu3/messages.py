"""Messages of an x-io x-IMU3: its data messages, in text or binary.

From the x-IMU3 User Manual v1.7, section 8.2.  A message of text is comma-separated, begins with a
letter and the time in microseconds, and ends with CR LF::

    I,1000000,0.0000,0.0000,0.0000,0.0000,0.0000,1.0000

A binary one begins with 0x80 plus the letter, then the time as 64 bits without a sign and 32-bit
floats, little-endian, and ends with LF; an LF inside is 0xDB 0xDC, and 0xDB itself 0xDB 0xDD.  Both
may be mixed.  There is no checksum: what a sensor cannot have measured is taken for noise, and a
digit that flipped to another one is not noticed.
"""

from __future__ import annotations

import math
import re
import struct
from dataclasses import dataclass

from shared.errors import WireError
from shared.messages import BatteryState

GYRO_FULL_SCALE_DPS = 2000.0
ACCEL_FULL_SCALE_G = 24.0
LONGEST = 512  # bytes of a message

Vector = tuple[float, float, float]

_OVER = 1.1  # calibrated values may pass the full scale by a little
_MAG_MOST = 100.0  # 2500 uT at 50 uT a unit, and room
_DEGC = (-60.0, 300.0)  # what its register holds: hotter than it may be, as a device in heat says
_FOREVER_US = 2**62  # far beyond 1970 plus a century
_END = b"\n"
_BINARY = 0x80
_NUMBER = re.compile(r"-?\d{1,9}(?:\.\d{1,9})?")
_TIME = re.compile(r"\d{1,19}")
_UNSTUFFED = {0xDC: b"\n", 0xDD: b"\xdb"}


@dataclass(frozen=True, slots=True)
class Inertial:
    t_us: int
    gyro_dps: Vector
    accel_g: Vector


@dataclass(frozen=True, slots=True)
class MagnetometerMessage:
    t_us: int
    field: Vector  # 1 is the magnitude of the field in which it was calibrated, about 50 uT


@dataclass(frozen=True, slots=True)
class TemperatureMessage:
    """Temperature inside the inertial sensor."""

    t_us: int
    temperature_degc: float


@dataclass(frozen=True, slots=True)
class BatteryMessage:
    t_us: int
    level: float  # 0 empty ... 1 full
    state: BatteryState


@dataclass(frozen=True, slots=True)
class Button:
    t_us: int
    is_down: bool


@dataclass(frozen=True, slots=True)
class Notification:
    t_us: int
    text: str
    is_error: bool


@dataclass(frozen=True, slots=True)
class OtherMessage:
    """Well-formed message of a kind that is not used here."""


Message = (
    Inertial
    | MagnetometerMessage
    | TemperatureMessage
    | BatteryMessage
    | Button
    | Notification
    | OtherMessage
)


class Frames:
    """Cuts what comes on a line into messages, without their end."""

    def __init__(self) -> None:
        self._rest = b""

    def push(self, text: bytes) -> list[bytes]:
        """The messages that are whole now; noise without an end is cut at ``LONGEST``."""
        *frames, remainder = (self._rest + text).split(_END)
        while len(remainder) > LONGEST:
            frames.append(remainder[:LONGEST])
            remainder = remainder[LONGEST:]
        self._rest = remainder
        return frames


def message_of(frame: bytes) -> Message:
    """Raises WireError for what is no message, or none that a sensor can have meant."""
    if not frame.rstrip(b"\r"):
        raise WireError("an empty line")
    if frame[0] >= _BINARY:
        return _from_binary(_unstuffed(frame))
    return _from_text(frame)


def _from_text(frame: bytes) -> Message:
    try:
        text = frame.decode("ascii")
    except UnicodeDecodeError as error:
        raise WireError("bytes that are no text") from error
    if text.startswith("{") and text.endswith("}\r"):
        return OtherMessage()  # an answer to a command of another program
    if not text.endswith("\r"):
        raise WireError("a line without its end")
    kind, _, remainder = text[:-1].partition(",")
    time, _, remainder = remainder.partition(",")
    if len(kind) != 1 or not kind.isupper() or not _TIME.fullmatch(time):
        raise WireError("a line that begins otherwise")
    if kind in "NF":
        return _notification(kind, _time(int(time)), remainder)
    if kind not in _KINDS:
        return OtherMessage()
    fields = remainder.split(",")
    if not all(map(_NUMBER.fullmatch, fields)):
        raise WireError("something else than numbers")
    return _measured(kind, _time(int(time)), tuple(map(float, fields)))


def _from_binary(frame: bytes) -> Message:
    kind = chr(frame[0] - _BINARY)
    if len(frame) < 9 or not ("A" <= kind <= "Z"):
        raise WireError("bytes that begin otherwise")
    t_us = _time(int.from_bytes(frame[1:9], "little"))
    values = frame[9:]
    if kind in "NF":
        return _notification(kind, t_us, values.decode("ascii", "replace"))
    if kind not in _KINDS:
        return OtherMessage()
    if len(values) % 4:
        raise WireError("half a number")
    return _measured(kind, t_us, struct.unpack(f"<{len(values) // 4}f", values))


def _unstuffed(frame: bytes) -> bytes:
    first, *others = frame.split(b"\xdb")
    complete = [first]
    for part in others:
        if not part or part[0] not in _UNSTUFFED:
            raise WireError("an escape of nothing")
        complete.append(_UNSTUFFED[part[0]] + part[1:])
    return b"".join(complete)


def _time(t_us: int) -> int:
    if t_us > _FOREVER_US:
        raise WireError("a time that never comes")
    return t_us


def _notification(kind: str, t_us: int, text: str) -> Notification:
    printable = "".join(letter if letter.isprintable() else "?" for letter in text)
    return Notification(t_us, printable, is_error=kind == "F")


def _measured(kind: str, t_us: int, values: tuple[float, ...]) -> Message:
    if len(values) != _KINDS[kind]:
        raise WireError(f"{len(values)} values of {_KINDS[kind]}")
    if not all(map(math.isfinite, values)):
        raise WireError("a value that is no number")
    match kind:
        case "I":
            gyro_dps, accel_g = _vector(values[:3]), _vector(values[3:])
            _within(gyro_dps, _OVER * GYRO_FULL_SCALE_DPS)
            _within(accel_g, _OVER * ACCEL_FULL_SCALE_G)
            return Inertial(t_us, gyro_dps, accel_g)
        case "M":
            _within(values, _MAG_MOST)
            return MagnetometerMessage(t_us, _vector(values))
        case "T":
            if not _DEGC[0] <= values[0] <= _DEGC[1]:
                raise WireError(f"{values[0]:g} degC")
            return TemperatureMessage(t_us, values[0])
        case "O":
            return Button(t_us, is_down=values[0] >= _HALF_DOWN)
        case _:
            if not 0.0 <= values[0] <= 100.0:
                raise WireError(f"a battery at {values[0]:g} %")
            state = _CHARGING.get(values[2], BatteryState.UNKNOWN)
            return BatteryMessage(t_us, values[0] / 100.0, state)


_KINDS = {"I": 6, "M": 3, "T": 1, "B": 3, "O": 1}  # values of each
_HALF_DOWN = 0.5  # its state is 1 while it is down, and 0 otherwise
_CHARGING = {  # its charging status
    0.0: BatteryState.DISCHARGING,
    1.0: BatteryState.CHARGING,
    2.0: BatteryState.FULL,
}


def _vector(values: tuple[float, ...]) -> Vector:
    x, y, z = values
    return x, y, z


def _within(values: tuple[float, ...], most: float) -> None:
    if max(map(abs, values)) > most:
        raise WireError(f"{max(values, key=abs):g}, and {most:g} is the most")
