"""Files that were brought into incidents: each as it came, beside its converted content.

The log has the list of those that belong to an incident (``ImportFile``), with the hash of each; a
second station has that from the log, and not the file.
"""

from __future__ import annotations

import os
import re
import secrets
import shutil
import time
from collections.abc import Collection, Iterable, Iterator
from contextlib import contextmanager
from hashlib import file_digest
from pathlib import Path
from typing import TypeVar

import msgspec

from base_station.storage.private_files import write_atomically
from shared.coded_text import Measure, TextCode, code_of_text, coded
from shared.durable_names import sync_folder
from shared.errors import StoreError
from shared.file_faults import making_fault, removal_fault
from shared.own_files import make_folder, read_own, write_own

_PRIVATE = 0o700
_INCOMING = "incoming"
# Not by its own ending: a .mcap in a station's folder would be taken for a part of its log.
_ORIGINAL, _CONTENT, _SUMMARY = ".original", ".content", ".summary"
_SUFFIXES = (_ORIGINAL, _CONTENT, _SUMMARY)
_ATTACHED = "imports/"
_OWN_NAME = re.compile(rf"[0-9a-f]{{32}}({'|'.join(map(re.escape, _SUFFIXES))})")
_MOST_NAMES = 100
_LEFT_AFTER_S = 86_400.0
KEEP_FREE_BYTES = 500_000_000  # of the disk, for the log


class ImportedPoint(msgspec.Struct, frozen=True, array_like=True, gc=False):
    t_ns: int  # UTC
    lat_deg: float  # WGS-84
    lon_deg: float
    height_m: float | None = None  # above the ellipsoid or the sea, as in the file
    floor: int | None = None  # of the building, where another station knew it


class ImportedTrack(msgspec.Struct, frozen=True):
    """Way of a person or thing, by time; a photograph is a track of one point."""

    name: str
    points: tuple[ImportedPoint, ...]


class ImportSummary(msgspec.Struct, frozen=True):
    """Summary of a file, for a list of imports."""

    tracks: int
    names: tuple[str, ...]  # of the first tracks
    warnings: tuple[str, ...]
    warning_codes: tuple[TextCode, ...] = ()  # of ``warnings``, in their order


class ImportedContent(msgspec.Struct, frozen=True):
    """Content of a file that could be read; ``warnings``: sentences about what was left out."""

    format: str  # name of the importer that has read it
    tracks: tuple[ImportedTrack, ...]
    warnings: tuple[str, ...] = ()
    picture: bytes | None = None  # small JPEG, of a photograph
    warning_codes: tuple[TextCode, ...] = ()  # of ``warnings``, in their order

    @property
    def summary(self) -> ImportSummary:
        names = tuple(track.name for track in self.tracks[:_MOST_NAMES])
        return ImportSummary(len(self.tracks), names, self.warnings, self.warning_codes)

    def with_warnings(self, warnings: Iterable[str]) -> ImportedContent:
        """With more warnings, and their codes."""
        more = tuple(warnings)
        return msgspec.structs.replace(
            self,
            warnings=(*self.warnings, *map(str, more)),
            warning_codes=(*self.warning_codes, *map(code_of_text, more)),
        )

    @property
    def span_ns(self) -> tuple[int, int]:
        """First and last time."""
        times_ns = [point.t_ns for track in self.tracks for point in track.points]
        return min(times_ns), max(times_ns)


_Part = TypeVar("_Part", ImportedContent, ImportSummary)


