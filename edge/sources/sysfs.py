"""Attributes of devices in sysfs, and explanations of why one cannot be read."""

from __future__ import annotations

import errno
import os
from pathlib import Path

SYSFS = Path("/sys")
UDEV_RULES = "deploy/udev/60-muster.rules"

_EXPLANATIONS = {
    errno.ENOENT: "it was removed",
    errno.ENODEV: "it was removed",
    errno.ENXIO: "it was removed",
    errno.EIO: "it does not answer (input/output error); check its wires and its supply",
    errno.EREMOTEIO: "it does not answer on its bus; check its wires and its supply",
    errno.ETIMEDOUT: "it does not answer in time; check its wires and its supply",
    errno.EBUSY: "another program uses it; end that one",
    errno.EAGAIN: "it has no value yet",
    errno.EROFS: (
        "it cannot be set, because the service sees it read-only; add the line ReadWritePaths that "
        "stands in muster-unit.service"
    ),
}


def explain_read_error(error: OSError) -> str:
    """Return what a person can do about a device that cannot be opened or read."""
    if error.errno in (errno.EACCES, errno.EPERM):
        return (
            f"this program may not open {error.filename}; install {UDEV_RULES} in "
            "/etc/udev/rules.d and add the user to the group muster"
        )
    return _EXPLANATIONS.get(error.errno or 0, str(error))


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
