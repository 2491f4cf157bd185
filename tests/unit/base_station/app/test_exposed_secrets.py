"""Secrets that others can read are closed to them, and reported."""

from __future__ import annotations

import os
import stat
from pathlib import Path

import pytest

from base_station.app.exposed_secrets import ExposedSecrets
from base_station.security.pki.folder import PkiFolder
from base_station.storage.data_folder import DataFolder
from edge.config import EdgeConfig
from edge.identity import unit_connection
from shared.enrolment import Holder
from shared.secret_files import close_to_others


def mode_of(path: Path) -> int:
    return stat.S_IMODE(path.stat().st_mode)


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> DataFolder:
    folder = DataFolder(tmp_path_factory.mktemp("station"))
    PkiFolder(folder.path).create("Fire", ["10.0.0.1"], ["tls/10.0.0.1:7447"])
    for path in (folder.first_login, folder.database):
        path.write_text("secret")
        path.chmod(0o600)
    return folder


@pytest.mark.parametrize(
    ("name", "remedy"),
    [
        ("pki/authority.key", "make a new authority"),
        ("pki/station.key", "make a new authority"),
        ("first-login.txt", "another password"),
        ("station.sqlite", "every user another password"),
    ],
)
def test_secrets_of_a_station_that_others_could_read_are_closed_and_named(
    made: DataFolder, name: str, remedy: str
) -> None:
    path = made.path / name
    path.chmod(0o644)
    (problem,) = ExposedSecrets(made, None).problems()
    assert str(path) in problem
    assert "0644" in problem
    assert remedy in problem
    assert mode_of(path) == 0o600
    assert not ExposedSecrets(made, None).problems(), "a station that starts again finds nothing"


def test_console_key_stays_readable_by_its_group(made: DataFolder, tmp_path: Path) -> None:
    key = tmp_path / "console.key"
    key.write_text("secret")
    key.chmod(0o644)
    (problem,) = ExposedSecrets(made, key).problems()
    assert str(key) in problem
    assert mode_of(key) == 0o640
    assert not ExposedSecrets(made, key).problems()
    own = made.path / "pki" / "station.key"
    assert not ExposedSecrets(made, own).problems()


def test_secret_that_cannot_be_closed_is_named_and_stops_nothing(
    made: DataFolder, monkeypatch: pytest.MonkeyPatch
) -> None:
    def keeps_no_modes(_descriptor: int, _mode: int) -> None:
        """Change no mode, as the file system of a memory card."""

    key = made.path / "pki" / "station.key"
    key.chmod(0o604)
    with monkeypatch.context() as card:
        card.setattr(os, "fchmod", keeps_no_modes)
        (problem,) = ExposedSecrets(made, None).problems()
    assert "cannot be taken away" in problem
    assert "mode 0600" in problem
    assert close_to_others(key) == 0o604


def test_unit_closes_its_enrolment_and_reports_it(
    made: DataFolder, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    file = tmp_path / "FF-01.enrolment.toml"
    PkiFolder(made.path).enroll("FF-01", Holder.UNIT).write(file)
    config = EdgeConfig(source="simulated", enrolment=file)
    unit_connection(config)
    assert not caplog.text
    file.chmod(0o644)
    unit_connection(config)
    assert mode_of(file) == 0o600
    assert f"{file} could be read or changed by others (mode 0644)" in caplog.text
