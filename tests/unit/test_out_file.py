"""Where a command cannot write its file it says so before the work."""

from __future__ import annotations

import pytest
from typer.testing import CliRunner

from edge.cli import app
from shared.errors import UserError
from shared.out_file import writable


def test_a_place_that_can_be_written_is_left_as_it_is(tmp_path):
    new, kept = tmp_path / "new", tmp_path / "kept"
    kept.write_text("before")
    assert (writable(new), writable(kept), writable(None)) == (new, kept, None)
    assert not new.exists()
    assert kept.read_text() == "before"


@pytest.mark.parametrize("place", ["no/where.toml", "."])
def test_a_place_that_cannot_is_refused(tmp_path, place):
    with pytest.raises(UserError, match="choose another place"):
        writable(tmp_path / place)


def test_nobody_is_guided_through_a_calibration_that_cannot_be_kept(tmp_path):
    out = str(tmp_path / "no" / "cal.toml")
    result = CliRunner().invoke(app, ["calibrate", "--source", "bench:1", "--out", out])
    assert isinstance(result.exception, UserError)
    assert "of 3" not in result.output
