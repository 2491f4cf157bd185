"""Backup of the necessary data of a station into another folder, also while the station runs.

The copy is a data folder like any other: a station that is started on it goes on from there.
Data that can be made again (checkpoints) or fetched again (raw recordings) is left out.  Of a
failing disk all readable parts are copied.
"""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

from base_station.radio.radio_log import RadioLog
from base_station.security.pki.folder import PkiFolder
from base_station.standby.log_truncation import APART, MERGED_SUFFIX
from base_station.storage.data_folder import DataFolder
from base_station.storage.db.copying import copy_database, known_segments
from base_station.storage.db.imports import ImportCatalogue
from base_station.storage.db.opening import copy_to_file, open_database
from base_station.storage.imports import ImportFolder
from shared.errors import LogError, StoreError, UserError
from shared.mcap_log import segment_paths
from shared.own_files import give_to_owner, make_folder, read_own, refuse_links, write_own

_PRIVATE = 0o700
_PART = ".part"  # of the name, until the copy is whole
_BLOCK_BYTES = 4096  # a disk reads so many bytes or none
_MTIME_STEP_NS = 2_000_000_000  # some file systems of USB sticks know only every other second


@dataclass(slots=True)
class Backup:
    """Result of one run."""

    copied: int = 0  # files, as a whole
    copied_bytes: int = 0
    unchanged: int = 0
    removed: int = 0  # segments of an earlier run that the station has no more
    unreadable: list[str] = field(default_factory=list)  # files, or parts of them

    def require_whole(self) -> None:
        """Raise LogError if anything is missing in the backup."""
        if self.unreadable:
            raise LogError(
                f"the backup lacks what the disk does not give of {', '.join(self.unreadable)}: "
                "check that disk; all the rest is there"
            )


def back_up(
    data: Path, target: Path, on_progress: Callable[[float], None], *, with_radio: bool = False
) -> Backup:
    """Bring ``target`` up to date with the station's folder ``data``; ``on_progress`` receives the
    fraction done.  ``with_radio``: with the audio of the radio channels, as long as the station
    itself keeps it.

    The database is copied before the log, so it never knows more than the log does.  Raises
    UserError where ``target`` is something else than a backup of this station, LogError where it
    cannot be written; StoreError, with all the rest copied, where the database cannot be.
    """
    source, copy = DataFolder(data), DataFolder(target)
    source.require()
    refuse_links(target)
    _require_own_target(source, copy)
    try:
        make_folder(target, _PRIVATE)
        without = _copy_database(source, copy)
        done = _copy_files(source, copy, on_progress, with_radio=with_radio)
    except OSError as error:
        raise LogError(
            f"the backup to {target} is not complete ({error.strerror or error}): make room or "
            "choose another place, and give the command again; what is there stays, and is of use"
        ) from error
    if without is not None:
        raise without
    return done


def _require_own_target(source: DataFolder, copy: DataFolder) -> None:
    here, there = source.path.resolve(), copy.path.resolve()
    if here == there or here in there.parents or there in here.parents:
        raise UserError(f"{copy.path} is not apart from the station's folder; choose another")
    if all(path.suffix == _PART for path in copy.path.rglob("*") if path.is_file()):
        return  # nothing, or the rest of a first run after a kill
    kept = {path.name for path in segment_paths(copy.log)} | known_segments(copy.database)
    if not kept & {path.name for path in segment_paths(source.log)}:
        raise UserError(
            f"{copy.path} holds something else than a backup of this station; give an empty "
            "folder, or one that does not exist yet"
        )


def _copy_database(source: DataFolder, copy: DataFolder) -> StoreError | None:
    """Copy the database; return the reason why it cannot be copied, empty if it was.  The log has
    positions and alarms in any case.
    """
    try:
        with _part_of(copy.database) as part:
            if not copy_to_file(source.database, part):
                copy_database(source.database, part)
    except StoreError as error:
        return error
    return None


