"""Transfer of a unit's recording, one query a ``step``, so that the caller controls the rate.
Received parts are on the disk and are not requested again, also after a restart of station or unit.
"""

from __future__ import annotations

import hashlib
import logging
import os
import re
import shutil
from collections.abc import Callable, Generator
from datetime import UTC, datetime
from enum import Enum
from pathlib import Path, PurePosixPath
from typing import TypeVar

import msgspec

from base_station.unit_sync.adaptive_chunk_size import AdaptiveChunkSize
from shared.bus import Bus
from shared.channels import ROOT
from shared.clock import NS_PER_S, Clock
from shared.coded_text import Measure, coded, text_of_error
from shared.folder_lock import FolderLock
from shared.messages.recording import (
    RecordedFile,
    RecordingDigest,
    RecordingIndex,
    RecordingPiece,
)
from shared.own_files import append_own, make_folder, read_own, write_own

logger = logging.getLogger(__name__)

HASHES = "SHA256SUMS"  # as `sha256sum --check` reads it
_SPARED_BYTES = 256_000_000  # of the disk, for the station's log
_PART = ".part"
_TIMEOUT_S = 5.0  # of one question
_CHANCES = 2  # for the parts already on the disk, and for a new transfer

T = TypeVar("T")
Steps = Generator[None, None, T]  # a pause before each question
Ask = Callable[[str, str], bytes | None]  # unit, question -> the answer, where one comes


class TransferRequest(msgspec.Struct, frozen=True):
    """Request for a part of a recording; times are station time."""

    unit_id: str
    from_ns: int
    to_ns: int


class TransferState(Enum):
    WAITING = "waiting"  # the unit does not answer
    FETCHING = "fetching"
    DONE = "done"
    FAILED = "failed"

    @property
    def is_over(self) -> bool:
        return self in (TransferState.DONE, TransferState.FAILED)


class PermanentTransferError(Exception):
    """The transfer cannot continue; the text is for a person."""


class TransientTransferError(Exception):
    """The transfer continues with the next step; the text is for a person."""


