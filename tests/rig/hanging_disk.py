"""A disk of its own that can be made to hang: frozen, it lets who writes to it wait."""

from __future__ import annotations

import subprocess
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import pytest


@contextmanager
def disk_that_can_hang(folder: Path, size_mb: int) -> Iterator[Path]:
    """Mount point; skips the test if none can be mounted.  Thawed at the end in every case."""
    image, place = folder / "image", folder / "disk"
    place.mkdir()
    with image.open("wb") as file:
        file.truncate(size_mb * 1024 * 1024)
    try:
        subprocess.run(["mkfs.ext4", "-q", str(image)], check=True, capture_output=True)
        subprocess.run(
            ["mount", "-o", "loop", str(image), str(place)], check=True, capture_output=True
        )
        freeze(place)
    except (OSError, subprocess.CalledProcessError) as error:
        subprocess.run(["umount", str(place)], check=False, capture_output=True)
        pytest.skip(f"no disk can be frozen here: {error}")
    thaw(place)
    try:
        yield place
    finally:
        with suppress(subprocess.CalledProcessError):  # it was thawed by the test
            thaw(place)
        subprocess.run(["umount", "--lazy", str(place)], check=True)


def freeze(disk: Path) -> None:
    subprocess.run(["fsfreeze", "--freeze", str(disk)], check=True, capture_output=True)


def thaw(disk: Path) -> None:
    subprocess.run(["fsfreeze", "--unfreeze", str(disk)], check=True, capture_output=True)


@contextmanager
def frozen(disk: Path) -> Iterator[None]:
    """Nobody who writes to it can be ended meanwhile."""
    freeze(disk)
    try:
        yield
    finally:
        thaw(disk)