def _copy_files(
    source: DataFolder,
    copy: DataFolder,
    on_progress: Callable[[float], None],
    *,
    with_radio: bool,
) -> Backup:
    done = Backup()
    _rename_handed_over(source, copy)
    audio = _audio_files(source) if with_radio else ()
    sizes = {path: _size_of(path) for path in (*_files(source), *audio)}
    total, passed = sum(sizes.values()) or 1, 0
    for path, size in sizes.items():
        target = copy.path / path.relative_to(source.path)
        if _is_unchanged(path, target):
            done.unchanged += 1
        else:
            make_folder(target.parent, _PRIVATE)
            with _part_of(target) as part:
                complete = _copy_file(path, part)
            if complete:
                done.copied, done.copied_bytes = done.copied + 1, done.copied_bytes + size
            else:
                done.unreadable.append(path.name)
        passed += size
        on_progress(passed / total)
    if not source.pending_erasures.exists():
        copy.pending_erasures.unlink(missing_ok=True)  # it has names in it
    _remove_taken_out(copy)
    _remove_old_audio(source, copy)
    here = {path.name for path in segment_paths(source.log)}
    done.removed = sum(path.name not in here for path in segment_paths(copy.log))
    return done


def _remove_taken_out(copy: DataFolder) -> None:
    """Remove imports that have been removed from their incident since, or erased; those that are
    only missing at the station stay.
    """
    if not (copy.imports.is_dir() and copy.database.exists()):
        return
    imports = ImportFolder(copy.imports)
    with open_database(copy.database) as store:
        imports.remove_others(ImportCatalogue(store, imports).ids())


def _remove_old_audio(source: DataFolder, copy: DataFolder) -> None:
    """Remove audio that the station has deleted by its age."""
    for path in _audio_files(copy):
        if not (source.path / path.relative_to(copy.path)).exists():
            path.unlink()


def _audio_files(folder: DataFolder) -> Iterator[Path]:
    for channel in RadioLog(folder.radio).channels():
        yield from segment_paths(folder.radio / channel)


def _rename_handed_over(source: DataFolder, copy: DataFolder) -> None:
    """Rename parts that were set aside and were renamed when the other station had them.  A part
    under both names would be handed over once more, and erasure would not reach the one under the
    old name.
    """
    for handed_over in (source.path / APART).glob(f"*{MERGED_SUFFIX}"):
        now = copy.path / APART / handed_over.name
        before = now.with_name(handed_over.name.removesuffix(MERGED_SUFFIX))
        if now.exists():
            shutil.rmtree(before, ignore_errors=True)
        elif before.exists():
            before.rename(now)


def _size_of(path: Path) -> int:
    try:
        return path.stat().st_size
    except OSError:  # reported when it is copied
        return 0


def _copy_file(path: Path, copy: Path) -> bool:
    """Copy a file.  False if the disk does not return all of it: zeros then stand in the copy,
    which readers of a log find as damage.  Of a file that cannot be read at all there is no copy.
    """
    try:
        file = read_own(path)
    except OSError:
        return False
    complete = True
    with file, write_own(copy) as written:
        size = os.fstat(file.fileno()).st_size
        for begin in range(0, size, _BLOCK_BYTES):
            count = min(_BLOCK_BYTES, size - begin)
            try:
                block = os.pread(file.fileno(), count, begin)
            except OSError:
                complete, block = False, bytes(count)
            written.write(block)
    shutil.copystat(path, copy)
    if not complete:  # it is not current: the next run tries again
        os.utime(copy, (0, 0))
    return complete


def _files(source: DataFolder) -> Iterator[Path]:
    # Pending erasures go first: an erasure done meanwhile is done in the copy, too.
    yield from filter(Path.exists, (source.erasure_jobs, source.pending_erasures))
    yield from segment_paths(source.log)
    yield from ImportFolder(source.imports).files()
    for folder in (PkiFolder(source.path).path, source.path / APART):
        yield from sorted(path for path in folder.rglob("*") if path.is_file())


def _is_unchanged(path: Path, target: Path) -> bool:
    """True if the copy has the size and time of the segment: one that grows has another size, one
    that was rewritten another time.
    """
    try:
        now, then = path.stat(), target.stat()
    except OSError:
        return False
    return now.st_size == then.st_size and abs(now.st_mtime_ns - then.st_mtime_ns) < _MTIME_STEP_NS


@contextmanager
def _part_of(target: Path) -> Iterator[Path]:
    """Path on which a copy is made.  The copy gets its name when it is on disk; until then an older
    copy keeps that name, and after a failure nothing is left of the new one.
    """
    part = target.with_name(target.name + _PART)
    try:
        part.unlink(missing_ok=True)
        yield part
        if part.exists():
            with read_own(part) as written:
                give_to_owner(written.fileno(), target.parent)
                os.fsync(written.fileno())
            part.replace(target)
    finally:  # after a success it has its name
        part.unlink(missing_ok=True)
