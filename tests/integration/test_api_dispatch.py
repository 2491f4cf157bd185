"""Reports of the dispatch centre and alerts by way of the API."""

from __future__ import annotations

import dataclasses
from typing import Any

import pytest
from httpx import AsyncClient

from base_station.accounts.principals import Role
from base_station.api.forms import MAX_DISPATCH_BYTES
from base_station.dispatch.config import DispatchConfig, Opening
from base_station.storage.db.window import EVER
from shared.clock import ManualClock
from tests.rig.in_process_station import InProcessStation

FIRE: dict[str, Any] = {
    "number": "2026/1234",
    "type": "Structure fire",
    "address": "Main St 5",
    "units": ["E12", "L4"],
    "position": {"lat_deg": 52.5, "lon_deg": 13.4},
}
CAP = {"content-type": "application/cap+xml"}


@pytest.fixture
def automatic(station: InProcessStation) -> InProcessStation:
    config = DispatchConfig(open=Opening.AUTOMATICALLY)
    services = dataclasses.replace(station.services, dispatch=config)
    station.services = station.app.state.services = services
    return station


async def post(client: AsyncClient, **change: Any) -> dict[str, Any]:
    answer = await client.post("/dispatch", json=FIRE | change)
    assert answer.status_code == 200, answer.text
    content: dict[str, Any] = answer.json()
    return content


async def test_dispatch_is_offered_updated_and_opened_by_a_user(
    station: InProcessStation, clock: ManualClock
) -> None:
    async with station.client(Role.COMMANDER) as client:
        await client.post("/people", json={"name": "Ada", "crew": "Engine 12"})
        first = await post(client)
        assert (first["outcome"], first["incident_id"]) == ("offered", None)
        assert [(one["words"], one["crew"]) for one in first["units"]] == [
            ("Engine 12", "Engine 12"),
            ("Ladder 4", ""),
        ]
        clock.advance(5.0)
        assert (await post(client))["outcome"] == "unchanged"
        smoke = await post(client, remarks="smoke", called="yesterday")
        assert (smoke["outcome"], len(smoke["warnings"])) == ("updated", 1)
        assert [one["code"] for one in smoke["warning_codes"]] == ["report-no-time"]
        older = await post(client, remarks="none", updated="2020-01-01T00:00:00Z")
        assert older["outcome"] == "outdated"
        (offered,) = (await client.get("/dispatch")).json()
        assert offered["dispatch"]["remarks"] == "smoke"
        assert offered["dispatch"]["warning_codes"] == smoke["warning_codes"]
        assert offered["call_signs"] == first["units"]
        new = {"name": "Main St 5", "dispatch_number": "2026/1234"}
        incident = (await client.post("/incidents", json=new)).json()
        assert incident["dispatch_number"] == "2026/1234"
        clock.advance(5.0)
        update = await post(client, remarks="fire out", ended=True)
        assert (update["outcome"], update["incident_id"]) == ("updated", incident["incident_id"])
        path = f"/incidents/{incident['incident_id']}"
        assert (await client.get(path)).json()["name"] == "Main St 5"
        assert (await client.get(path)).json()["closed_ms"] is None
        report = (await client.get(f"{path}/dispatch")).json()
        assert (report["remarks"], report["has_ended"]) == ("fire out", True)
        assert (await client.post("/incidents", json=new)).status_code == 409
        station.services.projection.flush()
        actions = [one.action for one in station.services.records.audit_entries(EVER)]
        assert actions.count("NoteDispatch") == 3  # not of what was known before


async def test_dismissed_dispatch_stays_dismissed(station: InProcessStation) -> None:
    async with station.client(Role.COMMANDER) as client:
        number = {"number": FIRE["number"]}
        assert (await client.post("/dispatch/dismissals", json=number)).status_code == 404
        await post(client)
        assert (await client.post("/dispatch/dismissals", json=number)).status_code == 204
        await post(client, remarks="again")
        (one,) = (await client.get("/dispatch")).json()
        assert one["dispatch"]["is_dismissed"]


