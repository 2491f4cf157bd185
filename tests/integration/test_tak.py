"""A station with TAK: a server over TCP and TLS, and a multicast group."""

from __future__ import annotations

import socket
import struct
from collections.abc import Callable, Iterator
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import pytest

from shared.messages import EventKind, UnitEvent
from tests.rig.cot_events import cot_event
from tests.rig.cot_schema import check_event
from tests.rig.served_station import MakePosition, greet, prepare, snapshot
from tests.rig.station_command import Browser, Command, Unit
from tests.rig.tak_server import TakCertificates, TakClient, TakServer
from tests.rig.waiting import PATIENCE_S, until

ANCHOR = {"lat_deg": 52.5, "lon_deg": 13.4, "height_m": 40.0}
PERSON, ALERT = "county.FF-01", "county.FF-01-9-1-1"


@pytest.fixture
def tak(tmp_path: Path) -> Iterator[TakServer]:
    with TakServer(tmp_path / "tak") as server:
        yield server


def settings(folder: Path, url: str, *more: str) -> str:
    file = folder / "station.toml"
    lines = ["[tak.county]", f'url = "{url}"', 'uid_prefix = "county"', *more]
    file.write_text("\n".join(lines))
    return str(file)


def health(browser: Browser) -> dict[str, Any]:
    (forwarder,) = browser.call("GET", "/health")["forwarders"]
    return dict(forwarder)


def test_people_and_emergencies_reach_a_tak_server(
    serve: Callable[..., Command],
    data: Path,
    unit: Unit,
    make_position: MakePosition,
    tak: TakServer,
    tmp_path: Path,
) -> None:
    station = serve("--config", settings(tmp_path, tak.url))
    with TakClient(tak.port) as client, Browser(station.wait_ready(), data) as browser:
        prepare(browser)
        greet(browser, unit, make_position)
        until(lambda: "no place" in health(browser)["text"], "the console says what is missing")
        assert not [one for one in client.events if one.kind.startswith("a-")]
        browser.call("PUT", "/site/anchor", json=ANCHOR)
        unit.say(make_position(header=unit.header_factory.header(), north_m=7.0))
        event = client.wait_for(lambda one: one.uid == PERSON, "the person is there")
        checked = check_event(event.raw)
        callsign = checked.find("detail/contact")
        assert callsign is not None
        assert callsign.get("callsign") == "Ada"
        assert float(checked[0].get("lat", "")) == pytest.approx(52.5, abs=1e-3)

        unit.say(UnitEvent(unit.header_factory.header(), EventKind.MAYDAY))
        client.wait_for(lambda one: one.uid == ALERT and one.kind == "b-a-o-tbl", "the alert")
        (alarm,) = browser.call("GET", "/alarms")
        seen = {"last_raised_ms": alarm["last_raised_ms"]}
        path = f"/alarms/{alarm['alarm_id']}"
        browser.call("POST", f"{path}/acknowledge", json=seen)
        browser.call("POST", f"{path}/resolve", json={**seen, "note": "found"})
        client.wait_for(lambda one: one.uid == ALERT and one.kind == "b-a-o-can", "its end")
        until(lambda: health(browser)["sent"] > 0, "the console counts")
        assert health(browser)["state"] == "connected"
        metrics = browser._client.get("/metrics").text
        assert 'muster_forwarder_connected{kind="tak",name="county"} 1.0' in metrics
    assert station.stop() == 0


def test_newest_events_are_sent_after_an_outage_of_the_server(
    serve: Callable[..., Command],
    data: Path,
    unit: Unit,
    make_position: MakePosition,
    tak: TakServer,
    tmp_path: Path,
) -> None:
    tak.kill()
    station = serve("--config", settings(tmp_path, tak.url, "alarm_after_s = 5.0"))
    with Browser(station.wait_ready(), data) as browser:
        prepare(browser)
        browser.call("PUT", "/site/anchor", json=ANCHOR)
        greet(browser, unit, make_position)

        def away() -> list[dict[str, Any]]:
            return [
                one
                for one in browser.call("GET", "/alarms")
                if one["rule"] == "station" and "county" in one["text"]
            ]

        until(away, "an alarm tells that it is away")
        unit.say(UnitEvent(unit.header_factory.header(), EventKind.MAYDAY))
        tak.start()
        with TakClient(tak.port) as client:
            until(lambda: client.latest(ALERT), "the emergency of before comes")
            unit.say(make_position(header=unit.header_factory.header()))
            until(lambda: client.latest(PERSON), "the person comes")
        until(lambda: away()[0]["state"] == "resolved", "the alarm is over")


