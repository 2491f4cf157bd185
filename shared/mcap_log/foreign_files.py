"""Files that stand among the segments of a log and are none of it.

A segment has the log's id in its head, begins in the second that its name says, and segments follow
each other in time.  Of what earlier versions wrote only names and times tell.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from itertools import zip_longest
from pathlib import Path
from statistics import median_low

from mcap.opcode import Opcode

from shared.clock import NS_PER_S
from shared.coded_text import Measure, code_of_text, coded
from shared.errors import LogError
from shared.mcap_log.container import CHUNK, MESSAGE, NONSENSE, message_offsets, unpacked
from shared.mcap_log.folder import (
    segment_began_ns,
    segment_number,
    segment_paths,
    unnumbered_paths,
)
from shared.mcap_log.identity import SegmentIdentity, first_chunk_at, identity_of
from shared.mcap_log.log_membership import log_id_of, segments_of_one_log
from shared.mcap_log.segment_file import SegmentFile

_LAST_NS = 3600 * NS_PER_S  # of one that none follows, so much may be lost at its beginning


@dataclass(frozen=True, slots=True)
class LogEnd:
    """Position at which a log continues."""

    log_id: str = ""  # empty: no segment of it says so
    name: str = ""  # of its newest segment
    number: int = 0  # of that, or of a torn one that is kept


def own_segments(folder: Path) -> tuple[list[Path], dict[Path, str]]:
    """The segments of a log in the order of writing, and the MCAP files beside them that are none
    of it, each with the reason in words.
    """
    foreign: dict[Path, str] = {}
    own = []
    for path, following in candidates(folder, foreign):
        if reason := foreign_by_content(path, following):
            foreign[path] = reason
        else:
            own.append(path)
    return own, foreign


def candidates(folder: Path, foreign: dict[Path, str]) -> list[tuple[Path, Path | None]]:
    """Those that may be of one log by their heads and names, each with the one that follows; the
    others go to ``foreign``.
    """
    unnamed = coded("foreign-name", "its name is not that of a segment")
    foreign |= dict.fromkeys(unnumbered_paths(folder), unnamed)
    paths = segments_of_one_log(segment_paths(folder), foreign)
    in_order = _in_order(_one_a_number(paths))
    unfit = coded("foreign-order", "its name does not go with the others")
    foreign |= dict.fromkeys([path for path in paths if path not in set(in_order)], unfit)
    return list(zip_longest(in_order, in_order[1:]))


def foreign_in_words(path: Path, reason: str) -> str:
    return coded(
        "segment-foreign",
        "{file} is no segment of this log and is left out: {reason}",
        file=path.name,
        reason=reason,
    )


def is_foreign_note(note: str) -> bool:
    """True for a text of ``foreign_in_words``."""
    return code_of_text(note).code == "segment-foreign"


def log_end(folder: Path) -> LogEnd:
    """Raises OSError where the folder cannot be read."""
    foreign: dict[Path, str] = {}
    own = [path for path, _ in candidates(folder, foreign)]
    numbers = (segment_number(path) for path in folder.iterdir() if path not in foreign)
    return LogEnd(log_id_of(own), own[-1].name if own else "", max(numbers, default=0))


def identity_in_log(path: Path) -> SegmentIdentity:
    """Identity of a segment; with a damaged head, that of the log around it."""
    around = [path for path, _ in candidates(path.parent, {})]
    return identity_of(path) or SegmentIdentity(log_id_of(around))


def _one_a_number(paths: Sequence[Path]) -> list[Path]:
    """Keeps, of two with the same number, the one that began nearer to all the others."""
    middle_ns = median_low(map(segment_began_ns, paths)) if paths else 0
    nearest: dict[int, Path] = {}
    for path in sorted(paths, key=lambda one: -abs(segment_began_ns(one) - middle_ns)):
        nearest[segment_number(path)] = path
    return [nearest[number] for number in sorted(nearest)]


def _in_order(paths: Sequence[Path]) -> list[Path]:
    """The most of them, in their order, of which none begins before the one before it."""
    lasts_ns: list[int] = []  # by length of a run: when its last one begins, at the earliest
    runs: list[list[Path]] = []
    for path in paths:
        began_ns = segment_began_ns(path)
        place = bisect_right(lasts_ns, began_ns)
        run = [*(runs[place - 1] if place else ()), path]
        lasts_ns[place : place + 1] = [began_ns]
        runs[place : place + 1] = [run]
    return runs[-1] if runs else []


def foreign_by_content(path: Path, following: Path | None) -> str:
    """Reason that a segment is of another log; empty where it is of this one, or too damaged."""
    try:
        file = SegmentFile(path)
    except LogError:
        return ""
    try:
        began_ns, first_ns = segment_began_ns(path), _first_ns(file, first_chunk_at(file))
    except NONSENSE:
        return ""
    finally:
        file.close()
    until_ns = segment_began_ns(following) if following else began_ns + _LAST_NS
    if not began_ns <= first_ns < until_ns + NS_PER_S:  # what it began with may be lost
        return coded(
            "foreign-time",
            "its records begin at {began_utc_s}, which is not when its name says",
            began_utc_s=Measure(first_ns / NS_PER_S, _utc(first_ns)),
        )
    return ""


def _first_ns(file: SegmentFile, chunk_at: int) -> int:
    """Log time of the first record; the times in the chunk's header have no checksum."""
    opcode, length = file.record_at(chunk_at)
    if opcode != Opcode.CHUNK or length < CHUNK.size:
        raise ValueError("no chunk stands there")
    data = unpacked(file.read(chunk_at + 9, length))
    offset = next(message_offsets(data, {}), None)
    if offset is None:
        raise ValueError("it is empty")
    t_ns: int = MESSAGE.unpack_from(data, offset)[4]
    return t_ns


def _utc(t_ns: int) -> str:
    return f"{datetime.fromtimestamp(t_ns // NS_PER_S, UTC):%Y-%m-%d %H:%M:%S} UTC"
