"""``muster base`` as it runs: real process, bus, folder and signals."""

from __future__ import annotations

import json
import shutil
import socket
import ssl
import time
from collections.abc import Callable, Iterator
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import httpx
import pytest
from websockets.sync.client import ClientConnection, connect

from base_station.pki.certificates import issue, make_authority
from shared.channels import ROOT, Qos
from shared.enrolment import Holder
from shared.mcap_log import SegmentReader, segment_paths
from shared.messages import EventKind, Position, Status, UnitEvent
from shared.messages.status import Activity
from tests.station_command import Browser, Command, Unit, free_port
from tests.waiting import until

MakePosition = Callable[..., Position]


@pytest.fixture
def data(tmp_path: Path) -> Path:
    return tmp_path / "station"


@pytest.fixture
def port() -> int:
    return free_port()


@pytest.fixture
def serve(tmp_path: Path, data: Path, port: int) -> Iterator[Callable[..., Command]]:
    started: list[Command] = []

    def start(*flags: str) -> Command:
        started.append(
            Command(
                tmp_path / f"output-{len(started)}.txt",
                *("serve", "--data", str(data), "--listen", f"tcp/127.0.0.1:{port}"),
                *("--http", "127.0.0.1:0", *flags),
            )
        )
        return started[-1]

    yield start
    for command in started:
        command.kill()


@pytest.fixture
def unit(port: int) -> Iterator[Unit]:
    unit = Unit(port, "FF-01")
    yield unit
    unit.close()


def greet(browser: Browser, unit: Unit, make_position: MakePosition) -> None:
    """Until the unit is linked, what it says is lost."""

    def is_heard() -> bool:
        unit.say(make_position(header=unit.stamper.header()))
        return bool(browser.call("GET", "/health")["messages"])

    until(is_heard, "the unit is heard")


def walk(unit: Unit, make_position: MakePosition, from_m: int, to_m: int) -> None:
    for north_m in range(from_m, to_m):
        unit.say(make_position(header=unit.stamper.header(), north_m=float(north_m)))
        time.sleep(0.1)


def prepare(browser: Browser) -> str:
    """Ada wears FF-01 in an open incident; its id."""
    browser.call("POST", "/units", json={"unit_id": "FF-01", "label": "one"})
    person = browser.call("POST", "/people", json={"name": "Ada", "crew": "A"})
    worn = {"unit_id": "FF-01", "person_id": person["person_id"]}
    browser.call("POST", "/assignments", json=worn)
    return str(browser.call("POST", "/incidents", json={"name": "Kitchen"})["incident_id"])


def watch(browser: Browser, path: str = "/live") -> ClientConnection:
    address = browser.address.replace("http", "ws", 1)
    return connect(f"{address}/api/v1{path}", additional_headers={"Cookie": browser.cookie()})


def snapshot(browser: Browser, path: str = "/live") -> dict[str, Any]:
    with watch(browser, path) as socket_:
        message: dict[str, Any] = json.loads(socket_.recv(10.0))
        assert message["type"] == "snapshot"
        return message


def test_after_a_kill_the_live_state_comes_back_from_the_log(
    serve: Callable[..., Command], data: Path, unit: Unit, make_position: MakePosition
) -> None:
    station = serve()
    with Browser(station.wait_ready(), data) as browser:
        prepare(browser)
        greet(browser, unit, make_position)
        walk(unit, make_position, 0, 20)
        unit.say(Status(unit.stamper.header(), Activity.LYING, 3.0, 0.5, True, 7, 0.0, 0, 0, 0))
        unit.say(UnitEvent(unit.stamper.header(), EventKind.MAYDAY))
        until(lambda: snapshot(browser)["alarms"], "mayday is raised")
        (alarm,) = snapshot(browser)["alarms"]
        browser.call("POST", f"/alarms/{alarm['alarm_id']}/acknowledge")
        before = snapshot(browser)
    station.kill()  # at once: what was acknowledged is on the disk

    again = serve()
    with Browser(again.wait_ready(), data) as browser:
        after = snapshot(browser)
        for part in ("incident", "trails", "plan", "anchor"):
            assert after[part] == before[part]
        (alarm,) = after["alarms"]
        assert (alarm["state"], alarm["by"]) == ("acknowledged", "admin")
        (card,), (card_before,) = after["units"], before["units"]
        for part in ("label", "registered", "person", "status", "last_heard_ms", "alarms"):
            assert card[part] == card_before[part]
        assert card["position"]["north_m"] == pytest.approx(19.0, abs=2.0)
        assert any(segment["note"] for segment in browser.call("GET", "/health")["segments"])
        (stored,) = browser.call("GET", "/alarms")
        assert stored["state"] == "acknowledged"
    assert again.stop() == 0


