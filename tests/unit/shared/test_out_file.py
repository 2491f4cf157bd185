"""A command that cannot write its file reports it before its work."""

from __future__ import annotations

import errno
import os
from contextlib import suppress
from pathlib import Path

import pytest
from typer.testing import CliRunner

from edge.cli import app
from shared.errors import ConfigError, UserError
from shared.out_file import whole, writable, write_secret
from tests.rig.full_disk import files_of_at_most


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


def test_calibration_that_cannot_be_saved_is_refused_at_the_start(tmp_path):
    out = str(tmp_path / "no" / "cal.toml")
    result = CliRunner().invoke(app, ["calibrate", "--source", "bench:1", "--out", out])
    assert isinstance(result.exception, UserError)
    assert "of 3" not in result.output


def test_a_secret_is_its_owners_alone_and_nothing_is_written_over(tmp_path):
    path = tmp_path / "FF-01.enrolment.toml"
    write_secret(path, b"key", "renew")
    assert path.read_text() == "key"
    assert path.stat().st_mode & 0o777 == 0o600
    with pytest.raises(ConfigError, match="there already"):
        write_secret(path, b"other", "renew")
    assert path.read_text() == "key"


def test_secret_without_room_on_the_disk_leaves_no_file(tmp_path, monkeypatch):
    def full(_descriptor):
        raise OSError(errno.ENOSPC, "No space left on device")

    path = tmp_path / "FF-01.enrolment.toml"
    monkeypatch.setattr("shared.out_file.os.fsync", full)
    with pytest.raises(
        ConfigError, match=r"No space left.*make it again: `muster pki renew FF-01`"
    ):
        write_secret(path, b"key", "`muster pki renew FF-01`")
    assert not path.exists()


def test_no_half_of_a_file_is_left_and_what_was_there_stays(tmp_path):
    path = tmp_path / "report.json"
    for text in ("first", "second"):
        with whole(path) as making:
            making.write_text(text)
    with (
        files_of_at_most(1000),
        pytest.raises(UserError, match="choose another place"),
        whole(path) as making,
    ):
        making.write_bytes(bytes(5000))
    assert list(tmp_path.iterdir()) == [path]
    assert path.read_text() == "second"
    with suppress(KeyboardInterrupt), whole(path) as making:
        making.write_text("th")
        raise KeyboardInterrupt
    assert list(tmp_path.iterdir()) == [path]


def test_target_that_is_no_regular_file_is_written_directly():
    with whole(Path(os.devnull)) as making:
        assert making == Path(os.devnull)
