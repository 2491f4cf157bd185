"""Drawings are read in a process of their own, which may end as it likes."""

from __future__ import annotations

import io
import sys

import msgspec
import pytest
from PIL import Image

from base_station.drawings import process
from base_station.drawings.draft import Options
from shared.errors import UserError

pytestmark = pytest.mark.slow  # starts programs


def test_a_draft_comes_back_and_a_refusal_with_its_reason() -> None:
    written = io.BytesIO()
    Image.new("RGB", (40, 30), "white").save(written, "PNG")
    draft = process.draft_of(written.getvalue(), Options("Übung"))
    assert draft.picture is not None
    assert draft.picture.webp.startswith(b"RIFF")
    with pytest.raises(UserError, match="no drawing that can be read"):
        process.draft_of(b"notes", Options())


@pytest.mark.parametrize(
    ("program", "reason"),
    [("import os; os.abort()", "cannot be read"), ("import time; time.sleep(60)", "too long")],
)
def test_a_process_that_ends_or_hangs_is_a_refusal(
    program: str, reason: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    command = (sys.executable, "-c", program)
    monkeypatch.setattr(process, "command_of", lambda options: command)
    monkeypatch.setattr(process, "MOST_WAIT_S", 3.0)
    with pytest.raises(UserError, match=reason):
        process.draft_of(b"", Options())


def test_a_drawing_that_takes_too_long_to_read_is_refused_with_the_reason(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The kernel signals the limit of the processor before it kills."""
    program = (
        "import base_station.drawings.__main__ as main\n"
        "main.MOST_CPU_S = 2\n"
        "def endless(content, options):\n"
        "    while True: pass\n"
        "main.read_drawing = endless\n"
        "main.main()"
    )
    options = msgspec.json.encode(Options()).decode()
    monkeypatch.setattr(process, "command_of", lambda _: (sys.executable, "-c", program, options))
    with pytest.raises(UserError, match="takes longer than 2 s to be read; send a part"):
        process.draft_of(b"", Options())
