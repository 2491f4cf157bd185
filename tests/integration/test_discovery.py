"""Stations that announce themselves on the loopback, and units that look for theirs.

Others may announce there too, as other tests do at the same time: each has an authority of its own.
"""

from __future__ import annotations

import dataclasses
import errno
import logging
import secrets
from collections.abc import Callable, Iterator
from contextlib import ExitStack, closing
from pathlib import Path

import pytest
import zeroconf

from base_station.app.station_presence import StationPresence
from base_station.config import BusConfig, StationConfig
from base_station.security.pki.folder import PkiFolder
from edge.app.station_finder import StationFinder
from edge.app.zenoh_station import ZenohStation
from edge.identity import UnitConnection
from shared.bus import Bus
from shared.channels import POSITION
from shared.discovery import Announcement, Announcer, ConsoleAnnouncement, find_announcements
from shared.enrolment import Enrolment
from shared.errors import BusError
from shared.tls import fingerprint
from tests.rig.enrolled_site import EnrolledSite
from tests.rig.station_command import Agent, Browser, Command
from tests.rig.station_process import free_port
from tests.rig.waiting import until

LOOPBACK = ("127.0.0.1",)
NOBODY = "tls/127.0.0.1:1"  # where no station is any more

Announce = Callable[..., None]


@pytest.fixture
def stack() -> Iterator[ExitStack]:
    with ExitStack() as stack:
        yield stack


@pytest.fixture
def site(tmp_path: Path, stack: ExitStack, port: int) -> EnrolledSite:
    (tmp_path / "station").mkdir()
    site = EnrolledSite(tmp_path / "station", stack, port)
    site.open()
    return site


@pytest.fixture
def elsewhere(tmp_path: Path) -> PkiFolder:
    """Another authority."""
    folder = PkiFolder(tmp_path / "elsewhere")
    folder.create("Elsewhere", [], [NOBODY])
    return folder


@pytest.fixture
def announce(stack: ExitStack) -> Announce:
    def begin(pki: PkiFolder, port: int, name: str = "station") -> None:
        """With the fingerprint of this authority, whoever it is that announces it."""
        authority = fingerprint(pki.station_identity().authority)
        announcement = Announcement(name, "station", authority, port, LOOPBACK)
        stack.enter_context(closing(Announcer(announcement, LOOPBACK)))

    return begin


def moved(pki: PkiFolder) -> Enrolment:
    """A unit that was enrolled when the station was at another place."""
    return dataclasses.replace(pki.renew("u1"), connect=(NOBODY,))


def finder(enrolment: Enrolment) -> StationFinder:
    return StationFinder(enrolment.identity.authority, LOOPBACK)


def station_of(enrolment: Enrolment) -> ZenohStation:
    member = UnitConnection("u1", enrolment.connect, enrolment.identity, discovers=True)
    return ZenohStation(member, finder(enrolment).find)


def opened(station: ZenohStation, attempts: int = 4) -> Bus:
    """As the link of an agent opens it: again and again."""
    for _ in range(attempts - 1):
        try:
            return station.open_bus()
        except BusError:
            continue
    return station.open_bus()


def test_a_unit_finds_its_station_at_another_place(
    site: EnrolledSite, port: int, announce: Announce
) -> None:
    announce(site.pki, port)
    with closing(opened(station_of(moved(site.pki)))) as bus:
        until(lambda: bus.has_subscriber(POSITION.key("u1")), "the station hears the unit")


def test_a_station_of_another_authority_is_ignored_and_named_once(
    site: EnrolledSite,
    elsewhere: PkiFolder,
    announce: Announce,
    caplog: pytest.LogCaptureFixture,
) -> None:
    announce(elsewhere, free_port(), "stranger")
    search = finder(moved(site.pki))
    authority = fingerprint(elsewhere.station_identity().authority)[:16]
    with caplog.at_level(logging.WARNING, "edge"):
        until(lambda: search.find() == () and authority in caplog.text, "it is heard")
        assert search.find() == ()
    (named,) = [line for line in caplog.messages if authority in line]
    assert named.startswith("station stranger")
    assert "is of another authority" in named


def test_station_with_a_false_announcement_gets_no_link(
    site: EnrolledSite, elsewhere: PkiFolder, tmp_path: Path, stack: ExitStack, announce: Announce
) -> None:
    """The fingerprint is known to everybody on the network; the key is not."""
    liar_port = free_port()
    (tmp_path / "liar").mkdir()
    EnrolledSite(tmp_path / "liar", stack, liar_port).open()
    announce(site.pki, liar_port, "liar")
    enrolment = moved(site.pki)
    until(lambda: len(finder(enrolment).find()) == 1, "it is found")
    station = station_of(enrolment)
    with pytest.raises(BusError):
        opened(station)
    reason = station.link_failure_reason()
    assert f"127.0.0.1 port {liar_port} is not the one that enrolled this unit" in reason