async def test_dispatch_opens_automatically_unless_an_incident_is_open(
    automatic: InProcessStation,
) -> None:
    async with automatic.client(Role.COMMANDER) as client:
        first = await post(client)
        assert first["outcome"] == "opened"
        incident = (await client.get(f"/incidents/{first['incident_id']}")).json()
        assert incident["name"] == "Structure fire, Main St 5"
        assert (await client.get("/site/anchor")).json() is None  # that is the officer's
        second = await post(client, number="2026/1235", address="Mill Lane")
        assert (second["outcome"], second["incident_id"]) == ("offered", None)
        assert [one["name"] for one in (await client.get("/incidents")).json()] == [
            "Structure fire, Main St 5"
        ]
        await client.post(f"/incidents/{first['incident_id']}/close")
        assert (await post(client, remarks="late"))["outcome"] == "updated"  # it does not reopen
        over = await post(client, number="2026/1236", ended=True)
        assert over["outcome"] == "offered"


async def test_token_for_dispatch_is_limited_to_dispatch(station: InProcessStation) -> None:
    accounts = station.services.accounts
    _, secret = accounts.add_token("commander", "cad", Role.COMMANDER, None, ["dispatch"])
    async with station.client() as client:
        client.headers["authorization"] = f"Bearer {secret}"
        assert (await post(client))["outcome"] == "offered"
        assert (await client.post("/incidents", json={"name": "x"})).status_code == 403
        assert (await client.get("/people")).status_code == 403


async def test_invalid_bodies_are_refused_with_a_reason(station: InProcessStation) -> None:
    json_type = {"content-type": "application/json"}
    async with station.client(Role.COMMANDER) as client:
        for path, content, headers, status in (
            ("/dispatch", b"rubbish", json_type, 422),
            ("/dispatch", b'{"type": "fire"}', json_type, 422),
            ("/dispatch", b'{"number": "1"}', {"content-type": "text/plain"}, 415),
            ("/dispatch", b" " * (MAX_DISPATCH_BYTES + 1), json_type, 413),
            ("/dispatch/alerts", b"<alert", CAP, 422),
            ("/dispatch/alerts", b"<!DOCTYPE a [<!ENTITY b 'c'>]><alert>&b;</alert>", CAP, 422),
            ("/dispatch/alerts", b"<alert/>", json_type, 415),
            ("/dispatch/alerts", b" " * (MAX_DISPATCH_BYTES + 1), CAP, 413),
        ):
            answer = await client.post(path, content=content, headers=headers)
            assert answer.status_code == status, (path, content[:30], answer.text)
            assert answer.json()["detail"].endswith("."), content[:30]
            assert answer.json()["code"], content[:30]
        assert (await client.get("/dispatch")).json() == []


async def test_an_alert_is_a_marker_until_it_is_cancelled(station: InProcessStation) -> None:
    def alert(identifier: str, kind: str, references: str = "") -> str:
        return f"""<alert xmlns="urn:oasis:names:tc:emergency:cap:1.2">
            <identifier>{identifier}</identifier><sender>s</sender>
            <sent>2020-01-01T00:00:00Z</sent><status>Actual</status><msgType>{kind}</msgType>
            <references>{references}</references><info><event>Gas leak</event>
            <expires>2150-01-01T00:00:00Z</expires>
            <area><areaDesc>Works</areaDesc><circle>52.5,13.4 0.2</circle></area></info></alert>"""

    async with station.client(Role.COMMANDER) as client:
        await client.put("/site/anchor", json={"lat_deg": 52.5, "lon_deg": 13.4})
        shown = await client.post("/dispatch/alerts", content=alert("a", "Alert"), headers=CAP)
        assert (shown.json()["outcome"], shown.json()["markers"]) == ("shown", 1)
        (marker,) = station.drive.picture().external
        assert (marker.name, marker.source, marker.radius_m) == ("Gas leak", "CAP", 200.0)
        cancel = alert("b", "Cancel", "s,a,2020-01-01T00:00:00Z")
        gone = await client.post("/dispatch/alerts", content=cancel, headers=CAP)
        assert gone.json()["outcome"] == "cancelled"
        assert station.drive.picture().external == ()
