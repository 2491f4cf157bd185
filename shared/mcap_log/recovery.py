"""Ends segments in order that a crash or a loss of power left torn."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from shared.durable_names import sync_folder
from shared.errors import LogError
from shared.mcap_log.folder import segment_number, segment_paths
from shared.mcap_log.foreign_files import identity_in_log
from shared.mcap_log.reading import SegmentReader
from shared.mcap_log.segment_rebuild import RebuiltSegment
from shared.mcap_log.writing import SegmentState

TORN = ".torn"
MAKING = ".recovering"


@dataclass(frozen=True, slots=True)
class Recovery:
    """Result of the recovery of one torn segment."""

    path: Path  # the clean segment
    torn_path: Path  # the original as it was found
    messages: int
    bytes_lost: int  # behind the last intact chunk
    damage: tuple[str, ...]  # in between, in words

    def __str__(self) -> str:
        if self.bytes_lost:
            lost = f", {self.bytes_lost} bytes behind the tear are lost"
        else:
            lost = "" if self.damage else ", whole"
        return "; ".join((f"{self.path.name}: {self.messages} records kept{lost}", *self.damage))


def recover_log(folder: Path) -> list[Recovery]:
    """Make every segment of a log complete; no process may write to it meanwhile.

    A torn file is kept beside its clean segment, with ``.torn`` added to its name.  Torn again
    at any instant, the next recovery goes on.  Raises LogError when the disk refuses; the torn
    segments can be read all the same.
    """
    try:
        for half_made in folder.glob(f"*.mcap{MAKING}"):
            path = half_made.with_name(half_made.name.removesuffix(MAKING))
            torn = _torn_of(path)
            if torn and not path.exists():  # the last recovery ended between its two renamings
                torn[-1].rename(path)
            half_made.unlink()
        return [
            recovery
            for path in segment_paths(folder)
            if (recovery := _recover_segment(path)) is not None
        ]
    except PermissionError as error:
        raise LogError(
            f"the log in {folder} cannot be read or changed ({error.strerror}): run this as the "
            "user to whom it belongs, or give it to the one who runs this"
        ) from error
    except OSError as error:
        raise LogError(
            f"the log in {folder} was not ended in order and cannot be mended "
            f"({error.strerror}): free or mend the disk"
        ) from error


def _recover_segment(path: Path) -> Recovery | None:
    """None when the segment is complete, or its state cannot be determined."""
    with SegmentReader(path) as reader:
        if reader.state is not SegmentState.TORN:
            return None
        clean = RebuiltSegment(path.with_name(path.name + MAKING), identity_in_log(path))
        try:
            for chunk in reader.intact_chunks():
                clean.add(chunk)
            clean.finish()
            clean.file.sync()
        finally:
            clean.file.close()
        torn_path = _free_name(path)
        path.rename(torn_path)
        clean.file.path.rename(path)
        sync_folder(path.parent)
        with SegmentReader(path) as mended:
            messages = mended.info().messages
        return Recovery(path, torn_path, messages, reader.bytes_lost, tuple(reader.damage))


def _torn_of(path: Path) -> list[Path]:
    """The torn originals that are kept of a segment, oldest first."""
    torn = path.parent.glob(f"{path.name}{TORN}*")
    return sorted(filter(segment_number, torn), key=_tear)


def _tear(torn: Path) -> int:
    """Number of a truncated original among those of its segment."""
    return int(torn.name.rpartition(TORN)[2] or 1)


def _free_name(path: Path) -> Path:
    """Path of the torn original; earlier ones of the same segment are kept too."""
    before = _torn_of(path)
    number = 1 + _tear(before[-1]) if before else 1
    return path.with_name(f"{path.name}{TORN}{number if number > 1 else ''}")
