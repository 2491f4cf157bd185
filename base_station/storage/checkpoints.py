"""Checkpoints: the pipeline's state in files, so that neither a restart nor a seek in a replay has
to apply the whole log.  They are a cache: a torn or missing file, or one of another version of the
program, only costs time.  The structure of the parts of the state is unknown here, so any other
program text counts as another version.
"""

from __future__ import annotations

import zlib
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from threading import Lock

import msgspec
import zstandard

import base_station
import shared
from base_station.core.checkpoint import Checkpoint, read_checkpoint
from shared.clock import NS_PER_S
from shared.own_files import make_folder, write_own

SUFFIX = ".checkpoint"
_PART = "saving.part"
_NOT_OURS = frozenset({"node_modules", "__pycache__"})  # in a checkout; npm may be replacing them
KEPT_CLOSE = 3  # the newest ones; older ones are kept SPARSE_NS apart
KEPT_FAR = 500
KEPT_BYTES = 2_000_000_000
SPARSE_NS = 180 * NS_PER_S  # that a seek steps at most, where a replay decides again
_LEVEL = 3  # of Zstandard


class SavedState(msgspec.Struct, frozen=True):
    """A checkpoint and its place in the log."""

    t_ns: int  # station time of the last event stepped
    events_at_t: int  # how many events of that very time were stepped
    pipeline: Checkpoint


class _File(msgspec.Struct, frozen=True, array_like=True):
    t_ns: int
    events_at_t: int
    crc32: int
    pipeline: bytes  # packed with zstd; the checksum is of that
    program: int = 0  # checksum of the program's text


class Checkpoints:
    """A folder of checkpoints, named by their times; from any thread."""

    def __init__(self, folder: Path, report: Callable[[str], None] = lambda _: None) -> None:
        """``report`` receives a sentence when ``save_if_it_can`` cannot save."""
        self._folder = folder
        self._report = report
        self._changing = Lock()
        self._program = program_checksum()
        self._useless: set[Path] = set()  # torn, or of another version of the program
        self.is_refused = False  # the disk is full: save only what is needed
        make_folder(folder)

    def save(self, t_ns: int, events_at_t: int, pipeline: bytes) -> None:
        """Raises OSError where the disk does not take it; then nothing is left of it."""
        # An hour of a hundred units is 27 MB as it is.
        packed = zstandard.ZstdCompressor(_LEVEL).compress(pipeline)
        file = _File(t_ns, events_at_t, zlib.crc32(packed), packed, self._program)
        content = msgspec.msgpack.encode(file)
        path = self._folder / f"{t_ns:020d}{SUFFIX}"
        part = self._folder / _PART  # a kill leaves one at most
        with self._changing:
            try:
                with write_own(part) as written:
                    written.write(content)
                part.replace(path)
            except OSError:
                part.unlink(missing_ok=True)
                raise
            self._useless.discard(path)
            self._thin_out()

    def save_if_it_can(self, t_ns: int, events_at_t: int, pipeline: bytes) -> None:
        """Save; where the disk does not take it, report that and set ``is_refused``."""
        try:
            self.save(t_ns, events_at_t, pipeline)
        except OSError as error:
            self.is_refused = True
            self._report(f"to go back in the past takes long: no state can be saved ({error})")

    def clear(self) -> None:
        """Remove all of them: a restart steps the whole log."""
        with self._changing:
            for path in self._folder.iterdir():
                if path.suffix == SUFFIX or path.name == _PART:
                    path.unlink(missing_ok=True)

    def latest(self, until_ns: int | None = None, after_ns: int = -1) -> SavedState | None:
        """The newest usable one, at or before ``until_ns`` where that is given, and later than
        ``after_ns``.
        """
        for path in reversed(self._paths()):
            t_ns = int(path.stem)
            if t_ns <= after_ns:
                break
            if (until_ns is None or t_ns <= until_ns) and path not in self._useless:
                saved = _read(path, self._program)
                if saved is not None:
                    return saved
                self._useless.add(path)  # a seek need not read all of them again
        return None

    def has_any(self, after_ns: int, until_ns: int) -> bool:
        """True if one was saved of a time behind ``after_ns``, until ``until_ns``."""
        return any(after_ns < int(path.stem) <= until_ns for path in self._paths())

    def _paths(self) -> list[Path]:
        """By time."""
        return sorted(path for path in self._folder.glob(f"*{SUFFIX}") if path.stem.isdecimal())

    def _thin_out(self) -> None:
        old = self._paths()[:-KEPT_CLOSE]
        while len(old) > KEPT_FAR or sum(path.stat().st_size for path in old) > KEPT_BYTES:
            old.pop(0).unlink(missing_ok=True)
        if len(old) > 1 and int(old[-1].stem) - int(old[-2].stem) < SPARSE_NS:
            old[-1].unlink(missing_ok=True)


@cache  # of what this process has loaded, whatever an update writes meanwhile
def program_checksum() -> int:
    """Checksum over the text of everything that a state may come from.  What copies itself calls
    this when it has loaded the program: copies of later times are of the same text.
    """
    return _checksum_of(*(Path(one.__path__[0]) for one in (base_station, shared)))


def _checksum_of(*packages: Path) -> int:
    total = 0
    for package in packages:
        for path in _modules(package):
            total = zlib.crc32(path.read_bytes(), total)
    return total


def _modules(folder: Path) -> Iterator[Path]:
    for path in sorted(folder.iterdir()):
        if path.suffix == ".py":
            yield path
        elif path.is_dir() and path.name not in _NOT_OURS:
            yield from _modules(path)


def _read(path: Path, program: int) -> SavedState | None:
    try:
        file = msgspec.msgpack.decode(path.read_bytes(), type=_File)
    except (OSError, msgspec.MsgspecError, UnicodeDecodeError):
        return None
    if file.program != program or zlib.crc32(file.pipeline) != file.crc32:
        return None
    checkpoint = read_checkpoint(zstandard.ZstdDecompressor().decompress(file.pipeline))
    return SavedState(file.t_ns, file.events_at_t, checkpoint) if checkpoint else None
