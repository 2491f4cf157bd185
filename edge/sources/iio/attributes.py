"""Attributes of devices of the kernel's Industrial I/O, ``/sys/bus/iio/devices/iio:deviceN``.

An attribute of a channel, such as the scale of ``in_accel_x``, stands for that channel alone, for
all of its type (``in_accel_scale``), for all inputs (``in_scale``) or for the device (``scale``).
"""

from __future__ import annotations

from pathlib import Path

from edge.sources.sysfs import no_number, number_in, read_if_there, read_text

IIO_DEVICES = Path("bus") / "iio" / "devices"  # below where sysfs is mounted


class UnusableDeviceError(Exception):
    """A device shows something that cannot be used; the text is for a person."""


def find_attribute(device: Path, channel: str, kind: str, attribute: str) -> Path | None:
    """Return the path of a channel's attribute, the most specific one; None where it has none.

    ``kind`` is the beginning of all channels of its type, such as ``in_accel``.
    """
    names = (f"{channel}_{attribute}", f"{kind}_{attribute}", f"in_{attribute}", attribute)
    return next((device / name for name in names if (device / name).exists()), None)


def read_shared_number(
    device: Path, channel: str, kind: str, attribute: str, otherwise: float
) -> float:
    """Return a number; ``otherwise`` where the driver has no such attribute.

    Raises OSError, and UnusableDeviceError where it is no number.
    """
    path = find_attribute(device, channel, kind, attribute)
    return otherwise if path is None else read_number(path)


def read_number(path: Path) -> float:
    """Raises OSError, and UnusableDeviceError where the attribute is no number."""
    text = read_text(path)
    number = number_in(text)
    if number is None:
        raise UnusableDeviceError(no_number(path.name, text))
    return number


def read_scaled(device: Path, channel: str, kind: str, *, signed_bits: int | None = None) -> float:
    """Return a channel's value in the unit of its kind.  Raises OSError and UnusableDeviceError.

    ``signed_bits``: of a raw value from which the driver leaves out the sign.
    """
    if (device / f"{channel}_input").exists():
        return read_number(device / f"{channel}_input")
    raw = read_number(device / f"{channel}_raw")
    if signed_bits is not None and raw >= 2 ** (signed_bits - 1):
        raw -= 2**signed_bits
    offset = read_shared_number(device, channel, kind, "offset", 0.0)
    return (raw + offset) * read_shared_number(device, channel, kind, "scale", 1.0)


def is_one(path: Path) -> bool:
    """Return True for an attribute that is there and 1.  Raises OSError."""
    return read_if_there(path) == "1"
