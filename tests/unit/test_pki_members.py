"""Enrolled units are registered by themselves, each once, revoked ones never."""

from __future__ import annotations

from concurrent.futures import Future

import pytest

from base_station.live.sinks import ActionDone
from base_station.pki.folder import PkiFolder
from base_station.pki.members import EnrolledUnits
from shared.messages.station import Action, RegisterUnit


class Gate:
    def __init__(self):
        self.registered: list[str] = []

    def submit(self, by: str, action: Action) -> Future[ActionDone]:
        assert isinstance(action, RegisterUnit)
        self.registered.append(action.unit_id)
        return Future()


@pytest.fixture
def pki(tmp_path):
    folder = PkiFolder(tmp_path)
    folder.create("Test", hosts=["127.0.0.1"], connect=["tls/127.0.0.1:7447"])
    return folder


def test_each_enrolled_unit_is_registered_once(pki):
    gate = Gate()
    units = EnrolledUnits(pki, gate, lambda: ["FF-02"])
    pki.enroll("FF-01")
    pki.enroll("FF-02")
    units.update()
    units.update()
    assert gate.registered == ["FF-01"]
    pki.enroll("FF-03")
    units.update()
    assert gate.registered == ["FF-01", "FF-03"]


def test_a_revoked_unit_is_not_registered(pki):
    pki.enroll("FF-01")
    pki.revoke("FF-01")
    gate = Gate()
    EnrolledUnits(pki, gate, list).update()
    assert gate.registered == []


def test_a_damaged_registry_is_read_again_later(pki):
    pki.enroll("FF-01")
    written = pki.registry_path.read_bytes()
    pki.registry_path.write_bytes(b"rubbish")
    gate = Gate()
    units = EnrolledUnits(pki, gate, list)
    units.update()
    pki.registry_path.write_bytes(written)
    units.update()
    assert gate.registered == ["FF-01"]


def test_a_station_without_an_authority_registers_nobody(tmp_path):
    gate = Gate()
    EnrolledUnits(PkiFolder(tmp_path), gate, list).update()
    assert gate.registered == []