def test_tls_requires_certificates_of_both_ends(
    serve: Callable[..., Command],
    data: Path,
    unit: Unit,
    make_position: MakePosition,
    tmp_path: Path,
) -> None:
    made = TakCertificates(tmp_path)
    with TakServer(tmp_path / "tak", made) as tak, TakClient(tak.port, made) as client:
        flags = [f'certificate = "{made.client}"', f'private_key = "{made.client_key}"']
        file = settings(tmp_path, tak.url, *flags, f'ca = "{made.ca}"')
        station = serve("--config", file)
        with Browser(station.wait_ready(), data) as browser:
            prepare(browser)
            browser.call("PUT", "/site/anchor", json=ANCHOR)
            greet(browser, unit, make_position)
            client.wait_for(lambda one: one.uid == PERSON, "the person is there")
        assert station.stop() == 0
        other = TakCertificates(_folder(tmp_path / "other"))
        again = serve("--config", settings(tmp_path, tak.url, *flags, f'ca = "{other.ca}"'))
        with Browser(again.wait_ready(), data) as browser:
            until(lambda: "cannot be reached" in health(browser)["text"], "another's is refused")
            assert "certificate verify failed" in health(browser)["text"]


def _folder(path: Path) -> Path:
    path.mkdir()
    return path


def test_a_multicast_group_gets_an_event_in_each_datagram(
    serve: Callable[..., Command],
    data: Path,
    unit: Unit,
    make_position: MakePosition,
    port: int,
    tmp_path: Path,
) -> None:
    group = "239.2.3.1"
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as member:
        member.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        member.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEPORT, 1)
        member.bind((group, port))
        joined = struct.pack("4s4s", socket.inet_aton(group), socket.inet_aton("127.0.0.1"))
        member.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, joined)
        member.settimeout(PATIENCE_S)
        file = settings(
            tmp_path, f"udp://{group}:{port}", "plain = true", 'interface = "127.0.0.1"'
        )
        station = serve("--config", file)
        with Browser(station.wait_ready(), data) as browser:
            prepare(browser)
            browser.call("PUT", "/site/anchor", json=ANCHOR)
            greet(browser, unit, make_position)
            assert check_event(member.recv(65_536)).get("uid") == PERSON


def test_an_open_server_elsewhere_is_refused_at_the_start(
    serve: Callable[..., Command], tmp_path: Path
) -> None:
    station = serve("--config", settings(tmp_path, "tcp://192.0.2.1:8087"))
    assert station.wait() != 0
    assert "plain = true" in station.output()


def test_other_teams_are_shown_live_and_in_the_replay(
    serve: Callable[..., Command], data: Path, tak: TakServer, tmp_path: Path
) -> None:
    station = serve("--config", settings(tmp_path, tak.url))
    with TakClient(tak.port) as police, Browser(station.wait_ready(), data) as browser:
        incident_id = prepare(browser)
        browser.call("PUT", "/site/anchor", json=ANCHOR)
        until(lambda: health(browser)["state"] == "connected", "it is connected")

        def shown() -> list[dict[str, Any]]:
            now = datetime.now(UTC)
            stale = now + timedelta(seconds=60)
            times = {"time": now.isoformat(), "stale": stale.isoformat()}
            police.send(cot_event("p1", lat="52.5005", callsign="Police 1", **times))
            police.send(cot_event("p2", lat="91.0", **times))
            return list(snapshot(browser)["external"])

        until(shown, "the police are on the plan")
        (marker,) = shown()
        assert (marker["name"], marker["kind"]) == ("Police 1", "person")
        assert marker["north_m"] == pytest.approx(55.6, abs=1.0)
        until(lambda: health(browser)["refused"] > 0, "what makes no sense is counted")
        after_ms = marker["t_ms"] + 8000  # a replay ends where the log ended when it was opened
        until(lambda: datetime.now(UTC).timestamp() * 1000 > after_ms, "the log has gone on")
        replay = browser.call("POST", "/replays", json={"incident_id": incident_id})
        path = f"/replays/{replay['replay_id']}"
        browser.call("POST", path, json={"at_ms": marker["t_ms"] + 2000, "playing": True})
        until(lambda: snapshot(browser, f"{path}/live")["external"], "and they are in the replay")
    assert station.stop() == 0
