"""Sentences about a file or folder that the operating system refused, with their codes."""

from __future__ import annotations

from pathlib import Path

from shared.coded_text import coded


def reading_fault(path: Path, error: OSError) -> str:
    return coded(
        "file-unreadable", "{path} cannot be read: {error}", path=str(path), error=_reason(error)
    )


def writing_fault(path: Path, error: OSError) -> str:
    return coded(
        "file-unwritable", "{path} cannot be written: {error}", path=str(path), error=_reason(error)
    )


def making_fault(folder: Path, error: OSError) -> str:
    return coded(
        "folder-not-made",
        "{folder} cannot be made: {error}",
        folder=str(folder),
        error=_reason(error),
    )


def removal_fault(path: Path, error: OSError) -> str:
    return coded(
        "file-not-removed",
        "{path} cannot be removed: {error}",
        path=str(path),
        error=_reason(error),
    )


def _reason(error: OSError) -> str:
    return error.strerror or str(error)
