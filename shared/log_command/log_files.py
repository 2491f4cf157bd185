"""MCAP files that a path stands for: one file, a folder of them, or a station's data folder."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from shared.errors import UserError
from shared.mcap_log import missing_segments, own_segments

_LOG_FOLDER = "log"  # in the data folder of a station


@dataclass(frozen=True, slots=True)
class LogFileSet:
    """``paths`` in the order of writing; the rest says what a folder lacks or has beside them."""

    paths: list[Path]
    missing_numbers: list[int] = field(default_factory=list)
    foreign: dict[Path, str] = field(default_factory=dict)  # with the reason in words


def log_files(path: Path) -> LogFileSet:
    """Raises UserError where there is nothing that could be a log."""
    if path.is_file():
        return LogFileSet([path])
    if not path.is_dir():
        raise UserError(f"{path}: there is no such file or folder")
    for folder in (path, path / _LOG_FOLDER):
        own, foreign = own_segments(folder)
        if own:
            return LogFileSet(own, missing_segments(own), foreign)
    raise UserError(
        f"{path} has no segments of a log: name a .mcap file, a folder of them, or a station's "
        "data folder"
    )
