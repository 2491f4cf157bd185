"""A past incident: replayed in the console, by a station of its own, and projected again."""

from __future__ import annotations

import json
import re
import shutil
import time
from collections.abc import Callable
from contextlib import closing, suppress
from pathlib import Path
from typing import Any

import jsonschema_rs
import psutil
from typer.testing import CliRunner
from websockets.sync.client import ClientConnection

from base_station.accounts.principals import Role
from base_station.cli import app
from base_station.storage.db.accounts import Accounts
from base_station.storage.db.store import Store
from shared.clock import NS_PER_MS, SystemClock
from shared.mcap_log import SegmentWriter
from shared.messages import EventKind, UnitEvent
from shared.messages.station import OpenIncident
from tests.rig.live_page import LIVE_SCHEMA
from tests.rig.served_station import (
    MakePosition,
    greet,
    prepare,
    snapshot,
    walk,
    watch,
)
from tests.rig.station_command import Browser, Command, Unit
from tests.rig.station_script import START_NS, Script
from tests.rig.waiting import PATIENCE_S, until


def play_incident(
    browser: Browser, unit: Unit, make_position: MakePosition
) -> tuple[str, list[dict[str, Any]]]:
    """A short incident with a mayday, from beginning to end: its id and its alarms."""
    incident_id = prepare(browser)
    greet(browser, unit, make_position)
    walk(unit, make_position, 0, 15)
    unit.say(UnitEvent(unit.header_factory.header(), EventKind.MAYDAY))
    until(lambda: browser.call("GET", "/alarms"), "mayday is raised")
    walk(unit, make_position, 15, 25)
    assert browser.close_incident(incident_id) == 204
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
        known = browser.call("GET", f"/incidents/{incident_id}/trails?kind=smoothed")
        assert [one["unit_id"] for one in known["trails"]] == ["FF-01"]
        browser.call("DELETE", path)
        assert browser.status("GET", path) == 404
    assert station.stop() == 0


def test_running_station_replays_in_separate_processes(
    serve: Callable[..., Command], data: Path, unit: Unit, make_position: MakePosition
) -> None:
    """One for each replay, which ends with it."""
    station = serve()
    with Browser(station.wait_ready(), data) as browser:
        incident_id, _ = play_incident(browser, unit, make_position)
        replays = [
            browser.call("POST", "/replays", json={"incident_id": incident_id}) for _ in range(2)
        ]
        paths = [f"/replays/{one['replay_id']}" for one in replays]
        for path in paths:
            with watch(browser, f"{path}/live") as console:
                _wait_for(console, is_shown)
        # The station looks back on the incident by itself meanwhile.
        until(lambda: len(replaying(station.pid)) == 2, "only the replays are left")
        working = replaying(station.pid)
        assert station.pid not in {one.pid for one in working}
        live_nice = psutil.Process(station.pid).nice()
        assert all(one.nice() > live_nice for one in working), "what is live goes first"
        working[0].kill()
        until(
            lambda: (
                sum(browser.status("GET", path) == 200 for path in paths) == 1
                or len(replaying(station.pid)) == 1
            ),
            "only one is left",
        )
        assert browser.status("GET", "/units") == 200, "the station lives on"
        for path in paths:
            browser.status("DELETE", path)
        until(lambda: not replaying(station.pid), "the other one has ended with its replay")
    assert station.stop() == 0


def is_shown(message: dict[str, Any]) -> bool:
    replay = message.get("replay")
    return replay is not None and not replay["seeking"]


def replaying(station: int) -> list[psutil.Process]:
    """Processes that look at the past: copies of one that has loaded the program."""
    found = []
    for child in psutil.Process(station).children():
        with suppress(psutil.NoSuchProcess):  # it has just ended, as one that packs a segment does
            if "base_station.app.worker_process" in child.cmdline():
                found += [one for one in child.children() if one.status() != psutil.STATUS_ZOMBIE]
    return found


