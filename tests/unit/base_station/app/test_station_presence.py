"""Announcement of a station: addresses of its certificate, and no others."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest

from base_station.app.station_presence import StationPresence
from base_station.config import BusConfig, StandbyConfig, StationConfig
from base_station.security.pki.folder import PkiFolder
from shared.discovery import Announcement
from shared.errors import BusError, ConfigError
from shared.tls import fingerprint
from tests.rig.announced import Announced

Presence = Callable[..., StationPresence]


@pytest.fixture
def pki(tmp_path: Path) -> PkiFolder:
    folder = PkiFolder(tmp_path)
    folder.create("Test", ["192.0.2.7", "2001:db8::7"], ["tls/192.0.2.7:7447"])
    return folder


@pytest.fixture
def own() -> list[str]:
    """Addresses of this machine."""
    return ["192.0.2.7", "198.51.100.1", "2001:db8::7", "box"]


@pytest.fixture
def presence(pki: PkiFolder, own: list[str], announced: Announced) -> Iterator[Presence]:
    with ExitStack() as stack:

        def begin(*listen: str, announce: bool = True, name: str = "") -> StationPresence:
            bus = BusConfig(listen or ("tls/0.0.0.0:7447",), announce)
            standby = StandbyConfig(name, ("tls/192.0.2.8:7447",) if name else ())
            config = StationConfig(bus=bus, standby=standby)
            return stack.enter_context(StationPresence(pki, config, lambda: own))

        yield begin


def test_station_is_not_announced_by_default(presence: Presence, announced: Announced) -> None:
    assert not BusConfig().announce
    station = presence(announce=False)
    station.update()
    assert announced.now == []
    assert station.problems() == ()


def test_addresses_of_the_certificate_are_announced(
    presence: Presence, announced: Announced, pki: PkiFolder
) -> None:
    station = presence(name="first")
    station.update()
    station.update()
    ((announcement, interfaces),) = announced.now
    authority = fingerprint(pki.station_identity().authority)
    assert announcement == Announcement(
        "first", "station", authority, 7447, ("192.0.2.7", "2001:db8::7")
    )
    assert announcement.endpoints() == ("tls/192.0.2.7:7447", "tls/[2001:db8::7]:7447")
    assert interfaces == ()
    assert station.problems() == ()


def test_station_of_one_interface_is_announced_on_that_alone(
    presence: Presence, announced: Announced
) -> None:
    presence("tls/192.0.2.7:7447").update()
    ((announcement, interfaces),) = announced.now
    assert announcement.addresses == interfaces == ("192.0.2.7",)


def test_changed_address_and_certificate_are_announced(
    presence: Presence, announced: Announced, pki: PkiFolder, own: list[str]
) -> None:
    station = presence()
    station.update()
    own[:] = ["192.0.2.99"]
    station.update()
    assert announced.now == []
    (problem,) = station.problems()
    assert "do not discover this station at 192.0.2.99" in problem
    assert "muster pki renew-station" in problem
    pki.renew_station(hosts=["192.0.2.99"])
    station.update()
    ((announcement, _),) = announced.now
    assert announcement.addresses == ("192.0.2.99",)
    assert station.problems() == ()


def test_announcement_is_withdrawn_at_the_end(presence: Presence, announced: Announced) -> None:
    with presence() as station:
        station.update()
        assert len(announced.now) == 1
    assert announced.now == []


def test_machine_without_a_network_is_announced_later(
    presence: Presence, announced: Announced
) -> None:
    station = presence()
    announced.fault = BusError("no network")
    station.update()
    assert station.problems() == ("The station is not announced on its network: no network",)
    announced.fault = None
    station.update()
    assert len(announced.now) == 1
    assert station.problems() == ()


def test_bus_without_certificates_is_not_announced() -> None:
    with pytest.raises(ConfigError, match="without certificates is not announced"):
        BusConfig(("tcp/0.0.0.0:7447",), announce=True)