def test_a_station_that_is_asked_to_stop_leaves_everything_in_order(
    serve: Callable[..., Command], data: Path, unit: Unit, make_position: MakePosition
) -> None:
    station = serve()
    with Browser(station.wait_ready(), data) as browser:
        prepare(browser)
        greet(browser, unit, make_position)
        walk(unit, make_position, 0, 10)
        with watch(browser):  # a console that stays connected holds nothing up
            assert station.stop() == 0
    for path in segment_paths(data / "log"):
        with SegmentReader(path) as reader:
            assert reader.is_complete
    assert (data / "first-login.txt").stat().st_mode & 0o077 == 0
    assert (data / "station.sqlite").stat().st_mode & 0o077 == 0


def test_a_second_station_is_refused(
    serve: Callable[..., Command], tmp_path: Path, data: Path
) -> None:
    serve().wait_ready()
    with Command(
        tmp_path / "second.txt",
        *("serve", "--data", str(data), "--http", "127.0.0.1:0"),
        *("--listen", f"tcp/127.0.0.1:{free_port()}"),
    ) as second:
        assert second.wait() == 2
        assert "another station" in second.said()
        assert "Traceback" not in second.said()


@pytest.mark.parametrize("taken", ["http", "bus"])
def test_a_port_in_use_is_named(tmp_path: Path, taken: str) -> None:
    with socket.create_server(("127.0.0.1", 0)) as holder:
        port = holder.getsockname()[1]
        http, bus = (port, free_port()) if taken == "http" else (free_port(), port)
        with Command(
            tmp_path / "output.txt",
            *("serve", "--data", str(tmp_path / "data"), "--http", f"127.0.0.1:{http}"),
            *("--listen", f"tcp/127.0.0.1:{bus}"),
        ) as station:
            assert station.wait() == 2
            assert str(port) in station.said()
            assert "Traceback" not in station.said()


def test_plain_connections_from_elsewhere_must_be_asked_for(tmp_path: Path) -> None:
    with Command(
        tmp_path / "output.txt",
        *("serve", "--data", str(tmp_path / "data"), "--listen", "tcp/0.0.0.0:0"),
    ) as station:
        assert station.wait() == 2
        assert "--insecure" in station.said()


def test_what_cannot_be_read_is_counted_and_kept(
    serve: Callable[..., Command], data: Path, unit: Unit, make_position: MakePosition
) -> None:
    station = serve()
    with Browser(station.wait_ready(), data) as browser:
        greet(browser, unit, make_position)
        for key in ("FF-01/up/position", "FF-01/up/nonsense", "FF-02/up/status"):
            unit.bus.publish(f"{ROOT}/{key}", b"\xff\xff\xff", Qos.LIVE)
        until(lambda: browser.call("GET", "/health")["undecodable"] == 3, "they are counted")
        health = browser.call("GET", "/health")
        assert any("could not be read" in problem for problem in health["problems"])
        assert health["unknown_units"] == 1
        (shown,) = browser.call("GET", "/units")
        assert not shown["registered"]
    assert station.stop() == 0
    kept = []
    for path in segment_paths(data / "log"):
        with SegmentReader(path) as reader:
            kept += [payload for _, _, payload in reader.records() if payload == b"\xff\xff\xff"]
    assert len(kept) == 3