class Transfer:
    """``step`` it until ``state`` is over, then ``close`` it."""

    def __init__(self, ask: Ask, folder: Path, wanted: TransferRequest, clock: Clock) -> None:
        """``folder`` is of all recordings; the unit's own is made in it.

        Raises DataFolderInUseError while another program pulls from the same unit.
        """
        self.wanted = wanted
        self.folder = folder / wanted.unit_id
        self.state = TransferState.WAITING
        self.problem = ""  # a sentence for a person
        self.total_bytes = 0  # 0: not known yet
        self.done_bytes = 0
        self._ask = ask
        self._clock = clock
        self._pace = AdaptiveChunkSize()
        self._took_ns = 0  # by the last answer
        self._announced: set[str] = set()  # files that the unit has listed since the first request
        self._missing: set[str] = set()  # of these: not here as they were listed
        self._unproven: set[str] = set()  # file whose hash the unit could not be asked for
        self._lock = FolderLock(
            self.folder, "pull of this unit's recording", "let that one end, or stop it"
        )
        self._steps = self._run()

    def step(self) -> None:
        """Send the next query; never raises for faults of a unit, a link or a disk."""
        if self.state.is_over:
            return
        try:
            next(self._steps, None)
        except PermanentTransferError as error:
            self.state, self.problem = TransferState.FAILED, text_of_error(error)
        except TransientTransferError as error:
            self.state, self.problem = TransferState.WAITING, text_of_error(error)
            self._steps = self._run()
        except OSError as error:
            self.state = TransferState.FAILED
            self.problem = coded(
                "recording-not-written",
                "the recording cannot be written to {folder} ({error}): mend or free the disk and "
                "ask again; what has come is kept",
                folder=str(self.folder),
                error=error.strerror or str(error),
            )

    def close(self) -> None:
        self._steps.close()
        self._lock.close()

    def _run(self) -> Steps[None]:
        index = yield from self._index()
        self._check(index)
        self.total_bytes = sum(one.size_bytes for one in index.files)
        paths = {one.path for one in index.files}
        self._announced |= paths
        self._missing |= paths
        before_bytes = 0
        for file in index.files:
            yield from self._file(file, before_bytes)
            before_bytes += file.size_bytes
            self.done_bytes = before_bytes
        self.state = TransferState.DONE
        self.problem = self._incomplete_files_text()

    def _incomplete_files_text(self) -> str:
        """Sentence about files that are gone or not proven; empty: there are none."""
        gone = coded(
            "recording-files-gone",
            "{count} of {total} files are gone: the unit needed the room",
            count=len(self._missing),
            total=len(self._announced),
        )
        unproven = coded(
            "recording-files-unproven",
            "{count} of {total} files came whole, but the unit gave them up before telling their "
            "hash",
            count=len(self._unproven),
            total=len(self._announced),
        )
        if self._missing and self._unproven:
            return coded("recording-flaws", "{gone}; {unproven}", gone=gone, unproven=unproven)
        return gone if self._missing else unproven if self._unproven else ""

    def _index(self) -> Steps[RecordingIndex]:
        question = f"index?from={self.wanted.from_ns};to={self.wanted.to_ns}"
        return (yield from self._answer(question, RecordingIndex.from_bytes))

    def _check(self, index: RecordingIndex) -> None:
        unit_id = self.wanted.unit_id
        if not (index.files or self._announced):
            raise PermanentTransferError(_nothing_kept(unit_id, index.first_ns))
        if not all(_is_safe(one.path) for one in index.files):
            raise PermanentTransferError(
                coded(
                    "recording-foreign-files",
                    "{unit} names files that no unit has; is it really {unit}?",
                    unit=unit_id,
                )
            )
        self._require_room(
            sum(one.size_bytes - max(map(_size, self._paths(one))) for one in index.files)
        )

    def _require_room(self, needed_bytes: int) -> None:
        """The log goes first."""
        free_bytes = shutil.disk_usage(self.folder).free - _SPARED_BYTES
        if needed_bytes > free_bytes:
            raise TransientTransferError(
                coded(
                    "recording-disk-full",
                    "the recording needs {needed_mb:.0f} MB and {spared_mb:.0f} MB can be spared "
                    "at {folder}: it goes on when the disk is freed; or stop it and choose a "
                    "shorter window",
                    needed_mb=needed_bytes / 1e6,
                    spared_mb=max(free_bytes, 0) / 1e6,
                    folder=str(self.folder),
                )
            )

    def _file(self, file: RecordedFile, before_bytes: int) -> Steps[None]:
        """Fetch a whole file; it stays missing where the unit does not have it any more."""
        whole, part = self._paths(file)
        make_folder(whole.parent)
        if 0 < _size(whole) <= file.size_bytes and not part.exists():
            with read_own(whole) as there, write_own(part) as copy:
                shutil.copyfileobj(there, copy)  # it may have grown; until more is here it stays
        for _ in range(_CHANCES):
            if not (yield from self._bytes(file, part, before_bytes)):
                if whole.exists():
                    part.unlink()
                return
            answer = yield from self._answer(
                f"digest?path={file.path};size={file.size_bytes}", RecordingDigest.from_bytes
            )
            digest = _digest_of(part)
            is_evicted = not answer.sha256  # and yet the file is complete, each piece intact
            if is_evicted or digest == answer.sha256:
                part.replace(whole)
                self._write_hash(file.path, digest.hex())
                self._missing.discard(file.path)
                self._unproven.discard(file.path)
                if is_evicted:
                    self._unproven.add(file.path)
                return
            part.unlink()
        raise PermanentTransferError(
            coded(
                "recording-file-differs",
                "{file} came out different from what {unit} has, {times} times: check the "
                "station's and the unit's disk",
                file=file.path,
                unit=self.wanted.unit_id,
                times=_CHANCES,
            )
        )

    def _paths(self, file: RecordedFile) -> tuple[Path, Path]:
        """Paths of the whole file, and of its received part."""
        whole = self.folder / PurePosixPath(file.path)
        return whole, whole.with_name(whole.name + _PART)

    def _bytes(self, file: RecordedFile, part: Path, before_bytes: int) -> Steps[bool]:
        """Append to the part until it is whole; False where the unit does not have it any more."""
        if _size(part) > file.size_bytes:
            part.unlink()
        with append_own(part) as written:
            while (offset := written.tell()) < file.size_bytes:
                self.done_bytes = before_bytes + offset
                self._require_room(file.size_bytes - offset)
                length = min(self._pace.answer_bytes, file.size_bytes - offset)
                question = f"piece?path={file.path};offset={offset};length={length}"
                piece = yield from self._try(question, RecordingPiece.from_bytes)
                if piece is None:
                    continue  # for less: perhaps the link cannot carry so much
                self._pace.note(len(piece.data), self._took_ns)
                if piece.gone:
                    return False
                if piece.offset == offset and len(piece.data) <= length and _is_intact(piece):
                    if not piece.data:
                        raise TransientTransferError(
                            coded(
                                "recording-file-shorter",
                                "{unit} has less of {file} than it had; it is asked anew what it "
                                "has",
                                unit=self.wanted.unit_id,
                                file=file.path,
                            )
                        )
                    written.write(piece.data)
                    written.flush()
            os.fsync(written.fileno())
        return True

    def _answer(self, question: str, read: Callable[[bytes], T]) -> Steps[T]:
        """Query once a step until there is a reply."""
        while True:
            answer = yield from self._try(question, read)
            if answer is not None:
                return answer

    def _try(self, question: str, read: Callable[[bytes], T]) -> Steps[T | None]:
        """Ask once; None where there is no answer."""
        yield  # the time of other transfers does not count as time of the link
        requested_ns = self._clock.monotonic_ns()
        try:
            answer = self._ask(self.wanted.unit_id, question)
            self._took_ns = self._clock.monotonic_ns() - requested_ns
            if answer is not None:
                understood = read(answer)
                self.state, self.problem = TransferState.FETCHING, ""
                return understood
        except Exception as error:  # noqa: BLE001  # any error means: no answer
            logger.debug("asking %s failed: %r", self.wanted.unit_id, error)
        self._pace.note_timeout()
        self.state = TransferState.WAITING
        self.problem = coded(
            "recording-no-answer",
            "{unit} does not answer; it goes on when it does",
            unit=self.wanted.unit_id,
        )
        return None

    def _write_hash(self, path: str, digest: str) -> None:
        """Among those of other files."""
        hashes = self.folder / HASHES
        text = hashes.read_bytes().decode("utf-8", "replace") if hashes.exists() else ""
        lines = (line.partition("  ") for line in text.splitlines())
        known = {name: known for known, _, name in lines} | {path: digest}
        text = "".join(f"{one}  {name}\n" for name, one in sorted(known.items()))
        making = hashes.with_name(HASHES + _PART)
        with write_own(making) as file:
            file.write(text.encode())
        making.replace(hashes)


