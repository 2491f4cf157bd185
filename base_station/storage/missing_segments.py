"""Missing segments of a log, found by comparing its files with each other and with the database.
Pure.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from pathlib import Path

from shared.clock import NS_PER_S
from shared.coded_text import Measure, coded
from shared.mcap_log import SegmentInfo, SegmentState, segment_began_ns, segment_number

_KILLED_NS = 2 * NS_PER_S  # of the newest segment, which a kill may lose


@dataclass(frozen=True, slots=True)
class KnownSegment:
    """A segment, as last recorded in the database."""

    name: str
    first_ns: int
    last_ns: int
    messages: int
    log_id: str = ""  # of the log; empty: an earlier version wrote it


def names_between(known: Iterable[KnownSegment], from_ns: int, until_ns: int) -> set[str]:
    """Names of segments with messages between two station times."""
    return {
        one.name
        for one in known
        if one.messages and one.first_ns <= until_ns and one.last_ns >= from_ns
    }


@dataclass(frozen=True, slots=True)
class LogGap:
    """Loss in a segment, between these times; 0: unknown."""

    number: int
    name: str  # empty: only its number is known
    from_ns: int
    until_ns: int
    kept: int = 0  # its messages
    of: int = 0  # 0: unknown
    is_file_missing: bool = False  # the file itself
    is_newest: bool = False  # the table is some seconds behind, so it may have more records

    def covers(self, t_ns: int) -> bool:
        return self.from_ns <= t_ns and (self.is_newest or t_ns <= self.until_ns)

    def in_words(self) -> str:
        what = times_of(self.from_ns, self.until_ns)
        if self.is_file_missing and not self.name:
            return coded(
                "gap-number-missing",
                "segment {number} is missing: {what} is not known, or not all of it",
                number=self.number,
                what=what,
            )
        if self.is_file_missing:
            return coded(
                "gap-file-missing",
                "{file} is missing: {what} is not known, or not all of it",
                file=self.name,
                what=what,
            )
        if not self.kept:
            return coded(
                "gap-file-empty",
                "{file} is empty: {what} is not known, or not all of it",
                file=self.name,
                what=what,
            )
        return coded(
            "gap-messages-missing",
            "{file} has {kept} of its {of} messages: {what} is not known, or not all of it",
            file=self.name,
            kept=self.kept,
            of=self.of,
            what=what,
        )


def times_of(from_ns: int, until_ns: int) -> str:
    """Time span of a gap, in words; 0: unknown."""
    if from_ns and until_ns:
        return coded(
            "time-between",
            "what happened from {from_utc_s} until {until_utc_s}",
            from_utc_s=_utc(from_ns),
            until_utc_s=_utc(until_ns),
        )
    if from_ns:
        return coded("time-since", "what happened from {from_utc_s}", from_utc_s=_utc(from_ns))
    if until_ns:
        return coded("time-until", "what happened until {until_utc_s}", until_utc_s=_utc(until_ns))
    return coded("time-unknown", "what happened")


def log_gaps(segments: Sequence[SegmentInfo], known: Collection[KnownSegment]) -> list[LogGap]:
    """``segments``: those that are there, in their order."""
    by_name = {one.name: one for one in known}
    present = {one.path.name for one in segments}
    found = {
        one.name: _missing_file(one.name, one.first_ns, one.last_ns, one.messages)
        for one in known
        if one.name not in present and one.messages
    }
    for at, segment in enumerate(segments):
        following = segments[at + 1] if at + 1 < len(segments) else None
        lack = _cut(segment, following, by_name.get(segment.path.name))
        if lack is not None:
            found[segment.path.name] = lack
    numbers = {segment_number(Path(name)) for name in (*present, *found)}
    newest = max(numbers, default=0)
    lacks = [
        replace(one, is_newest=one.number == newest)
        for one in (*found.values(), *_between(segments, numbers))
    ]
    return sorted(lacks, key=lambda one: (one.from_ns, one.number))


def _missing_file(name: str, first_ns: int, last_ns: int, messages: int) -> LogGap:
    number = segment_number(Path(name))
    return LogGap(number, name, first_ns, last_ns, of=messages, is_file_missing=True)


def _cut(
    segment: SegmentInfo, following: SegmentInfo | None, known: KnownSegment | None
) -> LogGap | None:
    """Return the loss in a cut file; a segment has a record from its start, so none is empty."""
    is_short = known is not None and segment.messages < known.messages
    if known and not following and known.last_ns - segment.end_ns <= _KILLED_NS:
        is_short = False
    is_emptied = not segment.messages and segment.state is not SegmentState.OPEN
    if not is_short and not (is_emptied and (known is None or known.messages)):
        return None
    number, name = segment_number(segment.path), segment.path.name
    last_ns = known.last_ns if known else following.start_ns if following else 0
    is_tail = segment.end_ns < last_ns
    first_ns = known.first_ns if known else segment_began_ns(segment.path)
    from_ns = segment.end_ns if is_tail and segment.messages else first_ns
    of = known.messages if known else 0
    return LogGap(number, name, from_ns, last_ns, segment.messages, of)


def _between(segments: Sequence[SegmentInfo], numbers: Collection[int]) -> list[LogGap]:
    """Senders of whose sequence numbers nothing is known but that they must have been there."""
    by_number: Mapping[int, SegmentInfo] = {segment_number(one.path): one for one in segments}
    lacks = []
    for number in sorted(set(range(1, max(by_number, default=0))) - set(numbers)):
        before = [one for at, one in by_number.items() if at < number]
        after = [one for at, one in by_number.items() if at > number]
        from_ns = max((one.end_ns for one in before), default=0)
        until_ns = min((one.start_ns for one in after if one.start_ns), default=0)
        lacks.append(LogGap(number, "", from_ns, until_ns, is_file_missing=True))
    return lacks


def _utc(t_ns: int) -> Measure:
    second = datetime.fromtimestamp(t_ns // NS_PER_S, UTC)
    return Measure(t_ns / NS_PER_S, f"{second:%Y-%m-%d %H:%M:%S} UTC")