def play_incident(
    browser: Browser, unit: Unit, make_position: MakePosition
) -> tuple[str, list[dict[str, Any]]]:
    """A short incident with a mayday, from beginning to end: its id and its alarms."""
    incident_id = prepare(browser)
    greet(browser, unit, make_position)
    walk(unit, make_position, 0, 15)
    unit.say(UnitEvent(unit.stamper.header(), EventKind.MAYDAY))
    until(lambda: browser.call("GET", "/alarms"), "mayday is raised")
    walk(unit, make_position, 15, 25)
    browser.call("POST", f"/incidents/{incident_id}/close")
    alarms: list[dict[str, Any]] = browser.call("GET", f"/incidents/{incident_id}/alarms")
    return incident_id, alarms


def test_a_past_incident_is_replayed_in_the_console(
    serve: Callable[..., Command], data: Path, unit: Unit, make_position: MakePosition
) -> None:
    station = serve()
    with Browser(station.wait_ready(), data) as browser:
        incident_id, alarms = play_incident(browser, unit, make_position)
        replay = browser.call("POST", "/replays", json={"incident_id": incident_id})
        path = f"/replays/{replay['replay_id']}"
        with watch(browser, f"{path}/live") as console:
            first = json.loads(console.recv(10.0))
            assert first["replay"]["incident_id"] == incident_id
            browser.call("POST", path, json={"playing": False, "at_ms": replay["end_ms"]})
            shown = _wait_for(console, lambda one: bool(one.get("alarms")))
            assert [one["alarm_id"] for one in shown["alarms"]] == [
                one["alarm_id"] for one in alarms
            ]
            assert not browser.call("GET", path)["playing"]
            for _ in range(2):  # paused, and still speaking
                console.recv(5.0)
            browser.call("POST", path, json={"at_ms": replay["start_ms"], "speed": 10.0})
            shown = _wait_for(console, lambda one: one["type"] == "snapshot")
            assert shown["alarms"] == []
        assert snapshot(browser)["replay"] is None
        browser.call("DELETE", path)
        assert browser.status("GET", path) == 404
    assert station.stop() == 0


def _wait_for(
    console: ClientConnection, condition: Callable[[dict[str, Any]], bool]
) -> dict[str, Any]:
    end_s = time.monotonic() + 30.0
    while time.monotonic() < end_s:
        message: dict[str, Any] = json.loads(console.recv(10.0))
        if condition(message):
            return message
    raise AssertionError("it was never shown")


def test_a_replay_station_runs_beside_the_live_one_and_from_a_copy(
    serve: Callable[..., Command],
    tmp_path: Path,
    data: Path,
    unit: Unit,
    make_position: MakePosition,
) -> None:
    station = serve()
    with Browser(station.wait_ready(), data) as browser:
        incident_id, alarms = play_incident(browser, unit, make_position)
        before = sorted(path.name for path in data.rglob("*"))
        flags = ("--http", "127.0.0.1:0", "--speed", "20")
        with Command(
            tmp_path / "replay.txt", "replay", incident_id, "--data", str(data), *flags
        ) as replaying:
            with Browser(replaying.wait_ready(), data) as onlooker, watch(onlooker) as console:
                shown = _wait_for(console, lambda one: bool(one.get("alarms")))
                assert shown["replay"]["speed"] == 20.0
                assert shown["alarms"][0]["alarm_id"] == alarms[0]["alarm_id"]
                assert [one["incident_id"] for one in onlooker.call("GET", "/replays")]
                refused = onlooker.status("POST", "/incidents", json={"name": "x"})
                assert refused == 409
            assert replaying.stop() == 0
        assert sorted(path.name for path in data.rglob("*")) == before
        browser.call("GET", "/health")
    assert station.stop() == 0

    copy = tmp_path / "copy"
    shutil.copytree(data / "log", copy / "log")
    with Command(
        tmp_path / "copied.txt", "replay", incident_id, "--data", str(copy), *flags
    ) as replaying:
        replaying.wait_ready()
        assert "first login" in replaying.said()
        assert replaying.stop() == 0
    assert [path.name for path in copy.iterdir()] == ["log"]
    with Command(
        tmp_path / "none.txt", "replay", "no-such", "--data", str(copy), *flags
    ) as replaying:
        assert replaying.wait() == 2
        assert incident_id in replaying.said()


