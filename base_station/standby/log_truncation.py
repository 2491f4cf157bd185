"""Cuts a log where two stations parted; the rest is kept beside it, never deleted.

DATA/apart/TIME-EVENTS-NUMBER/*.mcap    whole segments, of which what stands behind the place counts
DATA/apart/TIME-EVENTS-NUMBER.told/     the same, when the active station has taken what it lacked
"""

from __future__ import annotations

import errno
import os
import shutil
from collections.abc import Iterator
from itertools import dropwhile
from pathlib import Path

from base_station.core.log_position import START, LogPosition, Record, events_after, is_event
from base_station.standby.cut_erasures import kept_until
from base_station.storage.data_folder import DataFolder
from shared.durable_names import sync_folder
from shared.errors import LogError
from shared.mcap_log import SegmentReader, own_segments, read_log, write_segment_like
from shared.own_files import make_folder, read_own, write_own

APART = "apart"
MERGED_SUFFIX = ".told"  # of a part's name


def set_aside(folder: DataFolder, place: LogPosition) -> None:
    """Leave in the log what stands up to ``place``, or less where an erasure behind it has changed
    more (``cut_erasures``).  No station may be running on the folder.

    Interrupted, it leaves a log that ends earlier, which the standby fetches again.
    """
    scratch = folder.path / "log.part"
    shutil.rmtree(scratch, ignore_errors=True)
    try:
        until = kept_until(folder.log, place)
        apart = _new_part(folder.path, place)
        moved = list(_segments_at_or_behind(folder.log, until))
        kept = _kept(moved, until)
        make_folder(scratch)
        cut = scratch / moved[0].name if moved else None
        has_cut = cut is not None and write_segment_like(moved[0], cut, kept)
        for path in reversed(moved):
            _move(path, apart / path.name)
        if cut is not None and has_cut:
            _move(cut, folder.log / cut.name)
        scratch.rmdir()
    except OSError as error:
        raise LogError(f"the log cannot be cut ({error}): free or mend the disk") from error
    for path in folder.checkpoints.glob("*.checkpoint"):
        if int(path.stem) >= until.t_ns:
            path.unlink()


def _move(path: Path, target: Path) -> None:
    """Whole at the one place or the other; the log may be on a disk of its own."""
    try:
        path.rename(target)
        return
    except OSError as error:
        if error.errno != errno.EXDEV:
            raise
    copy = target.with_name(target.name + ".part")
    try:
        with read_own(path) as there, write_own(copy, 0o640) as here:
            shutil.copyfileobj(there, here)
            here.flush()
            os.fsync(here.fileno())
        copy.rename(target)
    except OSError:
        copy.unlink(missing_ok=True)
        raise
    sync_folder(target.parent)
    path.unlink()


def parts(data: Path) -> list[str]:
    """Names of the parts that the active station has not merged, oldest first."""
    folder = data / APART
    if not folder.is_dir():
        return []
    names = (path.name for path in folder.iterdir() if path.is_dir())
    return sorted(name for name in names if not name.endswith(MERGED_SUFFIX))


def read_part(data: Path, name: str) -> Iterator[Record]:
    """The events of one part, in order."""
    t_ns, events, _ = name.split("-")
    return events_after(LogPosition(int(t_ns), int(events)), read_log(data / APART / name))


def mark_merged(data: Path, name: str) -> None:
    part = data / APART / name
    part.rename(part.with_name(name + MERGED_SUFFIX))


def _new_part(data: Path, place: LogPosition) -> Path:
    """A station may part from the other at one place more than once."""
    number = 1
    while any((data / APART).glob(f"{place.t_ns}-{place.events}-{number}*")):
        number += 1
    part = data / APART / f"{place.t_ns}-{place.events}-{number}"
    make_folder(part)
    return part


def _segments_at_or_behind(log: Path, place: LogPosition) -> Iterator[Path]:
    own, _ = own_segments(log)
    return dropwhile(lambda path: _end_ns(path) < place.t_ns, own)


def _end_ns(path: Path) -> int:
    with SegmentReader(path) as reader:
        return reader.info().end_ns


def _kept(paths: list[Path], place: LogPosition) -> Iterator[Record]:
    """Events up to the place, with the decisions from them."""
    here = START
    for path in paths:
        with SegmentReader(path) as reader:
            for t_ns, key, payload in reader.records(derived=True):
                if is_event(key):
                    here = here.next(t_ns)
                    if here > place:
                        return
                yield t_ns, key, payload
