"""Enrolled units are registered automatically, each once, revoked ones never."""

from __future__ import annotations

from concurrent.futures import Future

import pytest

from base_station.engine.ports import ActionResult
from base_station.security.pki.enrolled_units import EnrolledUnits
from base_station.security.pki.folder import PkiFolder
from base_station.storage.db.records import Records
from base_station.storage.db.store import Store
from base_station.storage.db.window import EVER
from shared.clock import ManualClock
from shared.enrolment import Holder
from shared.messages.station import Action, RegisterUnit


class Gate:
    def __init__(self):
        self.registered: list[str] = []

    def submit(self, by: str, action: Action, action_id: str = "") -> Future[ActionResult]:
        assert isinstance(action, RegisterUnit)
        self.registered.append(action.unit_id)
        return Future()


@pytest.fixture
def pki(tmp_path):
    folder = PkiFolder(tmp_path)
    folder.create("Test", hosts=["127.0.0.1"], connect=["tls/127.0.0.1:7447"])
    return folder


@pytest.fixture
def records(tmp_path):
    with Store(tmp_path / "station.sqlite") as store:
        yield Records(store, ManualClock())


def test_each_enrolled_unit_is_registered_once(pki, records):
    gate = Gate()
    units = EnrolledUnits(pki, gate, lambda: ["FF-02"], records)
    pki.enroll("FF-01")
    pki.enroll("FF-02")
    units.update()
    units.update()
    assert gate.registered == ["FF-01"]
    pki.enroll("FF-03")
    units.update()
    assert gate.registered == ["FF-01", "FF-03"]


def test_revoked_unit_is_not_registered(pki, records):
    pki.enroll("FF-01")
    pki.revoke("FF-01")
    gate = Gate()
    EnrolledUnits(pki, gate, list, records).update()
    assert gate.registered == []


def test_damaged_registry_is_read_again_later(pki, records):
    pki.enroll("FF-01")
    written = pki.registry_path.read_bytes()
    pki.registry_path.write_bytes(b"rubbish")
    gate = Gate()
    units = EnrolledUnits(pki, gate, list, records)
    units.update()
    pki.registry_path.write_bytes(written)
    units.update()
    assert gate.registered == ["FF-01"]


def test_station_without_an_authority_registers_no_member(tmp_path, records, caplog):
    gate = Gate()
    EnrolledUnits(PkiFolder(tmp_path), gate, list, records).update()
    assert gate.registered == []
    assert caplog.text == ""  # over plain TCP that is no error
    assert records.audit_entries(EVER) == []


def test_audit_entry_is_written_once(pki, records, monkeypatch, caplog):
    written = []
    monkeypatch.setattr(records, "audit_once", lambda _by, done: written.append(len(done)))
    units = EnrolledUnits(pki, Gate(), list, records)
    for _ in range(3):
        units.update()
    pki.enroll("FF-01")
    for _ in range(3):
        units.update()
    assert written == [1, 1]
    assert caplog.text == ""


def test_issue_and_revocation_are_in_the_audit_once(pki, records):
    def audited() -> list[tuple[str, str]]:
        """Audit entries, oldest first."""
        entries = reversed(records.audit_entries(EVER))
        return [(one.action, " ".join(one.detail.split()[:4]).rstrip(",")) for one in entries]

    units = EnrolledUnits(pki, Gate(), list, records)
    units.update()
    pki.enroll("FF-01")
    pki.enroll("chief", Holder.OPERATOR)
    units.update()
    pki.revoke("chief", Holder.OPERATOR)
    pki.revoke("FF-01")
    pki.enroll("FF-01")
    pki.renew("FF-01")
    for _ in range(2):
        units.update()
        units = EnrolledUnits(pki, Gate(), list, records)  # the station restarts
    assert audited()[:3] == [
        ("IssuedCertificate", "station station as station"),
        ("IssuedCertificate", "unit FF-01 as FF-01"),
        ("IssuedCertificate", "operator chief as operator:chief"),
    ]
    assert sorted(audited()[3:]) == [
        ("IssuedCertificate", "unit FF-01 as FF-01#2"),
        ("IssuedCertificate", "unit FF-01 as FF-01#2"),
        ("RevokedCertificate", "operator chief as operator:chief"),
        ("RevokedCertificate", "unit FF-01 as FF-01"),
    ]
    assert {one.by for one in records.audit_entries(EVER)} == {"muster pki"}


def test_renewal_before_the_station_read_it_is_in_the_audit_too(pki, records):
    for issue in (pki.enroll, pki.renew, pki.renew):
        issue("FF-01")
    EnrolledUnits(pki, Gate(), list, records).update()
    pki.renew("FF-01")
    EnrolledUnits(pki, Gate(), list, records).update()
    reported = [e.detail for e in records.audit_entries(EVER) if "FF-01" in e.detail]
    assert len(reported) == 4
    assert sum("renewed since" in detail for detail in reported) == 2
