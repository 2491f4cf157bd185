"""A station's log holds no name of a person, whatever was entered; displays show names."""

from __future__ import annotations

import json
from collections.abc import Callable
from contextlib import closing
from pathlib import Path
from typing import Any

from base_station.core.state import ERASED_TEXT
from base_station.storage.checkpoints import Checkpoints
from base_station.storage.data_folder import DataFolder
from shared.channels import COMMAND, REPLY
from shared.codec import decode, encode
from shared.mcap_log import SegmentReader, segment_paths
from shared.messages import Command as UnitCommand
from shared.messages import CommandReply, CommandState, EventKind, UnitEvent
from tests.rig.erasure_scenario import ANA, BO, names_in, some_photo, stored_in
from tests.rig.served_station import MakePosition, greet, snapshot, walk, watch
from tests.rig.station_command import Browser, Command, Unit
from tests.rig.waiting import until

MARRIED = "Anastazja Wójcik"
CREW = "Engine Kappa"
EXPORTS = ("gpx", "kml", "csv", "geojson")
NAMES = (*ANA.split(), *MARRIED.split(), BO, "Kappa")


class Scene:
    """An incident in which names stand wherever an operator can enter any."""

    def __init__(self, browser: Browser, unit: Unit, make_position: MakePosition) -> None:
        self._browser = browser
        self._unit = unit
        self._make_position = make_position
        self.reported: list[UnitCommand] = []
        self.mayday: dict[str, Any] = {}

    def play(self) -> None:
        call, unit = self._browser.call, self._unit
        call("PUT", "/site/anchor", json={"lat_deg": 52.0, "lon_deg": 4.0})
        self.ana = call("POST", "/people", json={"name": ANA, "crew": CREW})["person_id"]
        bo = call("POST", "/people", json={"name": BO, "crew": "Engine 2"})["person_id"]
        call("PUT", f"/people/{self.ana}/photo", content=some_photo())
        call("POST", "/units", json={"unit_id": "FF-01", "label": f"{ANA}'s unit"})
        call("POST", "/units", json={"unit_id": "FF-02", "label": "two"})
        for unit_id, person_id in (("FF-01", self.ana), ("FF-02", bo)):
            call("POST", "/assignments", json={"unit_id": unit_id, "person_id": person_id})
        opened = call("POST", "/incidents", json={"name": f"Search for {ANA}"})
        self.incident_id = opened["incident_id"]
        greet(self._browser, unit, self._make_position)
        walk(unit, self._make_position, 0, 10)
        self._mayday()
        self._order()
        pin = {"unit_id": "FF-01", "north_m": 1.0, "east_m": 1.0, "note": f"{ANA} was here"}
        call("POST", "/pins", json=pin)
        call("POST", "/check-ins", json={"target": {"crew": CREW}})
        call("POST", "/pins", json=pin | {"unit_id": "FF-02", "note": f"says {ANA.upper()}"})
        call("PUT", f"/people/{self.ana}", json={"name": MARRIED, "crew": CREW})
        walk(unit, self._make_position, 10, 15)

    def _mayday(self) -> None:
        unit = self._unit
        unit.say(UnitEvent(unit.header_factory.header(), EventKind.MAYDAY))
        until(lambda: self._browser.call("GET", "/alarms"), "mayday is raised")
        (self.mayday,) = self._browser.call("GET", "/alarms")
        seen = {"last_raised_ms": self.mayday["last_raised_ms"]}
        path = f"/alarms/{self.mayday['alarm_id']}"
        self._browser.call("POST", f"{path}/acknowledge", json=seen)
        self._browser.call("POST", f"{path}/resolve", json=seen | {"note": f"{BO} is with {ANA}"})

    def _order(self) -> None:
        unit = self._unit

        def take(_key: str, payload: bytes) -> None:
            command = decode(COMMAND, payload)
            assert isinstance(command, UnitCommand)
            self.reported.append(command)
            header = unit.header_factory.header()
            reply = CommandReply(header, command.command_id, CommandState.ACKNOWLEDGED, "")
            unit.bus.publish(REPLY.key("FF-01"), encode(reply), REPLY.qos)

        with closing(unit.bus.subscribe(COMMAND.key("FF-01"), take)):
            target = {"crew": CREW}
            order = {"kind": "text", "target": target, "text": f"{ANA}, come out, {BO} waits"}
            self._browser.call("POST", "/commands", json=order)
            until(lambda: self._answered() == 1, "the wearer has answered")

    def _answered(self) -> int:
        (sent,) = (one for one in self._browser.call("GET", "/commands") if one["kind"] == "text")
        return sum(one["acknowledged_ms"] is not None for one in sent["units"])