def _size(path: Path) -> int:
    """Size of a file; 0 where there is none."""
    return path.stat().st_size if path.exists() else 0


def _nothing_kept(unit_id: str, first_ns: int) -> str:
    """``first_ns``: start of what the unit keeps, station time; 0: it keeps nothing."""
    if not first_ns:
        return coded(
            "recording-none",
            "{unit} has no recording of that time: it keeps none; choose another window",
            unit=unit_id,
        )
    began = datetime.fromtimestamp(first_ns / NS_PER_S, UTC)
    return coded(
        "recording-none-then",
        "{unit} has no recording of that time: what it keeps begins at {began_utc_s}; choose "
        "another window",
        unit=unit_id,
        began_utc_s=Measure(first_ns / NS_PER_S, f"{began:%Y-%m-%dT%H:%M:%SZ}"),
    )


def _is_safe(name: str) -> bool:
    """True if the file's name keeps it in the unit's folder."""
    return re.fullmatch(r"[\w-][\w.-]*/[\w-][\w.-]*", name) is not None


def _is_intact(piece: RecordingPiece) -> bool:
    return hashlib.sha256(piece.data).digest() == piece.sha256


def _digest_of(path: Path) -> bytes:
    with read_own(path) as file:
        return hashlib.file_digest(file, "sha256").digest()


def ask_via_bus(bus: Bus) -> Ask:
    """Return a function that queries over the bus, behind live data."""

    def ask(unit_id: str, question: str) -> bytes | None:
        selector = f"{ROOT}/{unit_id}/recording/{question}"
        return next(iter(bus.query(selector, b"", _TIMEOUT_S)), None)

    return ask
