"""A log as a folder: the names of its segments, which are their order and their times."""

from __future__ import annotations

import re
from collections.abc import Iterable
from datetime import UTC, datetime
from itertools import zip_longest
from pathlib import Path

from shared.clock import NS_PER_S

_TIME = "%Y%m%dT%H%M%SZ"
_NAME = re.compile(r"(\d{6,})-(\d{8}T\d{6}Z)\.mcap(?:\.torn\d*)?")


def segment_path(folder: Path, number: int, began_ns: int) -> Path:
    """The name of a new segment, whose first record has log time ``began_ns``."""
    began = datetime.fromtimestamp(began_ns // NS_PER_S, UTC).strftime(_TIME)
    return folder / f"{number:06d}-{began}.mcap"


def segment_paths(folder: Path) -> list[Path]:
    """The segments of a log in the order of writing."""
    if not folder.is_dir():
        return []
    return sorted(
        (path for path in folder.iterdir() if path.suffix == ".mcap" and segment_number(path)),
        key=segment_number,
    )


def unnumbered_paths(folder: Path) -> list[Path]:
    """MCAP files beside the segments, under names that are not those of segments."""
    if not folder.is_dir():
        return []
    return sorted(
        path for path in folder.iterdir() if path.suffix == ".mcap" and not segment_number(path)
    )


def segment_began_ns(path: Path) -> int:
    """The log time of a segment's first record, in whole seconds, from its name."""
    match = _NAME.fullmatch(path.name)
    assert match is not None
    began = datetime.strptime(match.group(2), _TIME).replace(tzinfo=UTC)
    return int(began.timestamp()) * NS_PER_S


def segment_number(path: Path) -> int:
    """0 where the name is not that of a segment."""
    match = _NAME.fullmatch(path.name)
    return int(match.group(1)) if match else 0


def missing_segments(paths: Iterable[Path]) -> list[int]:
    """Numbers between those of the segments that are there: they are given one by one."""
    numbers = {segment_number(path) for path in paths} - {0}
    return sorted(set(range(min(numbers, default=0), max(numbers, default=0))) - numbers)


def segments_within(paths: list[Path], start_ns: int | None, end_ns: int | None) -> list[Path]:
    """The segments that can have records of the window, by the times in their names."""
    return [
        path
        for path, following in zip_longest(paths, paths[1:])
        if (end_ns is None or segment_began_ns(path) < end_ns)
        and (  # the second in which the following one began is the last of this one
            start_ns is None
            or following is None
            or segment_began_ns(following) + NS_PER_S > start_ns
        )
    ]
