"""Packs the complete segments of the log of a running station, which take two thirds of the room
then.  Each is packed by a process of its own: work that lasts seconds would delay the live picture
in this one.
"""

from __future__ import annotations

import logging
import subprocess
import sys
from collections.abc import Iterable
from contextlib import AbstractContextManager
from pathlib import Path
from threading import Lock
from typing import Protocol

from shared.mcap_log import SegmentInfo, SegmentState, can_be_packed
from shared.worker import Worker

_log = logging.getLogger(__name__)

_LOOK_INTERVAL_S = 5.0
_PAUSE_S = 1.0  # between two segments
_ROOM_SHARE = 4  # free room of the disk, by the size of the segment: the live log goes before


class PackedLog(Protocol):
    """The log as files, while a station writes it."""

    @property
    def rewriting(self) -> AbstractContextManager[object]:
        """Entered while a complete segment is exchanged."""
        ...

    def segments(self) -> Iterable[SegmentInfo]: ...

    @property
    def disk_free_bytes(self) -> int: ...

    def note_rewritten(self, path: Path) -> None:
        """This segment is another file now."""
        ...


class SegmentPacker:
    """As a context manager it works from the beginning until the end of the block."""

    def __init__(self, log: PackedLog) -> None:
        self._recorded = log
        self._seen: set[tuple[Path, int]] = set()  # with the size: one that was rewritten is new
        self._lock = Lock()  # guards the field below
        self._process: subprocess.Popen[str] | None = None
        self._worker = Worker("segment-packer", self._step, "segments of the log are not packed")

    def __enter__(self) -> SegmentPacker:
        self._worker.start()
        return self

    def __exit__(self, *_: object) -> None:
        """A segment that is being packed stays as it is."""
        self._worker.stop()
        with self._lock:
            if self._process is not None:
                self._process.terminate()
        self._worker.join()

    def _step(self) -> float:
        segment = self._next()
        if segment is None:
            return _LOOK_INTERVAL_S
        with self._recorded.rewriting:
            if not self._pack(segment.path):
                return _PAUSE_S
            self._recorded.note_rewritten(segment.path)
        _log.info(
            "%s is packed: %.1f MB instead of %.1f",
            segment.path.name,
            segment.path.stat().st_size / 1e6,
            segment.size_bytes / 1e6,
        )
        return _PAUSE_S

    def _next(self) -> SegmentInfo | None:
        free_bytes = self._recorded.disk_free_bytes
        for segment in self._recorded.segments():
            seen = segment.path, segment.size_bytes
            has_room = free_bytes >= _ROOM_SHARE * segment.size_bytes
            if segment.state is SegmentState.CLOSED and has_room and seen not in self._seen:
                self._seen.add(seen)
                if can_be_packed(segment.path):
                    return segment
        return None

    def _pack(self, path: Path) -> bool:
        """False: it stays as it is."""
        command = [sys.executable, "-m", "base_station.storage.packing_process", str(path)]
        with self._lock:
            if self._worker.stopping.is_set():
                return False
            self._process = subprocess.Popen(
                command,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.PIPE,
                text=True,
            )
        with self._process:
            _, error_text = self._process.communicate()
        with self._lock:  # else the end of the block might find none to stop
            code, self._process = self._process.returncode, None
        if code and error_text and not self._worker.stopping.is_set():
            _log.warning("%s", error_text.strip())
        return code == 0
