"""Whether what was written to the log is still there: a disk may give back other bytes."""

from __future__ import annotations

import logging
from collections.abc import Iterable
from pathlib import Path
from threading import Lock

from shared.errors import LogError
from shared.mcap_log import SegmentInfo, SegmentReader, SegmentState

_log = logging.getLogger(__name__)


class LogCheck:
    """Reads each complete segment once in the life of the program; from any thread."""

    def __init__(self, remedy: str) -> None:
        """``remedy``: what becomes of a damaged one, for a person."""
        self._remedy = remedy
        self._lock = Lock()
        self._read: set[Path] = set()
        self._damaged: dict[Path, str] = {}  # with what is wrong

    def look(self, segments: Iterable[SegmentInfo]) -> None:
        """At one more of them: reading a long log is to hold up nothing."""
        with self._lock:
            new = (one.path for one in segments if one.state is SegmentState.CLOSED)
            path = next((one for one in new if one not in self._read), None)
            if path is None:
                return
            self._read.add(path)
        try:
            with SegmentReader(path) as reader:
                damage = "" if reader.is_whole() else "; ".join(reader.damage)
        except LogError as error:
            damage = str(error)
        if damage:
            _log.error("the log is damaged: %s", damage)
            with self._lock:
                self._damaged[path] = damage

    @property
    def damaged(self) -> tuple[Path, ...]:
        """Segments of which not everything can be read, oldest first."""
        with self._lock:
            return tuple(sorted(self._damaged))

    def note_mended(self, path: Path) -> None:
        """It is looked at again."""
        with self._lock:
            self._read.discard(path)
            self._damaged.pop(path, None)

    def problems(self) -> tuple[str, ...]:
        """Sentences for the console."""
        with self._lock:
            names = ", ".join(sorted(path.name for path in self._damaged))
        said = (
            f"A part of the log cannot be read any more ({names}): check the disk. {self._remedy}"
        )
        return (said,) if names else ()
