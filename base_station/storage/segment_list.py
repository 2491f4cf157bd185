"""List of the log's complete segments, recovered after a crash."""

from __future__ import annotations

import errno
import logging
from collections.abc import Callable
from pathlib import Path
from threading import Lock

from shared.errors import LogError
from shared.mcap_log import Recovery, SegmentInfo, SegmentReader, own_segments, recover_log

logger = logging.getLogger(__name__)

_TAKES_NOTHING = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EROFS)  # of a full disk, or a
# failed one that the system has made read-only
SegmentHandler = Callable[[SegmentInfo, str], None]  # a segment, and the note of its recovery


def ignore_segment(_: SegmentInfo, __: str) -> None:
    """For a recorder without a list of segments."""


class SegmentList:
    """Complete segments of a log in order; may be read and changed from any thread."""

    def __init__(self, folder: Path, on_segment: SegmentHandler) -> None:
        """Recover the segments in ``folder``, and list them.

        ``on_segment`` is called with each of them, and with each that is added.  Raises LogError.
        """
        self._on_segment = on_segment
        self._lock = Lock()
        self.recoveries: tuple[Recovery, ...] = _recover(folder)
        own, self.foreign = own_segments(folder)
        self._segments = tuple(map(_info_of, own))
        notes = {recovery.path: str(recovery) for recovery in self.recoveries}
        for info in self._segments:
            self._report(info, notes.get(info.path, ""))

    @property
    def segments(self) -> tuple[SegmentInfo, ...]:
        return self._segments

    def add(self, info: SegmentInfo) -> None:
        """Add a segment that is complete now."""
        with self._lock:
            self._segments = (*self._segments, info)
        self._report(info, "")

    def note_rewritten(self, path: Path) -> None:
        """Read the description of a segment again, whose content was replaced."""
        info = _info_of(path)
        with self._lock:
            self._segments = tuple(info if one.path == path else one for one in self._segments)

    def _report(self, info: SegmentInfo, note: str) -> None:
        try:
            self._on_segment(info, note)
        except Exception:
            logger.exception("segment %s is not in the list of segments", info.path.name)


def _info_of(path: Path) -> SegmentInfo:
    with SegmentReader(path) as reader:
        return reader.info()


def _recover(folder: Path) -> tuple[Recovery, ...]:
    """Recover the segments.  A full or read-only disk does not prevent the start: a torn segment
    stays readable, and is recovered at a later start.  Raises LogError.
    """
    try:
        return tuple(recover_log(folder))
    except LogError as error:
        if getattr(error.__cause__, "errno", None) not in _TAKES_NOTHING:
            raise
        logger.warning("%s", error)
        return ()
