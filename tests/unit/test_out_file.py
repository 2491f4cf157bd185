"""Where a command cannot write its file it says so before the work."""

from __future__ import annotations

import errno

import pytest
from typer.testing import CliRunner

from edge.cli import app
from shared.errors import ConfigError, UserError
from shared.out_file import writable, write_secret


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


def test_a_secret_is_its_owners_alone_and_nothing_is_written_over(tmp_path):
    path = tmp_path / "FF-01.enrolment.toml"
    write_secret(path, "key", "renew")
    assert path.read_text() == "key"
    assert path.stat().st_mode & 0o777 == 0o600
    with pytest.raises(ConfigError, match="there already"):
        write_secret(path, "other", "renew")
    assert path.read_text() == "key"


def test_of_a_secret_for_which_there_is_no_room_nothing_is_left(tmp_path, monkeypatch):
    def full(_descriptor):
        raise OSError(errno.ENOSPC, "No space left on device")

    path = tmp_path / "FF-01.enrolment.toml"
    monkeypatch.setattr("shared.out_file.os.fsync", full)
    with pytest.raises(
        ConfigError, match=r"No space left.*make it again: `muster pki renew FF-01`"
    ):
        write_secret(path, "key", "`muster pki renew FF-01`")
    assert not path.exists()
