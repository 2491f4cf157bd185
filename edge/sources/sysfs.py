"""Attributes of devices in sysfs, and explanations of why one cannot be read."""

from __future__ import annotations

import errno
import os
from pathlib import Path

from shared.coded_text import CodedText, coded, text_of_error

SYSFS = Path("/sys")
UDEV_RULES = "deploy/udev/60-muster.rules"

_REMOVED = coded("device-removed", "it was removed")
_EXPLANATIONS = {
    errno.ENOENT: _REMOVED,
    errno.ENODEV: _REMOVED,
    errno.ENXIO: _REMOVED,
    errno.EIO: coded(
        "device-io-error",
        "it does not answer (input/output error); check its wires and its supply",
    ),
    errno.EREMOTEIO: coded(
        "device-bus-silent", "it does not answer on its bus; check its wires and its supply"
    ),
    errno.ETIMEDOUT: coded(
        "device-timeout", "it does not answer in time; check its wires and its supply"
    ),
    errno.EBUSY: coded("device-busy", "another program uses it; end that one"),
    errno.EAGAIN: coded("device-no-value", "it has no value yet"),
    errno.EROFS: coded(
        "device-read-only",
        "it cannot be set, because the service sees it read-only; add the line ReadWritePaths that "
        "stands in muster-unit.service",
    ),
}


def explain_read_error(error: OSError) -> str:
    """Return what a person can do about a device that cannot be opened or read."""
    if error.errno in (errno.EACCES, errno.EPERM):
        return coded(
            "device-not-permitted",
            "this program may not open {path}; install {rules} in /etc/udev/rules.d and add the "
            "user to the group muster",
            path=str(error.filename),
            rules=UDEV_RULES,
        )
    return _EXPLANATIONS.get(error.errno or 0) or text_of_error(error)


def read_text(path: Path) -> str:
    """Return an attribute without its line end.  Raises OSError."""
    return path.read_text(encoding="utf-8", errors="replace").strip()


def write_text(path: Path, text: str) -> None:
    """Set an attribute, which has to be there.  Raises OSError."""
    descriptor = os.open(path, os.O_WRONLY | os.O_TRUNC | os.O_CLOEXEC)
    try:
        os.write(descriptor, text.encode())
    except OSError as error:  # which does not say of what
        raise OSError(error.errno, error.strerror, str(path)) from error
    finally:
        os.close(descriptor)


def read_if_there(path: Path) -> str | None:
    """Return an attribute that not every driver has; None where it has not.  Raises OSError."""
    try:
        return read_text(path)
    except FileNotFoundError:
        return None


def read_number(path: Path) -> float | None:
    """Return a numeric attribute; None where its text is no number.  Raises OSError."""
    return number_in(read_text(path))


def no_number(attribute: str, text: str) -> CodedText:
    """Reason that an attribute cannot be used."""
    return coded(
        "attribute-no-number",
        "{attribute} is {text!r}, which is no number",
        attribute=attribute,
        text=text,
    )


def number_in(text: str) -> float | None:
    try:
        return float(text)
    except ValueError:
        return None


def devices_in(folder: Path) -> list[Path]:
    """Return the devices that a class or bus has now, in order; none where there is no such."""
    try:
        return sorted(folder.iterdir())
    except FileNotFoundError:
        return []


def address_of(device: Path) -> str:
    """Return the bus address of a device of a class, such as ``1-0048``; it outlives a restart."""
    parent = device / "device"
    return parent.resolve().name if parent.exists() else device.resolve().parent.name
