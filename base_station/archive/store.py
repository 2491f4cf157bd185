"""Storage of an archive: a folder of a disk, or a bucket with the S3 protocol."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Protocol

from shared.coded_text import coded, text_of_error
from shared.durable_names import sync_folder
from shared.errors import ArchiveError, ConfigError, UserError
from shared.out_file import whole
from shared.own_files import make_folder

BUCKET = "s3://"
CANNOT_LIST = coded("archive-cannot-list", "what is in it cannot be read")
_NO_FOLDER = coded("archive-no-folder", "there is no such folder")


class ArchiveStore(Protocol):
    """Storage of named files.  Every method raises ArchiveError if the storage fails."""

    @property
    def address(self) -> str:
        """Address as a person enters it, without secrets."""
        ...

    def put(self, name: str, content: Path) -> None:
        """Store a file, completely or not at all."""
        ...

    def size(self, name: str) -> int | None:
        """Size of an object; None if there is none of this name."""
        ...

    def read_all(self, name: str) -> bytes | None:
        """Content of a small object, by one request; None if there is none of this name."""
        ...

    def read(self, name: str, begin: int, end: int) -> bytes:
        """Bytes from ``begin`` until before ``end``, by one request."""
        ...

    def names(self, beginning: str = "") -> Sequence[str]: ...

    def remove(self, name: str) -> None: ...


def open_store(address: str) -> ArchiveStore:
    """Open a storage.  Raises UserError for an address of another kind, ConfigError if a library is
    missing.
    """
    if address.startswith(BUCKET):
        try:
            from base_station.archive.bucket import BucketStore  # noqa: PLC0415  # optional
        except ModuleNotFoundError as error:
            raise ConfigError(
                coded(
                    "archive-library-missing",
                    "{archive} needs a library that is not installed: pip install "
                    "--require-hashes -r deploy/requirements-archive.lock",
                    archive=address,
                )
            ) from error
        return BucketStore(address)
    if "://" in address:
        raise UserError(
            coded(
                "archive-no-address",
                "{archive}: an archive is a folder, or s3://BUCKET/PLACE",
                archive=address,
            )
        )
    return FolderStore(Path(address))


def cannot_write(name: str) -> str:
    return coded("archive-cannot-write", "{file} cannot be written", file=name)


def cannot_read(name: str) -> str:
    return coded("archive-cannot-read", "{file} cannot be read", file=name)


def cannot_remove(name: str) -> str:
    return coded("archive-cannot-remove", "{file} cannot be removed", file=name)


def file_short(address: str, name: str) -> ArchiveError:
    return ArchiveError(
        coded(
            "archive-file-short",
            "{archive}: {file} is shorter than it was: copy it once more",
            archive=address,
            file=name,
        )
    )


class FolderStore:
    """Each file is a file of that name below the folder."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder

    @property
    def address(self) -> str:
        return str(self._folder.absolute())

    def put(self, name: str, content: Path) -> None:
        with self._asking(cannot_write(name)):
            path = self._folder / name
            make_folder(path.parent)
            try:
                with (
                    whole(path) as making,
                    content.open("rb") as source,
                    making.open("wb") as target,
                ):
                    shutil.copyfileobj(source, target)
                    target.flush()
                    os.fsync(target.fileno())
            except UserError as error:
                reason = text_of_error(error)
                raise ArchiveError(
                    coded(
                        "archive-not-written",
                        "{archive}: {reason}",
                        archive=self.address,
                        reason=reason,
                    )
                ) from error
            sync_folder(path.parent)

    def size(self, name: str) -> int | None:
        with self._asking(cannot_read(name)):
            try:
                return (self._folder / name).stat().st_size
            except FileNotFoundError:
                return None

    def read_all(self, name: str) -> bytes | None:
        with self._asking(cannot_read(name)):
            try:
                return (self._folder / name).read_bytes()
            except FileNotFoundError:
                return None

    def read(self, name: str, begin: int, end: int) -> bytes:
        with (
            self._asking(cannot_read(name)),
            (self._folder / name).open("rb") as file,
        ):
            data = os.pread(file.fileno(), end - begin, begin)
        if len(data) < end - begin:
            raise file_short(self.address, name)
        return data

    def names(self, beginning: str = "") -> Sequence[str]:
        with self._asking(CANNOT_LIST):
            if not self._folder.is_dir():
                raise FileNotFoundError(2, _NO_FOLDER)
            files = (
                one
                for one in (self._folder / beginning.rpartition("/")[0]).rglob("*")
                if one.is_file()
            )
            names = (one.relative_to(self._folder).as_posix() for one in files)
            return sorted(one for one in names if one.startswith(beginning))

    def remove(self, name: str) -> None:
        with self._asking(cannot_remove(name)):
            (self._folder / name).unlink(missing_ok=True)

    @contextmanager
    def _asking(self, what: str) -> Iterator[None]:
        try:
            yield
        except OSError as error:
            raise ArchiveError(
                coded(
                    "archive-disk-fails",
                    "the archive {archive}: {what} ({error}); see that the disk is there, has "
                    "room, and may be used by whom the station runs as",
                    archive=self.address,
                    what=what,
                    error=error.strerror or str(error),
                )
            ) from error