def _wait_for(
    console: ClientConnection, condition: Callable[[dict[str, Any]], bool]
) -> dict[str, Any]:
    end_s = time.monotonic() + PATIENCE_S
    schema = jsonschema_rs.validator_for(LIVE_SCHEMA.read_text())
    while time.monotonic() < end_s:
        message: dict[str, Any] = json.loads(console.recv(10.0))
        schema.validate(message)
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
        before = set(data.rglob("*"))
        flags = ("--http", "127.0.0.1:0", "--speed", "20")
        with Command(
            tmp_path / "replay.txt", "replay", incident_id, "--data", str(data), *flags
        ) as replaying:
            with Browser(replaying.wait_ready(), data) as onlooker, watch(onlooker) as console:
                shown = _wait_for(console, lambda one: bool(one.get("alarms")))
                assert shown["replay"]["speed"] == 20.0
                assert shown["alarms"][0]["alarm_id"] == alarms[0]["alarm_id"]
                assert [one["incident_id"] for one in onlooker.call("GET", "/replays")]
                for what in ("/incidents", "/people"):
                    assert onlooker.status("POST", what, json={"name": "x"}) == 409
            assert replaying.stop() == 0
        made = {path.suffix for path in set(data.rglob("*")) - before}
        assert made <= {".checkpoint", ".mcap", ".sqlite-wal", ".sqlite-shm"}  # by the live one
        browser.call("GET", "/health")
    assert station.stop() == 0

    copy = tmp_path / "copy"
    shutil.copytree(data / "log", copy / "log")
    with Command(
        tmp_path / "copied.txt", "replay", incident_id, "--data", str(copy), *flags
    ) as replaying:
        replaying.wait_ready()
        assert "login for this replay" in replaying.output()
        assert replaying.stop() == 0
    assert [path.name for path in copy.iterdir()] == ["log"]
    alone = tmp_path / "elsewhere" / "incident.mcap"
    alone.parent.mkdir()
    exported = CliRunner().invoke(app, ["export", incident_id, str(alone), "--data", str(data)])
    assert exported.exit_code == 0, exported.output
    with Command(tmp_path / "alone.txt", "replay", str(alone), *flags) as replaying:
        address = replaying.wait_ready()
        login = re.search(r"this replay: (\S+)\s+password: (\S+)", replaying.output())
        assert login is not None
        (alone.parent / "first-login.txt").write_text(
            "username: {}\npassword: {}".format(*login.groups())
        )
        with Browser(address, alone.parent) as onlooker, watch(onlooker) as console:
            shown = _wait_for(console, lambda one: bool(one.get("alarms")))
            assert shown["alarms"][0]["alarm_id"] == alarms[0]["alarm_id"]
        assert replaying.stop() == 0
    with Command(
        tmp_path / "none.txt", "replay", "no-such", "--data", str(copy), *flags
    ) as replaying:
        assert replaying.wait() == 2
        assert incident_id in replaying.output()


def test_open_incident_is_replayed_to_its_last_record(tmp_path: Path) -> None:
    """The station died in it, or its clock is another than that of the machine that replays."""
    script, data = Script(), tmp_path / "station"
    script.act(OpenIncident("i1", "Mill Lane"))
    script.wait(30.0)
    with closing(SegmentWriter(data / "log")) as log:
        for record in script.records:
            log.write(*record)
    password = "correct horse battery"
    with Store(data / "station.sqlite") as store:
        Accounts(store, SystemClock()).add_user("admin", password, Role.ADMINISTRATOR)
    (data / "first-login.txt").write_text(f"username: admin\npassword: {password}\n")
    flags = ("--data", str(data), "--http", "127.0.0.1:0")
    with Command(tmp_path / "replay.txt", "replay", "i1", *flags) as replaying:
        with Browser(replaying.wait_ready(), data) as browser:
            (replay,) = browser.call("GET", "/replays")
        assert replaying.stop() == 0
    assert replay["start_ms"] == START_NS // NS_PER_MS
    assert replay["end_ms"] == script.t_ns // NS_PER_MS


def test_rebuild_gives_the_same_tables(
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
        before = [reported(browser, path) for path in paths]
    assert station.stop() == 0
    with Command(tmp_path / "rebuild.txt", "rebuild", "--data", str(data)) as rebuilding:
        assert rebuilding.wait() == 0
        assert "log records projected" in rebuilding.output()
    again = serve()
    with Browser(again.wait_ready(), data) as browser:
        after = [reported(browser, path) for path in paths]
    assert after == before
    assert again.stop() == 0


def reported(browser: Browser, path: str) -> Any:
    """But for alarms that only say that the unit has been silent since."""
    answer = browser.call("GET", path)
    return [one for one in answer if one["rule"] != "link-lost"] if path == "/alarms" else answer
