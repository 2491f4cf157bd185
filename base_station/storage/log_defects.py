"""Defects of a log, as coded sentences for a person; reading the log may add more."""

from __future__ import annotations

import sys
from collections.abc import Callable, Collection, Iterator, Sequence
from itertools import groupby
from pathlib import Path

from base_station.storage.missing_segments import KnownSegment, LogGap, log_gaps, times_of
from shared.coded_text import coded, text_of_error
from shared.errors import LogError
from shared.mcap_log import (
    SegmentInfo,
    SegmentReader,
    SegmentState,
    foreign_in_words,
    is_foreign_note,
    own_segments,
    segment_began_ns,
)


class LogDefects:
    """Defects found so far: one thread checks, any may read."""

    def __init__(
        self,
        log: Path,
        known: Collection[KnownSegment] = (),
        *,
        is_written: bool = False,
        from_ns: int = 0,
        until_ns: int | None = None,
        on_defect: Callable[[str], None] = lambda _: None,
    ) -> None:
        """``known``: the segments by the database.  ``is_written``: a station writes the newest
        one.  ``from_ns``: segments that end before it are not read.  ``until_ns``: later losses are
        no flaw.  ``on_defect`` receives each flaw.
        """
        self._log = log
        self._known = known
        self._is_written = is_written
        self._from_ns = from_ns
        self._until_ns = until_ns
        self._on_defect = on_defect
        self._found: tuple[str, ...] = ()
        self._segments: list[SegmentInfo] | None = None
        self._search = self._searches()

    def check_next_chunk(self) -> bool:
        """Check one more chunk of the log; False: all of it is checked."""
        return next(self._search, None) is not None

    def note(self, flaw: str) -> bool:
        """Report a defect once, also if readers meet it again; True if it is new."""
        if flaw in self._found:
            return False
        self._found = (*self._found, flaw)
        self._on_defect(flaw)
        return True

    def note_damage(self, what: str) -> bool:
        """Note damage that a reader of the log has met; True if it is new."""
        if is_foreign_note(what):
            return self.note(what)
        return self.note(
            coded("log-part-unreadable", "a part of the log cannot be read: {part}", part=what)
        )

    def note_foreign(self, path: Path, reason: str) -> bool:
        return self.note(foreign_in_words(path, reason))

    def __call__(self) -> Sequence[str]:
        return self._found

    def check_files(self) -> list[SegmentInfo]:
        """Check the list of files and how each ends; their content is not read."""
        if self._segments is None:
            own, foreign = own_segments(self._log)
            for path, reason in foreign.items():
                self.note_foreign(path, reason)
            written = own[-1:] if self._is_written else []
            self._segments = [_info_of(path) for path in own if path not in written]
            lacks = log_gaps(
                [*self._segments, *map(open_segment_info, written)],
                [one for one in self._known if not self._is_behind(one.first_ns)],
            )
            for flaw in _in_words([one for one in lacks if not self._is_behind(one.from_ns)]):
                self.note(flaw)
            for segment in self._segments:
                self._check_end(segment)
        return self._segments

    def _is_behind(self, t_ns: int) -> bool:
        return self._until_ns is not None and t_ns > self._until_ns

    def _searches(self) -> Iterator[bool]:
        for segment in self.check_files():
            if segment.end_ns >= self._from_ns and not self._is_behind(segment.start_ns):
                yield from self._check_content(segment)

    def _check_end(self, segment: SegmentInfo) -> None:
        if segment.state is SegmentState.CLOSED:
            return
        with SegmentReader(segment.path) as reader:
            for damage in reader.damage:
                self.note_damage(damage)
            if reader.bytes_lost:
                self.note(
                    coded(
                        "segment-torn",
                        "{file} was not ended in order: its last {count} bytes cannot be read",
                        file=segment.path.name,
                        count=reader.bytes_lost,
                    )
                )

    def _check_content(self, segment: SegmentInfo) -> Iterator[bool]:
        try:
            with SegmentReader(segment.path) as reader:
                for _ in reader.intact_chunks():
                    yield True
                for damage in reader.damage:
                    self.note_damage(damage)
        except LogError as error:  # it is taken away meanwhile
            self.note(text_of_error(error))


def _info_of(path: Path) -> SegmentInfo:
    with SegmentReader(path) as reader:
        return reader.info()


def open_segment_info(path: Path) -> SegmentInfo:
    """Describe a segment by its file alone: counting its records would mean to read it."""
    began_ns = segment_began_ns(path)
    return SegmentInfo(path, SegmentState.OPEN, began_ns, began_ns, sys.maxsize, 0)


def _in_words(lacks: Sequence[LogGap]) -> Iterator[str]:
    """Describe missing files in words; consecutive ones are one sentence."""
    yield from (lack.in_words() for lack in lacks if not lack.is_file_missing)
    missing = sorted((lack for lack in lacks if lack.is_file_missing), key=lambda lack: lack.number)
    for _, run in groupby(enumerate(missing), lambda one: one[1].number - one[0]):
        together = [lack for _, lack in run]
        yield _missing_files(together[0], together[-1])


def _missing_files(first: LogGap, last: LogGap) -> str:
    what = times_of(first.from_ns, last.until_ns)
    if first is last:
        return coded(
            "log-segment-missing",
            "segment {number} of the log is missing: {what} is not known",
            number=first.number,
            what=what,
        )
    return coded(
        "log-segments-missing",
        "segments {first} to {last} of the log are missing: {what} is not known",
        first=first.number,
        last=last.number,
        what=what,
    )
