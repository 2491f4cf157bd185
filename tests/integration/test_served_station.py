"""``muster base serve`` as a process: bus, folder and signals."""

from __future__ import annotations

import socket
import ssl
from collections.abc import Callable
from datetime import UTC, datetime, timedelta
from pathlib import Path

import httpx
import pytest

from base_station.api.routes.live import NOT_LOGGED_IN
from base_station.security.pki.certificates import issue, make_authority
from shared.channels import ROOT, Qos
from shared.enrolment import Holder
from shared.mcap_log import SegmentReader, SegmentState, segment_paths
from shared.messages import EventKind, UnitEvent
from shared.messages.status import Activity
from tests.rig import message_factory
from tests.rig.served_station import (
    MakePosition,
    close_code,
    greet,
    prepare,
    snapshot,
    trail,
    walk,
    watch,
)
from tests.rig.station_command import Browser, Command, Unit
from tests.rig.station_process import free_port
from tests.rig.waiting import PATIENCE_S, until


def test_live_state_is_restored_from_the_log_after_a_kill(
    serve: Callable[..., Command], data: Path, unit: Unit, make_position: MakePosition
) -> None:
    station = serve()
    with Browser(station.wait_ready(), data) as browser:
        prepare(browser)
        greet(browser, unit, make_position)
        walk(unit, make_position, 0, 20)
        lying = message_factory.status(
            unit.header_factory.header(), activity=Activity.LYING, battery=0.5, mayday=True
        )
        unit.say(lying)
        unit.say(UnitEvent(unit.header_factory.header(), EventKind.MAYDAY))
        until(lambda: snapshot(browser)["alarms"], "mayday is raised")
        (alarm,) = snapshot(browser)["alarms"]
        seen = {"last_raised_ms": alarm["last_raised_ms"]}
        browser.call("POST", f"/alarms/{alarm['alarm_id']}/acknowledge", json=seen)
        before, trail_before = snapshot(browser), trail(browser)
    station.kill()  # at once: what was acknowledged is on the disk

    again = serve()
    with Browser(again.wait_ready(), data) as browser:
        after = snapshot(browser)
        for part in ("incident", "plan", "anchor"):
            assert after[part] == before[part]
        assert trail(browser) == trail_before
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


def test_stopped_station_closes_its_log(
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
            assert reader.state is SegmentState.CLOSED
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
        assert "another station" in second.output()
        assert "Traceback" not in second.output()


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
            assert str(port) in station.output()
            assert "Traceback" not in station.output()


def test_plain_remote_connections_need_an_option(tmp_path: Path) -> None:
    with Command(
        tmp_path / "output.txt",
        *("serve", "--data", str(tmp_path / "data"), "--listen", "tcp/0.0.0.0:7447"),
    ) as station:
        assert station.wait() == 2
        assert "--insecure" in station.output()


def test_unreadable_message_is_counted_and_kept(
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


def test_users_are_added_while_the_station_runs(
    serve: Callable[..., Command], tmp_path: Path, data: Path
) -> None:
    station = serve()
    address = station.wait_ready()
    flags = ("users", "add", "mia", "--role", "viewer", "--data", str(data))
    with Command(tmp_path / "add.txt", *flags, stdin="a long password\n") as adding:
        assert adding.wait() == 0, adding.output()
    with Command(tmp_path / "again.txt", *flags, stdin="a long password\n") as adding:
        assert adding.wait() == 2
        assert "already" in adding.output()
    elsewhere = ("users", "list", "--data", str(tmp_path / "typo"))
    with Command(tmp_path / "typo.txt", *elsewhere) as listing:
        assert listing.wait() == 2
    assert not (tmp_path / "typo").exists()
    with Browser(address, data) as browser:
        credentials = {"username": "mia", "password": "a long password"}
        assert browser.call("POST", "/login", json=credentials)["role"] == "viewer"
        with watch(browser) as socket_:
            remove = ("users", "remove", "mia", "--data", str(data))
            with Command(tmp_path / "remove.txt", *remove) as removing:
                assert removing.wait() == 0, removing.output()
            assert close_code(socket_) == NOT_LOGGED_IN
    with Browser(address, data) as browser:
        entries = browser.call("GET", "/audit")
    by_command = [
        (one["action"], one["detail"]) for one in entries if one["by"].startswith("muster")
    ]
    assert by_command == [("RemovedUser", "mia"), ("AddedUser", "mia as viewer")]
    assert station.stop() == 0


def test_cookie_over_tls_is_secure_only(
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
    with httpx.Client(base_url=address, verify=trusting, timeout=PATIENCE_S) as client:
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
    assert "cannot be used" in broken.output()