def test_new_log_contains_no_name(
    serve: Callable[..., Command], data: Path, unit: Unit, make_position: MakePosition
) -> None:
    station = serve()
    with Browser(station.wait_ready(), data) as browser:
        scene = Scene(browser, unit, make_position)
        scene.play()
        shown = _everything_shown(browser, scene.incident_id)
        assert scene.mayday["text"] == f"Mayday from {ANA}"
        texts = [one.text for one in scene.reported if one.text]
        assert texts == [f"{ANA}, come out, {BO} waits"], "the wearer gets the names"
        assert browser.close_incident(scene.incident_id) == 204
        replayed = _replayed(browser, scene.incident_id)
        _forget(browser, scene.ana, MARRIED)
        afterwards = _everything_shown(browser, scene.incident_id)
        replayed_afterwards = _replayed(browser, scene.incident_id)
        assert station.stop() == 0

    folder = DataFolder(data)
    assert _records(folder), "there is a log to be looked through"
    for key, payload in _records(folder):
        text = payload.decode("utf-8", "ignore").lower()
        assert [name for name in NAMES if name.lower() in text] == [], key
    for path in folder.checkpoints.iterdir():
        assert Checkpoints(folder.checkpoints).latest() is not None
        assert names_in(path.read_bytes(), ANA) == []
    # Now as they are called now, and as often as they were named.
    for what, text in shown.items():
        assert MARRIED in text, what
        assert ANA not in text, what
        assert "{person" not in text, what
    assert (MARRIED in replayed, BO in replayed, "{person" in replayed) == (True, True, False)
    for what, text in (afterwards | {"replay": replayed_afterwards}).items():
        assert (MARRIED in text, ANA in text, "{person" in text) == (False, False, False), what
        assert what in {"/people", *EXPORTS} or ERASED_TEXT in text, what
    for name in (*ANA.split(), MARRIED):
        assert names_in(stored_in(folder.path), name) == [], "nor is it anywhere else"


def _everything_shown(browser: Browser, incident_id: str) -> dict[str, str]:
    exports = [f"/incidents/{incident_id}/export/{one}" for one in EXPORTS]
    paths = (
        "/alarms", "/audit", "/assignments", "/units", "/incidents", "/people", "/commands",
        "/pins", f"/incidents/{incident_id}/alarms",
    )  # fmt: skip
    reported = {path: _text(browser, path) for path in paths}
    reported |= {path.rpartition("/")[2]: _text(browser, path) for path in exports}
    return reported | {"live": str(snapshot(browser))}


def _replayed(browser: Browser, incident_id: str) -> str:
    """Picture of a console at the end."""
    replay = browser.call("POST", "/replays", json={"incident_id": incident_id})
    path = f"/replays/{replay['replay_id']}"
    shown: dict[str, Any] = {}

    def is_at_end() -> bool:
        nonlocal shown
        shown = snapshot(browser, f"{path}/live")
        return not shown["replay"]["seeking"] and any(one["person"] for one in shown["units"])

    with watch(browser, f"{path}/live"):  # else it would be ended as one that nobody looks at
        browser.call("POST", path, json={"playing": False, "at_ms": replay["end_ms"]})
        until(is_at_end, "the replay shows the incident's end")
    browser.call("DELETE", path)
    return json.dumps(shown, ensure_ascii=False)


def _forget(browser: Browser, person_id: str, name: str) -> None:
    confirmed = {"name": name, "unassign": True}
    browser.call("POST", f"/people/{person_id}/forget", json=confirmed)
    until(
        lambda: [one["state"] for one in browser.call("GET", "/forgettings")] == ["done"],
        "the person is forgotten",
    )


def _text(browser: Browser, path: str) -> str:
    answer = browser._client.get(path)
    assert answer.is_success, (path, answer.text)
    return answer.text


def _records(folder: DataFolder) -> list[tuple[str, bytes]]:
    """Every record, those for other programs included."""
    found: list[tuple[str, bytes]] = []
    for path in segment_paths(folder.log):
        with SegmentReader(path) as segment:
            found += [(key, payload) for _, key, payload in segment.records()]
            found += [(key, payload) for _, key, payload in segment.records(derived=True)]
    return found
