"""Two incidents at once on a pair of stations, of which the leading one dies."""

from __future__ import annotations

import json
from contextlib import ExitStack
from pathlib import Path
from typing import Any

from websockets.sync.client import connect

from tests.bench.standby.station_of_pair import Place, Station
from tests.bench.standby.two_stations import TwoStations
from tests.rig.pacing import PATIENCE_S, wait_until
from tests.rig.reported_incident import plan
from tests.rig.two_stations import two_stations

CREWS = {"anna": "Engine 1", "bert": "Engine 2"}
EVERYONE = {"everyone": True}


def record_incident(at: Station) -> tuple[str, str]:
    """Ids of two open incidents: with anna, whose PAR is confirmed, and with bert, on a plan."""
    api = at.logged_in()
    for unit_id, crew in CREWS.items():
        person = at.post("/people", {"name": unit_id.title(), "crew": crew})
        at.post("/assignments", {"unit_id": unit_id, "person_id": person["person_id"]})
    lane = at.post("/incidents", {"name": "Mill Lane", "par_interval_s": 600})["incident_id"]
    beside = {"name": "Harbour", "beside_others": True, "par_interval_s": 1200}
    harbour = at.post("/incidents", beside)["incident_id"]
    at.post(f"/incidents/{harbour}/members", {"target": {"crew": CREWS["bert"]}})
    api.put(f"/site/plan?incident_id={harbour}", json.loads(plan()))
    api.put(f"/site/anchor?incident_id={lane}", {"lat_deg": 52.5, "lon_deg": 13.4})
    at.post("/check-ins", {"target": EVERYONE, "incident_id": lane})
    return lane, harbour


def shown(at: Station) -> dict[str, Any]:
    """Picture of a console that must not change with the leading station."""
    api = at.logged_in()
    headers = {"Cookie": api.cookie, "Origin": api.origin}
    with connect(api.live_url, additional_headers=headers, max_size=None) as socket:
        picture = json.loads(socket.recv(PATIENCE_S))
    return {
        "incidents": picture["incidents"],
        "grounds": [
            {"site_id": picture["incident"]["site_id"], **_ground(picture)},
            *({"site_id": one["site_id"], **_ground(one)} for one in picture["sites"]),
        ],
        "members": {
            one["unit_id"]: (one["person"], one["incident_id"], _par(one))
            for one in picture["units"]
        },
    }


def _ground(where: dict[str, Any]) -> dict[str, Any]:
    return {"plan": where["plan"], "anchor": where["anchor"]}


def _par(unit: dict[str, Any]) -> dict[str, Any]:
    """The clock of the roll call.  Work and rest follow from what the unit sends meanwhile."""
    names = ("checked_in_ms", "checked_in_by", "due_ms", "confirmed", "entry_id", "on_duty_ms")
    return {name: unit["duty"][name] for name in names}


def take_over(two: TwoStations, dies: Station, leads: Station) -> dict[str, Any]:
    """The leading station dies; what the other one shows then."""
    before = shown(dies)
    wait_until("the other has it", lambda: shown(leads) == before)
    dies.kill()
    wait_until("the other leads", leads.leads)
    assert shown(leads) == before
    dies.start()
    wait_until("the one that died follows", dies.follows)
    assert shown(dies) == before
    return before


def test_a_takeover_keeps_both_incidents_with_their_people_par_clocks_and_plans(
    tmp_path: Path, closing: ExitStack
) -> None:
    two = two_stations(tmp_path, (Place(), Place()), closing)
    two.start()
    for unit_id in CREWS:
        two.start_unit(unit_id, two.first)
    two.wait_received(two.first)
    lane, harbour = record_incident(two.first)
    kept = take_over(two, two.first, two.second)
    assert [one["incident_id"] for one in kept["incidents"]] == [lane, harbour]
    assert [one["par_interval_s"] for one in kept["incidents"]] == [600, 1200]
    assert {unit: of for unit, (_, of, _) in kept["members"].items()} == {
        "anna": lane,
        "bert": harbour,
    }
    par = {unit: duty["confirmed"] for unit, (_, _, duty) in kept["members"].items()}
    assert par == {"anna": "radio", "bert": "not_yet"}
    of_harbour, of_lane = kept["grounds"]
    assert (of_harbour["plan"] is None, of_lane["plan"] is None) == (False, True)
    assert of_lane["anchor"]["lat_deg"] == 52.5
    assert of_harbour["anchor"] != of_lane["anchor"]  # none, or by the first fix of its unit

    two.second.post("/check-ins", {"target": EVERYONE, "incident_id": harbour})
    two.second.post(f"/incidents/{harbour}/members", {"target": {"crew": CREWS["anna"]}})
    moved = take_over(two, two.second, two.first)
    par = {unit: (of, duty["confirmed"]) for unit, (_, of, duty) in moved["members"].items()}
    assert par == {"anna": (harbour, "not_yet"), "bert": (harbour, "radio")}
    assert two.first.post(f"/incidents/{lane}/close", {}) is None
    assert [one["incident_id"] for one in shown(two.first)["incidents"]][-1:] == [harbour]