def test_rebuilding_gives_the_same_tables(
    serve: Callable[..., Command],
    tmp_path: Path,
    data: Path,
    unit: Unit,
    make_position: MakePosition,
) -> None:
    station = serve()
    with Browser(station.wait_ready(), data) as browser:
        incident_id, _ = play_incident(browser, unit, make_position)
        paths = (
            *("/incidents", "/alarms", "/units", "/assignments", "/people"),
            f"/incidents/{incident_id}/tracks",
        )
        before = [browser.call("GET", path) for path in paths]
    assert station.stop() == 0
    with Command(tmp_path / "rebuild.txt", "rebuild", "--data", str(data)) as rebuilding:
        assert rebuilding.wait() == 0
        assert "log records projected" in rebuilding.said()
    again = serve()
    with Browser(again.wait_ready(), data) as browser:
        after = [browser.call("GET", path) for path in paths]
    assert after == before
    assert again.stop() == 0


def test_users_are_added_while_the_station_runs(
    serve: Callable[..., Command], tmp_path: Path, data: Path
) -> None:
    station = serve()
    address = station.wait_ready()
    flags = ("users", "add", "mia", "--role", "viewer", "--data", str(data))
    with Command(tmp_path / "add.txt", *flags, stdin="a long password\n") as adding:
        assert adding.wait() == 0, adding.said()
    with Command(tmp_path / "again.txt", *flags, stdin="a long password\n") as adding:
        assert adding.wait() == 2
        assert "already" in adding.said()
    elsewhere = ("users", "list", "--data", str(tmp_path / "typo"))
    with Command(tmp_path / "typo.txt", *elsewhere) as listing:
        assert listing.wait() == 2
    assert not (tmp_path / "typo").exists()
    with Browser(address, data) as browser:
        credentials = {"username": "mia", "password": "a long password"}
        assert browser.call("POST", "/login", json=credentials)["role"] == "viewer"
    assert station.stop() == 0


def test_over_tls_the_cookie_never_leaves_it(
    serve: Callable[..., Command], tmp_path: Path, data: Path
) -> None:
    now, day = datetime.now(UTC), timedelta(days=1)
    authority = make_authority("Test", now, 2 * day)
    issued = issue(authority, "station", Holder.STATION, now, day, ("127.0.0.1",))
    certificate, key = tmp_path / "station.pem", tmp_path / "station.key"
    certificate.write_bytes(issued.certificate_pem())
    key.write_bytes(issued.key_pem())
    settings = tmp_path / "station.toml"
    settings.write_text('[http]\ncertificate = "station.pem"\nprivate_key = "station.key"\n')
    station = serve("--config", str(settings))
    address = station.wait_ready()
    assert address.startswith("https://")
    trusting = ssl.create_default_context(cadata=authority.certificate_pem().decode())
    with httpx.Client(base_url=address, verify=trusting) as client:
        credentials = {"username": "nobody", "password": "x"}
        refused = client.post("/api/v1/login", json=credentials)
        assert "max-age" in refused.headers["strict-transport-security"]
        note = (data / "first-login.txt").read_text()
        login = dict(line.split(": ", 1) for line in note.splitlines())
        cookie = client.post("/api/v1/login", json=login).headers["set-cookie"].lower()
    assert "secure" in cookie.split("; ")
    assert station.stop() == 0

    certificate.write_text("no certificate")
    broken = serve("--config", str(settings))
    assert broken.wait() == 2
    assert "cannot be used" in broken.said()
