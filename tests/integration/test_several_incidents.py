"""Two incidents at once on a station that is killed in the middle."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest

from shared.messages import EventKind, UnitEvent
from tests.rig.reported_incident import plan
from tests.rig.served_station import MakePosition, greet, snapshot
from tests.rig.station_command import Browser, Command, Unit
from tests.rig.waiting import PATIENCE_S, until

PEOPLE = {"FF-01": ("Anna Vos", "Engine 1"), "FF-02": ("Carl Berg", "Engine 2")}
# The positions that the station has judged are those of both, without the names of the other.
LANE_UNIT = re.compile(r'<tr><td><span class="one-line">FF-01</span></td>.*?</tr>')


@pytest.fixture
def units(port: int) -> Iterator[list[Unit]]:
    units = [Unit(port, unit_id) for unit_id in PEOPLE]
    yield units
    for unit in units:
        unit.close()


def open_incident(browser: Browser, name: str, **options: object) -> str:
    opened = browser.call("POST", "/incidents", json={"name": name, **options})
    return str(opened["incident_id"])


def members(browser: Browser, incident_id: str) -> list[str]:
    return [one["name"] for one in browser.call("GET", f"/incidents/{incident_id}/members")]


def par(browser: Browser, incident_id: str) -> dict[str, str]:
    on_duty = browser.call("GET", f"/accountability?incident_id={incident_id}")
    return {one["name"]: one["confirmed"] for one in on_duty}


def walk(units: list[Unit], make_position: MakePosition, begin: int, end: int) -> None:
    for step in range(begin, end):
        for unit in units:
            unit.say(make_position(header=unit.header_factory.header(), north_m=float(step)))


def is_closed_over(browser: Browser, incident_id: str, unit_id: str) -> bool:
    """Close it over this unit and the alarms of this unit alone: on a busy machine it may have
    raised one, as that its link is lost.
    """
    alarms = browser.call("GET", "/alarms")
    own = [one["alarm_id"] for one in alarms if one["unit_id"] == unit_id]
    over = {"despite_unit_ids": [unit_id], "despite_alarm_ids": own}
    return browser.status("POST", f"/incidents/{incident_id}/close", json=over) == 204


def report(browser: Browser, incident_id: str) -> str:
    address = f"{browser.address}/api/v1/incidents/{incident_id}/report.html"
    answer = httpx.get(address, headers={"Cookie": browser.cookie()}, timeout=PATIENCE_S)
    assert answer.status_code == 200, answer.text
    return answer.text


def erase(browser: Browser, incident_id: str, name: str) -> str:
    """Result of a completed erasure."""
    asked = browser.call("POST", f"/incidents/{incident_id}/forget", json={"name": name})

    def job() -> dict[str, Any]:
        jobs = {one["forgetting_id"]: one for one in browser.call("GET", "/forgettings")}
        found: dict[str, Any] = jobs[asked["forgetting_id"]]
        return found

    until(lambda: job()["state"] in ("done", "failed"), "the incident is erased")
    assert job()["state"] == "done", job()["problem"]
    return str(job()["problem"])


def replayed(browser: Browser, incident_id: str) -> dict[str, Any]:
    """Picture at the end of the replay of an incident."""
    replay = browser.call("POST", "/replays", json={"incident_id": incident_id})
    path = f"/replays/{replay['replay_id']}"
    end_ms = replay["end_ms"] - 1
    browser.call("POST", path, json={"playing": False, "at_ms": end_ms})

    def at_end() -> dict[str, Any] | None:
        shown = snapshot(browser, f"{path}/live")
        stands = shown["replay"]
        return shown if stands["at_ms"] >= end_ms and not stands["seeking"] else None

    until(at_end, "the replay stands at its end")
    shown = snapshot(browser, f"{path}/live")
    browser.call("DELETE", path)
    people = {one["person"]["name"] for one in shown["units"] if one["person"]}
    return {
        "incident": shown["incident"]["name"],
        "people": people,
        "alarms": {one["unit_id"] for one in shown["alarms"]},
        "has_plan": shown["plan"] is not None,
    }


def test_two_open_incidents_have_separate_members(
    serve: Callable[..., Command], data: Path, units: list[Unit], make_position: MakePosition
) -> None:
    station = serve()
    with Browser(station.wait_ready(), data) as browser:
        for unit_id, (name, crew) in PEOPLE.items():
            browser.call("POST", "/units", json={"unit_id": unit_id})
            person = browser.call("POST", "/people", json={"name": name, "crew": crew})
            worn = {"unit_id": unit_id, "person_id": person["person_id"]}
            browser.call("POST", "/assignments", json=worn)
        lane = open_incident(browser, "Mill Lane")
        assert browser.status("POST", "/incidents", json={"name": "Harbour"}) == 409
        harbour = open_incident(browser, "Harbour", beside_others=True)
        assert members(browser, lane) == ["Anna Vos", "Carl Berg"]
        assert members(browser, harbour) == []
        assert browser.status("PUT", "/site/plan", json=json.loads(plan())) == 409, "of which?"
        placed = f"/site/plan?incident_id={harbour}"
        assert browser.status("PUT", placed, json=json.loads(plan())) == 204
        engine_2 = {"target": {"crew": "Engine 2"}}
        browser.call("POST", f"/incidents/{harbour}/members", json=engine_2)
        assert (members(browser, lane), members(browser, harbour)) == (["Anna Vos"], ["Carl Berg"])
        for unit in units:
            greet(browser, unit, make_position)
        walk(units, make_position, 0, 15)
        everyone = {"target": {"everyone": True}}
        assert browser.status("POST", "/check-ins", json=everyone) == 409
        assert browser.status("POST", "/check-ins", json=everyone | {"incident_id": lane}) == 204
    station.kill()

    station = serve()
    with Browser(station.wait_ready(), data) as browser:
        assert par(browser, lane) == {"Anna Vos": "radio"}
        assert par(browser, harbour) == {"Carl Berg": "not_yet"}
        greet(browser, units[0], make_position)
        walk(units, make_position, 15, 25)
        units[1].say(UnitEvent(units[1].header_factory.header(), EventKind.MAYDAY))
        until(lambda: browser.call("GET", "/alarms"), "the mayday is raised")
        order = {"kind": "evacuate", "target": {"everyone": True}, "incident_id": lane}
        sent = browser.call("POST", "/commands", json=order)
        assert [one["unit_id"] for one in sent["units"]] == ["FF-01"]
        until(lambda: is_closed_over(browser, lane, "FF-01"), "closed: the mayday is of the other")
        assert browser.call("GET", "/unassigned")[0]["name"] == "Anna Vos"
        assert par(browser, harbour) == {"Carl Berg": "not_yet"}
        alarms = browser.call("GET", f"/incidents/{lane}/alarms")
        assert {one["unit_id"] for one in alarms} <= {"FF-01"}
        ours = browser.call("GET", f"/incidents/{harbour}/tracks")
        assert [one["unit_id"] for one in ours] == ["FF-02"]
        assert browser.close_incident(harbour) == 204

        page = report(browser, lane)
        assert ("Anna Vos" in page, "Mayday from" in page) == (True, False)
        page = report(browser, harbour)
        assert ("Anna Vos" in page, "Mayday from" in page) == (False, True)
        assert replayed(browser, lane) == {
            "incident": "Mill Lane",
            "people": {"Anna Vos"},
            "alarms": set(),
            "has_plan": False,
        }
        of_harbour = {
            "incident": "Harbour",
            "people": {"Carl Berg"},
            "alarms": {"FF-02"},
            "has_plan": True,
        }
        assert replayed(browser, harbour) == of_harbour
        browser.call("GET", f"/incidents/{harbour}/assessment")  # it is worked out
        of_lane, page = report(browser, lane), report(browser, harbour)
        kept = erase(browser, lane, "Mill Lane")
        assert "while another incident was open stays" in kept
        assert replayed(browser, harbour) == of_harbour
        browser.call("GET", f"/incidents/{harbour}/assessment")  # it is worked out again
        assert report(browser, harbour) == LANE_UNIT.sub("", page)
        assert "Anna Vos" in of_lane
        assert "Anna Vos" not in report(browser, lane)
        assert replayed(browser, lane)["people"] == set()
    assert station.stop() == 0
