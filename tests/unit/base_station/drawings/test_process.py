"""Drawings are read in a process of their own, which may end as it likes."""

from __future__ import annotations

import io
import sys

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
