"""Certificate, calibration and disk of a unit, before its wearer goes in."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from contextlib import closing
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest

from base_station.security.pki.folder import PkiFolder
from edge.calibration.model import Calibration
from edge.config import StorageConfig
from edge.preflight.finding import Severity
from edge.preflight.installation import calibration_finding, certificate_finding, storage_findings
from edge.storage.data_folder import UnitDataFolder
from shared.tls import TlsIdentity

NOW = datetime.now(UTC)
SMALL = StorageConfig(journal_mb=1.0, black_box_mb=1.0)


@pytest.fixture(scope="module")
def identity(tmp_path_factory: pytest.TempPathFactory) -> TlsIdentity:
    pki = PkiFolder(tmp_path_factory.mktemp("pki"))
    pki.create("Test", hosts=[], connect=["tls/127.0.0.1:1"])
    return pki.enroll("u1").identity


@pytest.fixture
def folder(tmp_path: Path) -> Iterator[UnitDataFolder]:
    with closing(UnitDataFolder(tmp_path / "u1")) as folder:
        yield folder


@pytest.mark.parametrize(
    ("days", "level"),
    [(-400, Severity.FAILED), (1, Severity.OK), (4000, Severity.FAILED)],
)
def test_a_certificate_is_valid_now_or_has_failed(
    identity: TlsIdentity, days: int, level: Severity
) -> None:
    assert certificate_finding(identity, NOW + timedelta(days=days)).level is level


def test_a_certificate_that_ends_soon_and_none_at_all_are_warnings(identity: TlsIdentity) -> None:
    ends = certificate_finding(identity, NOW + timedelta(days=1)).text.removeprefix("valid to ")
    soon = datetime.fromisoformat(ends).replace(tzinfo=UTC) - timedelta(days=20)
    assert certificate_finding(identity, soon).level is Severity.WARNING
    assert certificate_finding(None, NOW).level is Severity.WARNING


def test_a_calibration_is_there_and_new_enough() -> None:
    made = Calibration("u1", "sensor", NOW)
    assert calibration_finding(None, NOW).level is Severity.WARNING
    assert calibration_finding(made, NOW).level is Severity.OK
    assert calibration_finding(made, NOW + timedelta(days=400)).level is Severity.WARNING


@pytest.mark.parametrize(
    ("free_mb", "limits", "level"),
    [
        (10, SMALL, Severity.FAILED),
        (500, SMALL, Severity.OK),
        (500, StorageConfig(), Severity.WARNING),
        (5000, StorageConfig(), Severity.OK),
    ],
)
def test_there_is_room_for_what_may_be_stored(
    folder: UnitDataFolder,
    monkeypatch: pytest.MonkeyPatch,
    free_mb: int,
    limits: StorageConfig,
    level: Severity,
) -> None:
    usage = shutil.disk_usage(folder.path)._replace(free=free_mb * 1_000_000)
    monkeypatch.setattr(shutil, "disk_usage", lambda _: usage)
    (finding,) = storage_findings(folder, limits)
    assert finding.level is level


def test_another_units_journal_is_named(tmp_path: Path) -> None:
    UnitDataFolder(tmp_path / "u1").close()
    shutil.copytree(tmp_path / "u1", tmp_path / "u2")
    with closing(UnitDataFolder(tmp_path / "u2")) as folder:
        levels = {one.subject: one.level for one in storage_findings(folder, SMALL)}
    assert levels["data folder"] is Severity.WARNING
