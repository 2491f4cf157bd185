"""Forged announcements cost a unit little, and its log less."""

from __future__ import annotations

import pytest

from base_station.security.pki.folder import PkiFolder
from edge.app import station_finder
from edge.app.station_finder import StationFinder
from shared.discovery import Announcement
from shared.tls import fingerprint


@pytest.fixture(scope="module")
def authority(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    pki = PkiFolder(tmp_path_factory.mktemp("station"))
    pki.create("Test", [], ["tls/192.0.2.7:7447"])
    return pki.station_identity().authority


def receive(monkeypatch: pytest.MonkeyPatch, announcements: list[Announcement]) -> None:
    monkeypatch.setattr(station_finder, "find_announcements", lambda *_: announcements)


def test_only_so_many_places_are_tried(authority: bytes, monkeypatch: pytest.MonkeyPatch) -> None:
    own = fingerprint(authority)
    announcements = [
        Announcement(f"s{number}", "station", own, 7447, (f"192.0.2.{number}", "2001:db8::7"))
        for number in range(50)
    ]
    receive(monkeypatch, announcements)
    found = StationFinder(authority).find()
    assert len(found) == len(set(found)) == 16
    assert found[:2] == ("tls/192.0.2.0:7447", "tls/[2001:db8::7]:7447")


def test_only_so_many_strangers_are_named(
    authority: bytes, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    strangers = [
        Announcement(f"s{number}", "station", f"{number:064x}", 7447, ("192.0.2.1",))
        for number in range(500)
    ]
    receive(monkeypatch, strangers)
    finder = StationFinder(authority)
    assert finder.find() == finder.find() == ()
    assert len(caplog.messages) == 100
