"""A unit whose recording changes as a test says, and what a station has pulled of it."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from pathlib import Path

from base_station.unit_sync.recordings import transfer as fetching
from base_station.unit_sync.recordings.transfer import Transfer, TransferRequest
from shared.clock import SystemClock
from shared.messages.recording import (
    RecordedFile,
    RecordingDigest,
    RecordingIndex,
    RecordingPiece,
)
from tests.rig.recorded_unit import U


class RecordingsUnit:
    """A unit that has these files, and of which a test says what becomes of them meanwhile."""

    def __init__(self, **files: bytes) -> None:
        self.files = {f"boot/{name}.mcap": content for name, content in files.items()}
        self.before: Callable[[str], None] = lambda _: None  # hears of every question
        self.pieces: list[int] = []  # how much was asked for

    def ask(self, _: str, question: str) -> bytes:
        self.before(question)
        what, _, stated = question.partition("?")
        values = dict(pair.split("=") for pair in stated.split(";"))
        if what == "index":
            files = (RecordedFile(name, len(content)) for name, content in self.files.items())
            return RecordingIndex(tuple(files), 1).to_bytes()
        content = self.files.get(values["path"])
        if what == "digest":
            size = int(values["size"])
            reported = b"" if content is None else hashlib.sha256(content[:size]).digest()
            return RecordingDigest(size, reported).to_bytes()
        offset, length = int(values["offset"]), int(values["length"])
        self.pieces.append(length)
        if content is None:
            return RecordingPiece(offset, b"", b"", gone=True).to_bytes()
        data = content[offset : offset + length]
        return RecordingPiece(offset, data, hashlib.sha256(data).digest()).to_bytes()

    def pull(self, folder: Path) -> Transfer:
        return Transfer(self.ask, folder, TransferRequest(U, 1, 2), SystemClock())


def pulled(folder: Path) -> dict[str, bytes]:
    """Pulled files by name."""
    return {one.name: one.read_bytes() for one in (folder / U / "boot").iterdir()}


def listed(folder: Path) -> dict[str, str]:
    """The hashes that stand beside the files, by name."""
    lines = (folder / U / fetching.HASHES).read_text(encoding="utf-8").splitlines()
    pairs = (line.split("  ") for line in lines)
    return {name.removeprefix("boot/"): digest for digest, name in pairs}
