"""Copies what a station cannot do without into another folder, also while the station runs.

The copy is a data folder like any other: a station that is started on it goes on from there.
What can be made again (checkpoints) or fetched again (raw recordings) stays behind.
"""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from base_station.data_folder import DataFolder
from base_station.db.store import copy_database, known_segments
from base_station.pki.folder import PkiFolder
from base_station.standby.setting_aside import APART
from shared.errors import LogError, UserError
from shared.mcap_log import segment_paths

_PRIVATE = 0o700
_PART = ".part"  # of the name, until the copy is whole
_MTIME_STEP_NS = 2_000_000_000  # some file systems of USB sticks know only every other second


@dataclass(frozen=True, slots=True)
class Backup:
    """What one run did."""

    copied: int  # files
    copied_bytes: int
    unchanged: int
    gone: int  # segments of an earlier run that the station has no more


def back_up(data: Path, target: Path, on_progress: Callable[[float], None]) -> Backup:
    """Bring ``target`` up to date with the station's folder ``data``; ``on_progress`` hears the
    fraction done.

    The database is copied before the log, so it never knows more than the log does.  Raises
    UserError where ``target`` is something else than a backup of this station, LogError where it
    cannot be written.
    """
    source, copy = DataFolder(data), DataFolder(target)
    source.require()
    _refuse_foreign(source, copy)
    try:
        target.mkdir(parents=True, exist_ok=True, mode=_PRIVATE)
        with _part_of(copy.database) as part:
            copy_database(source.database, part)
        return _copy_files(source, copy, on_progress)
    except OSError as error:
        raise LogError(
            f"the backup to {target} is not complete ({error.strerror or error}): make room or "
            "choose another place, and give the command again; what is there stays, and is of use"
        ) from error


def _refuse_foreign(source: DataFolder, copy: DataFolder) -> None:
    here, there = source.path.resolve(), copy.path.resolve()
    if here == there or here in there.parents or there in here.parents:
        raise UserError(f"{copy.path} is not apart from the station's folder; choose another")
    if all(path.suffix == _PART for path in copy.path.rglob("*") if path.is_file()):
        return  # nothing, or what a kill left of a first run
    kept = {path.name for path in segment_paths(copy.log)} | known_segments(copy.database)
    if not kept & {path.name for path in segment_paths(source.log)}:
        raise UserError(
            f"{copy.path} holds something else than a backup of this station; give an empty "
            "folder, or one that does not exist yet"
        )


def _copy_files(
    source: DataFolder, copy: DataFolder, on_progress: Callable[[float], None]
) -> Backup:
    files = list(_files(source))
    total = sum(path.stat().st_size for path in files) or 1
    passed = copied = copied_bytes = 0
    for path in files:
        target = copy.path / path.relative_to(source.path)
        size = path.stat().st_size
        if not _is_current(path, target):
            target.parent.mkdir(parents=True, exist_ok=True, mode=_PRIVATE)
            with _part_of(target) as part:
                shutil.copy2(path, part)
            copied, copied_bytes = copied + 1, copied_bytes + size
        passed += size
        on_progress(passed / total)
    if not source.begun.exists():
        copy.begun.unlink(missing_ok=True)  # it has names in it
    here = {path.name for path in segment_paths(source.log)}
    gone = sum(path.name not in here for path in segment_paths(copy.log))
    return Backup(copied, copied_bytes, len(files) - copied, gone)


def _files(source: DataFolder) -> Iterator[Path]:
    # What is to be forgotten goes first: done meanwhile, it is done in the copy, too.
    yield from filter(Path.exists, (source.forgettings, source.begun))
    yield from segment_paths(source.log)
    for folder in (PkiFolder(source.path).path, source.path / APART):
        yield from sorted(path for path in folder.rglob("*") if path.is_file())


def _is_current(path: Path, target: Path) -> bool:
    """A segment that grows has another size; one that was rewritten, another time."""
    if not target.exists():
        return False
    now, then = path.stat(), target.stat()
    return now.st_size == then.st_size and abs(now.st_mtime_ns - then.st_mtime_ns) < _MTIME_STEP_NS


@contextmanager
def _part_of(target: Path) -> Iterator[Path]:
    """Where a copy is made.  It gets its name when it is on the disk, until then an older one
    stands there; where it does not come to that, nothing is left of it.
    """
    part = target.with_name(target.name + _PART)
    try:
        part.unlink(missing_ok=True)
        yield part
        if part.exists():
            with part.open("rb") as written:
                os.fsync(written.fileno())
            part.replace(target)
    except BaseException:
        part.unlink(missing_ok=True)
        raise
