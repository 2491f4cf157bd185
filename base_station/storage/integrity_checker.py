"""Integrity check of the log's segments: a disk may return other bytes than were written.

A segment may be damaged later, so each is checked again at intervals, and at once where a reader
meets damage.
"""

from __future__ import annotations

import logging
from collections.abc import Collection, Iterable, Mapping, Sequence
from pathlib import Path
from threading import Lock

from base_station.storage.missing_segments import LogGap
from shared.coded_text import Term, coded
from shared.errors import LogError
from shared.mcap_log import (
    SegmentInfo,
    SegmentReader,
    SegmentState,
    foreign_in_words,
    missing_segments,
)

_log = logging.getLogger(__name__)


_MOST_NAMED = 5
_AGAIN_LOOKS = 720  # with nothing left to look at: an hour of a station's housekeeping


class IntegrityChecker:
    """Checks the complete segments in turn, one a call, again and again; from any thread."""

    def __init__(self, remedy: Term) -> None:
        """``remedy``: what a person can do about a damaged one."""
        self._remedy = remedy
        self._lock = Lock()
        self._read: set[Path] = set()
        self._idle = 0  # calls since all were read
        self._damaged: dict[Path, str] = {}  # with the damage
        self._cut: set[Path] = set()  # of these, those that can be read and lack something
        self._missing: tuple[int, ...] = ()  # numbers between those that are there
        self._lacks: dict[str, LogGap] = {}  # by name: found as the station started
        self._foreign: dict[Path, str] = {}  # files that are no segments, with the reason

    def check_next_segment(self, segments: Iterable[SegmentInfo]) -> None:
        """Check one more segment: the check of a long log must not delay other work."""
        segments = tuple(segments)
        with self._lock:
            self._missing = tuple(missing_segments(one.path for one in segments))
            new = (one.path for one in segments if one.state is not SegmentState.OPEN)
            path = next((one for one in new if one not in self._read), None)
            if path is None:
                self._idle += 1
                if self._idle >= _AGAIN_LOOKS:
                    self._begin_again(set())
                return
            self._read.add(path)
        try:
            with SegmentReader(path) as reader:
                damage = "" if reader.is_whole() else "; ".join(reader.damage)
        except LogError as error:
            damage = str(error)
        if damage:
            self.note_damaged(path, damage)
        else:  # it may have been put back from a backup
            self.note_mended(path, again=False)

    def note_damaged(self, path: Path, damage: str, *, is_cut: bool = False) -> None:
        """Note that a segment cannot be read completely, or has lost a part (``is_cut``)."""
        with self._lock:
            known = path in self._damaged
            self._damaged[path] = damage
            if is_cut:
                self._cut.add(path)
        if not known:
            _log.error("the log is damaged: %s", damage)

    def note_lacks(self, folder: Path, lacks: Iterable[LogGap]) -> None:
        """Note gaps of the log that were found at the start."""
        for lack in lacks:
            _log.error("the log lacks something: %s", lack.in_words())
            with self._lock:
                self._lacks[lack.name or str(lack.number)] = lack
                if not lack.is_file_missing:
                    self._damaged[folder / lack.name] = lack.in_words()
                    self._cut.add(folder / lack.name)

    def note_foreign(self, foreign: Mapping[Path, str]) -> None:
        for path, reason in foreign.items():
            _log.error("%s", foreign_in_words(path, reason))
        with self._lock:
            self._foreign = dict(foreign)

    @property
    def lacking(self) -> Collection[str]:
        """Names of segments of which something is gone."""
        with self._lock:
            return frozenset(self._lacks)

    def has_lost(self, t_ns: int) -> bool:
        """True if the log has lost records of about this time."""
        with self._lock:
            return any(lack.covers(t_ns) for lack in self._lacks.values())

    def recheck(self, what: str) -> None:
        """Check a segment again in which a reader has met damage."""
        with self._lock:
            if not any(path.name in what for path in self._damaged):
                self._begin_again(set(self._damaged))

    def _begin_again(self, but_for: set[Path]) -> None:
        self._idle = 0
        self._read = but_for

    @property
    def damaged(self) -> tuple[Path, ...]:
        """Segments of which not everything can be read, oldest first."""
        with self._lock:
            return tuple(sorted(self._damaged))

    @property
    def missing(self) -> tuple[int, ...]:
        """Numbers of missing segments."""
        with self._lock:
            missing = {lack.number for lack in self._lacks.values() if lack.is_file_missing}
            return tuple(sorted(missing | set(self._missing)))

    def note_mended(self, path: Path, *, again: bool = True) -> None:
        """Note that a segment can be read completely; ``again``: it was rewritten, and is checked
        again.
        """
        with self._lock:
            if again:
                self._read.discard(path)
                self._cut.discard(path)
            if path not in self._cut:
                self._damaged.pop(path, None)
                self._lacks.pop(path.name, None)

    def problems(self) -> tuple[str, ...]:
        """Sentences for the console."""
        with self._lock:
            lacks, foreign = dict(self._lacks), sorted(path.name for path in self._foreign)
            damaged = sorted(path.name for path in self._damaged if path.name not in lacks)
            missing = set(self._missing) - {lack.number for lack in lacks.values()}
        problems: list[str] = []
        if lacks:
            problems.append(
                coded(
                    "log-part-lost",
                    "A part of the log is lost: {lost}: check the disk. {remedy}",
                    lost=_in_words(list(lacks.values())),
                    remedy=self._remedy,
                )
            )
        if foreign:
            problems.append(
                coded(
                    "log-foreign-files",
                    "Files in the log's folder are no segments of this log and are left out "
                    "({files}): see who put them there, and move them away",
                    files=", ".join(foreign),
                )
            )
        if damaged:
            problems.append(
                coded(
                    "log-damaged",
                    "A part of the log cannot be read any more ({files}): check the disk. {remedy}",
                    files=", ".join(damaged),
                    remedy=self._remedy,
                )
            )
        if missing:
            problems.append(
                coded(
                    "log-files-gone",
                    "Files of the log are gone, by their numbers {segments}: check the disk, "
                    "restore them from a backup, and start the station again",
                    segments=", ".join(map(str, sorted(missing))),
                )
            )
        return tuple(problems)


def _in_words(lacks: Sequence[LogGap]) -> str:
    """One text, made from its end on, so that a code of each gap is in it."""
    named, more = [lack.in_words() for lack in lacks[:_MOST_NAMED]], len(lacks) - _MOST_NAMED
    text = coded("gaps-more", "and {count} more", count=more) if more > 0 else named.pop()
    for one in reversed(named):
        text = coded("gaps-joined", "{first}; {others}", first=one, others=text)
    return text
