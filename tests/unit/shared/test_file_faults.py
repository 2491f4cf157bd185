"""Sentences about refused files: the reason of the operating system, and codes."""

from __future__ import annotations

import errno
import os
from pathlib import Path

import pytest

from shared.coded_text import code_of_text
from shared.file_faults import making_fault, reading_fault, removal_fault, writing_fault

_PATH = Path("log") / "0001.mcap"
_FULL = OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), str(_PATH))


@pytest.mark.parametrize(
    ("text", "code", "sentence"),
    [
        (reading_fault(_PATH, _FULL), "file-unreadable", "read"),
        (writing_fault(_PATH, _FULL), "file-unwritable", "written"),
        (making_fault(_PATH, _FULL), "folder-not-made", "made"),
        (removal_fault(_PATH, _FULL), "file-not-removed", "removed"),
    ],
)
def test_sentence_names_path_and_reason(text: str, code: str, sentence: str) -> None:
    assert text == f"log/0001.mcap cannot be {sentence}: No space left on device"
    assert code_of_text(text).code == code


def test_error_without_a_number_gives_its_own_text() -> None:
    assert reading_fault(_PATH, OSError("torn")) == "log/0001.mcap cannot be read: torn"
