"""Segments of one log among the files of a folder, by what their heads say.

The log is the one that has the most of them, and what an earlier version wrote before it.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from shared.coded_text import coded
from shared.mcap_log.folder import segment_number
from shared.mcap_log.identity import PROFILE, SegmentIdentity, identity_of

_OTHER_LOG = coded("foreign-log", "it is of another log")
_OLDER = coded(
    "foreign-version",
    "an earlier version of Muster wrote it, so that it cannot go on behind this log",
)

_Heads = Mapping[Path, SegmentIdentity | None]  # None: damaged, which any segment may be


def log_id_of(paths: Iterable[Path]) -> str:
    """Identity of the log of segments in their order; empty: none states it."""
    ids = Counter(head.log_id for head in map(identity_of, paths) if head and head.log_id)
    return max(ids, key=ids.__getitem__, default="")  # of as many, the first one


def segments_of_one_log(paths: Sequence[Path], foreign: dict[Path, str]) -> list[Path]:
    """``paths``: in their order, whatever their names.  Those of none or of another log go to
    ``foreign``.
    """
    heads: _Heads = {path: identity_of(path) for path in paths}
    log_id, first = _log_of(paths, heads)
    own = []
    for at, path in enumerate(paths):
        if reason := _reason(heads[path], log_id, is_before=at < first):
            foreign[path] = reason
        else:
            own.append(path)
    return own


def _log_of(paths: Sequence[Path], heads: _Heads) -> tuple[str, int]:
    """The log's id, and where the first segment stands that has it."""
    places: dict[str, list[int]] = {}
    for at, path in enumerate(paths):
        head = heads[path]
        if head is not None and head.log_id:
            places.setdefault(head.log_id, []).append(at)
    older = [at for at, path in enumerate(paths) if heads[path] == SegmentIdentity()]
    best = ("", len(paths))
    most = (False, len(older))  # a log of an earlier version that none of the others goes on
    for log_id, found in places.items():
        before = {paths[at].name for at in older if at < found[0]}
        goes_on = not older or _follows(paths[found[0]], heads, before)
        if (goes_on, len(found)) > most:
            best, most = (log_id, found[0]), (goes_on, len(found))
    return best


def _follows(path: Path, heads: _Heads, before: set[str]) -> bool:
    """True if it was begun behind one of these, as far as can be known: that one may be lost."""
    head = heads[path]
    assert head is not None
    number = segment_number(Path(head.follows))
    is_lost = number == segment_number(path) - 1 and all(
        segment_number(Path(name)) != number for name in before
    )
    return head.follows in before or (number > 0 and is_lost)


def _reason(head: SegmentIdentity | None, log_id: str, *, is_before: bool) -> str:
    if head is None:
        return ""
    if head.profile != PROFILE:
        if not head.profile:
            return coded(
                "foreign-unnamed-program",
                "it was written by another program (which does not say so)",
            )
        return coded(
            "foreign-program",
            "it was written by another program ({program})",
            program=head.profile,
        )
    if head.log_id:
        return "" if head.log_id == log_id else _OTHER_LOG
    return "" if is_before else _OLDER