class ImportFolder:
    """``imports`` in a station's folder, with a folder for each incident."""

    def __init__(self, path: Path) -> None:
        self.path = path

    def require_room(self, size_bytes: int) -> None:
        """StoreError where a file of that size would leave too little of the disk to the log."""
        self._make(self.path)
        free_bytes = shutil.disk_usage(self.path).free
        if free_bytes - size_bytes < KEEP_FREE_BYTES:
            raise StoreError(
                coded(
                    "import-disk-full",
                    "the disk has {free_mb} MB left, of which the log needs {needed_mb}: the file "
                    "is not taken; make room first",
                    free_mb=_mebibytes(free_bytes),
                    needed_mb=_mebibytes(KEEP_FREE_BYTES),
                )
            )

    @contextmanager
    def incoming(self) -> Iterator[Path]:
        """Path for a file while it comes; nothing of it is left there afterwards.

        Raises StoreError where the disk takes no more.
        """
        folder = self.path / _INCOMING
        self._make(folder)
        path = folder / secrets.token_hex(8)
        try:
            _remove_left(folder)
            yield path
        except OSError as error:
            raise StoreError(_not_kept(error)) from error
        finally:
            path.unlink(missing_ok=True)

    def copy(self, original: Path, path: Path) -> None:
        """Copy a file to where it is incoming.  Raises OSError."""
        with original.open("rb") as source, write_own(path, 0o600) as target:
            shutil.copyfileobj(source, target, 1 << 20)

    def keep(self, incident_id: str, import_id: str, path: Path, content: ImportedContent) -> None:
        """Move an incoming file to its final place, with its converted content.

        Raises StoreError, and leaves nothing of it, where the disk takes no more.
        """
        folder = self.path / incident_id
        self._make(folder)
        (folder / f"{import_id}{_SUMMARY}").unlink(missing_ok=True)
        try:
            with read_own(path) as file:
                os.fsync(file.fileno())
            path.replace(folder / f"{import_id}{_ORIGINAL}")
            write_atomically(folder / f"{import_id}{_CONTENT}", msgspec.msgpack.encode(content))
            write_atomically(  # the last: a file without one is not here
                folder / f"{import_id}{_SUMMARY}", msgspec.msgpack.encode(content.summary)
            )
        except OSError as error:
            self.remove(incident_id, import_id)
            raise StoreError(_not_kept(error)) from error
        except StoreError:
            self.remove(incident_id, import_id)
            raise

    def content(self, incident_id: str, import_id: str) -> ImportedContent | None:
        """None where the file is not here.  Raises StoreError where it cannot be read."""
        if self.summary(incident_id, import_id) is None:
            return None
        return self._read(incident_id, f"{import_id}{_CONTENT}", ImportedContent)

    def summary(self, incident_id: str, import_id: str) -> ImportSummary | None:
        """As ``content``."""
        return self._read(incident_id, f"{import_id}{_SUMMARY}", ImportSummary)

    def _read(self, incident_id: str, name: str, kind: type[_Part]) -> _Part | None:
        try:
            with read_own(self.file(incident_id, name)) as file:
                return msgspec.msgpack.decode(file.read(), type=kind)
        except FileNotFoundError:
            return None
        except (OSError, msgspec.MsgspecError) as error:
            raise StoreError(
                coded(
                    "import-damaged",
                    "what was read of an imported file is damaged ({error}); bring the file in "
                    "again",
                    error=str(error),
                )
            ) from error

    def original(self, incident_id: str, import_id: str) -> Path | None:
        """The file as it came; None where it is not here."""
        path = self.file(incident_id, f"{import_id}{_ORIGINAL}")
        return path if path.is_file() else None

    def attachments(self, incident_id: str, import_ids: Iterable[str]) -> dict[str, Path]:
        """All files of these imports that are here, by the name that they have in a file of the
        incident that stands alone.
        """
        names = sorted(f"{one}{suffix}" for one in import_ids for suffix in _SUFFIXES)
        paths = {self.attached_name(name): self.file(incident_id, name) for name in names}
        return {name: path for name, path in paths.items() if path.is_file()}

    def file(self, incident_id: str, name: str) -> Path:
        """Path of a file, present or not."""
        return self.path / incident_id / name

    @staticmethod
    def attached_name(name: str) -> str:
        return f"{_ATTACHED}{name}"

    def take_from(self, incident_id: str, name: str, parts: Iterable[bytes]) -> None:
        """Keep what such a file has attached under ``name``; other names are left out.

        Raises StoreError where the disk does not take it.
        """
        own = name.removeprefix(_ATTACHED)
        if own == name or not _OWN_NAME.fullmatch(own) or Path(incident_id).name != incident_id:
            return
        folder = self.path / incident_id
        self._make(folder)
        try:
            with write_own(folder / own, 0o600) as target:
                target.writelines(parts)
        except OSError as error:
            raise StoreError(_not_kept(error)) from error

    def remove(self, incident_id: str, import_id: str) -> None:
        for suffix in (_SUMMARY, _CONTENT, _ORIGINAL):
            (self.path / incident_id / f"{import_id}{suffix}").unlink(missing_ok=True)

    def remove_all(self, incident_id: str) -> int:
        """Remove all files of an incident; gives how many there were.  Raises StoreError."""
        folder = self.path / incident_id
        files = list(folder.glob("*"))
        try:
            shutil.rmtree(folder)
            sync_folder(self.path)
        except FileNotFoundError:
            return 0
        except OSError as error:
            raise StoreError(removal_fault(folder, error)) from error
        return len(files)

    def files(self) -> Iterator[Path]:
        """All that is kept."""
        for path in sorted(self.path.glob("*/*")):
            if path.parent.name != _INCOMING:
                yield path

    def remove_others(self, kept: Collection[tuple[str, str]]) -> None:
        """Remove what is not among these incidents and ids."""
        for path in self.path.glob("*/*"):
            if (path.parent.name, path.stem) not in kept:
                path.unlink(missing_ok=True)

    def _make(self, folder: Path) -> None:
        try:
            make_folder(self.path, _PRIVATE)
            make_folder(folder, _PRIVATE)
        except OSError as error:
            raise StoreError(making_fault(folder, error)) from error


def _mebibytes(size_bytes: int) -> Measure:
    return Measure(size_bytes / 1e6, str(size_bytes >> 20))


def _not_kept(error: OSError) -> str:
    return coded(
        "import-not-kept",
        "the file cannot be kept: {error}",
        error=error.strerror or str(error),
    )


def _remove_left(folder: Path) -> None:
    """Remove files whose station or command was killed while they came."""
    for path in folder.iterdir():
        if time.time() - path.stat().st_mtime > _LEFT_AFTER_S:
            path.unlink(missing_ok=True)


def import_id_of(path: Path) -> tuple[str, str]:
    """Id in an incident, and SHA-256, of a file's bytes: the same file has the same id.

    Raises OSError.
    """
    with path.open("rb") as file:
        sha256 = file_digest(file, "sha256").hexdigest()
    return sha256[:32], sha256