def test_an_announcement_of_another_version_is_no_station(
    site: EnrolledSite, port: int, announce: Announce, monkeypatch: pytest.MonkeyPatch
) -> None:
    with monkeypatch.context() as newer:
        newer.setattr("shared.discovery.VERSION", "2")
        announce(site.pki, port)
    assert finder(moved(site.pki)).find() == ()


def test_two_stations_of_one_name_are_both_found(site: EnrolledSite, announce: Announce) -> None:
    ports = {free_port(), free_port()}
    for port in ports:
        announce(site.pki, port)
    search = finder(moved(site.pki))
    wanted = {f"tls/127.0.0.1:{port}" for port in ports}
    until(lambda: set(search.find()) == wanted, "both are found")


def test_withdrawn_announcement_is_not_found(
    site: EnrolledSite, port: int, stack: ExitStack, announce: Announce
) -> None:
    announce(site.pki, port)
    search = finder(moved(site.pki))
    until(lambda: search.find() != (), "it is found")
    stack.pop_all().close()
    assert search.find() == ()


def test_without_a_network_nothing_is_found(
    site: EnrolledSite, monkeypatch: pytest.MonkeyPatch
) -> None:
    def unreachable(**_: object) -> None:
        raise OSError(errno.ENETUNREACH, "Network is unreachable")

    enrolment = moved(site.pki)
    monkeypatch.setattr("shared.discovery.zeroconf.Zeroconf", unreachable)
    with pytest.raises(BusError, match=r"no station can be looked for.*unreachable"):
        find_announcements(lambda _: True, 1.0)
    with pytest.raises(BusError, match=r"cannot be announced.*unreachable"):
        Announcer(Announcement("station", "station", "", 7447, LOOPBACK))
    assert finder(enrolment).find() == ()


def test_station_announces_the_names_of_its_certificate(
    site: EnrolledSite, port: int, stack: ExitStack
) -> None:
    config = StationConfig(bus=BusConfig((f"tls/127.0.0.1:{port}",), announce=True))
    presence = stack.enter_context(StationPresence(site.pki, config))
    presence.update()
    assert presence.problems() == ()
    search = finder(moved(site.pki))
    until(lambda: search.find() == (f"tls/127.0.0.1:{port}",), "it is found")


def test_running_unit_discovers_a_running_station(tmp_path: Path, port: int) -> None:
    data = tmp_path / "station"
    pki = PkiFolder(data)
    pki.create("Test", [], [NOBODY])
    pki.enroll("u1").write(tmp_path / "u1.toml")
    settings = tmp_path / "station.toml"
    settings.write_text(f'[bus]\nlisten = ["tls/127.0.0.1:{port}"]\nannounce = true\n')
    serving = ("serve", "--config", str(settings), "--data", str(data), "--http", "127.0.0.1:0")
    unit = ("--enrolment", str(tmp_path / "u1.toml"), "--connect", "discover")
    walk = ("--source", "simulated:straight", "--data", str(tmp_path / "units"))
    with (
        Command(tmp_path / "station.txt", *serving) as station,
        Agent(tmp_path / "unit.txt", *unit, *walk, "--tracker", "none") as agent,
        Browser(station.wait_ready(), data) as browser,
    ):
        until(lambda: "linked to the station" in agent.output(), "the unit finds its station")
        until(lambda: browser.call("GET", "/health")["messages"] > 0, "it is heard")
        assert agent.stop() == 0
        assert station.stop() == 0


def test_console_is_found_by_its_name_and_the_name_is_protected(
    stack: ExitStack,
) -> None:
    name = f"muster-{secrets.token_hex(4)}"  # other tests announce here too
    console = ConsoleAnnouncement(name, 8443, True, LOOPBACK)
    stack.enter_context(closing(Announcer(console, LOOPBACK)))
    link = stack.enter_context(closing(zeroconf.Zeroconf(interfaces=list(LOOPBACK))))
    service = f"Muster {name}._https._tcp.local."
    found = link.get_service_info("_https._tcp.local.", service, timeout=10_000)
    assert found is not None
    assert (found.server, found.port) == (f"{name}.local.", 8443)
    assert found.parsed_addresses() == list(LOOPBACK)
    with pytest.raises(BusError, match="another machine"):
        Announcer(dataclasses.replace(console, addresses=("192.0.2.9",)), LOOPBACK)
