"""The API as a console and a program use it, on the real pipeline and store."""

from __future__ import annotations

import io
import xml.etree.ElementTree as ET
from collections.abc import AsyncIterator, Callable
from urllib.parse import quote

import httpx
import pytest
import pytest_asyncio
from PIL import Image

from base_station.accounts.principals import Role
from base_station.exporters import EXPORTERS
from shared.clock import NS_PER_MS, ManualClock
from shared.header_factory import HeaderFactory
from shared.messages import EventKind, Position, Temperature, UnitEvent
from shared.messages.station import ReportProblem
from tests.rig.in_process_station import ORIGIN, PASSWORD, InProcessStation
from tests.rig.incident_closing import despite


@pytest_asyncio.fixture
async def commander(station: InProcessStation) -> AsyncIterator[httpx.AsyncClient]:
    async with station.client(Role.COMMANDER) as client:
        yield client


@pytest_asyncio.fixture
async def administrator(station: InProcessStation) -> AsyncIterator[httpx.AsyncClient]:
    async with station.client(Role.ADMINISTRATOR) as client:
        yield client


def photo(size: tuple[int, int] = (1200, 800), kind: str = "PNG") -> bytes:
    written = io.BytesIO()
    exif = Image.Exif()
    exif[0x010E] = "taken at home"
    Image.new("RGB", size, "orange").save(written, kind, exif=exif)
    return written.getvalue()


async def test_a_person_gets_a_photo_and_a_unit(
    commander: httpx.AsyncClient, clock: ManualClock
) -> None:
    person = (await commander.post("/people", json={"name": "Ada", "crew": "A"})).json()
    assert person["photo_url"] is None
    path = f"/people/{person['person_id']}"
    sent = await commander.put(
        f"{path}/photo", content=photo(), headers={"content-type": "image/png"}
    )
    assert sent.status_code == 204, sent.text

    url = (await commander.get(path)).json()["photo_url"]
    got = await commander.get(ORIGIN + url)
    picture = Image.open(io.BytesIO(got.content))
    assert (picture.format, picture.size) == ("JPEG", (320, 320))
    assert not picture.getexif()
    assert got.headers["cache-control"] == "private, max-age=86400"  # by no proxy's cache

    assert (await commander.post("/units", json={"unit_id": "FF-01"})).status_code == 201
    clock.advance(1.0)
    worn = {"unit_id": "FF-01", "person_id": person["person_id"]}
    assert (await commander.post("/assignments", json=worn)).status_code == 204
    (unit,) = (await commander.get("/units")).json()
    assert (unit["unit_id"], unit["person_id"], unit["registered"]) == (
        "FF-01",
        person["person_id"],
        True,
    )
    refused = await commander.delete(path)
    assert refused.status_code == 409
    assert "wears FF-01" in refused.json()["detail"]
    clock.advance(1.0)
    assert (await commander.delete("/assignments/FF-01")).status_code == 204
    assert (await commander.delete(path)).status_code == 204


@pytest.mark.parametrize(
    ("upload", "reason"),
    [
        (lambda: b"<svg onload=alert(1)>", "cannot be read"),
        (lambda: photo(kind="JPEG")[:200], "cannot be read"),
        (lambda: photo((8000, 8000)), "million pixels"),
        (lambda: photo((4000, 3100), kind="WEBP"), "12 million pixels"),
    ],
    ids=["no picture", "cut short", "too large", "too large for its kind"],
)
async def test_invalid_photo_is_refused(
    commander: httpx.AsyncClient, upload: Callable[[], bytes], reason: str
) -> None:
    person_id = (await commander.post("/people", json={"name": "Ada"})).json()["person_id"]
    answer = await commander.put(
        f"/people/{person_id}/photo", content=upload(), headers={"content-type": "image/jpeg"}
    )
    assert answer.status_code == 422
    assert reason in answer.json()["detail"]


async def test_an_incident_is_opened_once_and_closed(
    commander: httpx.AsyncClient, clock: ManualClock
) -> None:
    incident = (await commander.post("/incidents", json={"name": "Kitchen"})).json()
    assert incident["opened_by"] == "commander"
    again = await commander.post("/incidents", json={"name": "Cellar"})
    assert again.status_code == 409
    problem = again.json()
    assert problem["detail"] == "the incident 'Kitchen' is open; close it first"
    assert problem["code"] == "incident-still-open"
    assert problem["parameters"] == {"incident": "Kitchen"}
    clock.advance(60.0)
    path = f"/incidents/{incident['incident_id']}"
    assert (await commander.post(f"{path}/close")).status_code == 204
    closed = (await commander.get(path)).json()
    assert closed["closed_ms"] - closed["opened_ms"] == 60_000


async def test_an_alarm_is_acknowledged_and_resolved(
    station: InProcessStation,
    commander: httpx.AsyncClient,
    clock: ManualClock,
    make_position: Callable[..., Position],
) -> None:
    await commander.post("/units", json={"unit_id": "FF-01"})
    header = make_position().header
    station.drive.receive(UnitEvent(header, EventKind.MAYDAY))
    station.projection.flush()
    (alarm,) = (await commander.get("/alarms")).json()
    assert (alarm["priority"], alarm["state"]) == (1, "raised")
    path = f"/alarms/{alarm['alarm_id']}"
    seen = {"last_raised_ms": alarm["last_raised_ms"]}
    clock.advance(1.0)
    assert (await commander.post(f"{path}/acknowledge", json=seen)).status_code == 204
    clock.advance(1.0)
    found = seen | {"note": "found"}
    assert (await commander.post(f"{path}/resolve", json=found)).status_code == 204
    reported = (await commander.get(path)).json()
    assert [one["state"] for one in reported["changes"]] == ["raised", "acknowledged", "resolved"]
    assert reported["changes"][1]["by"] == "commander"


async def acknowledge(commander: httpx.AsyncClient, alarm_id: str, seen_ms: int) -> httpx.Response:
    seen = {"last_raised_ms": seen_ms}
    return await commander.post(f"/alarms/{alarm_id}/acknowledge", json=seen)


@pytest.mark.parametrize("what", ["acknowledge", "resolve"])
async def test_action_on_an_alarm_raised_again_since_is_refused(
    station: InProcessStation, commander: httpx.AsyncClient, clock: ManualClock, what: str
) -> None:
    await commander.post("/units", json={"unit_id": "FF-01"})
    header_factory = HeaderFactory("FF-01", 1, clock)
    station.drive.receive(Temperature(header_factory.header(), 120.0))
    station.projection.flush()
    (seen,) = (await commander.get("/alarms")).json()
    assert seen["last_raised_ms"] == seen["raised_ms"]
    clock.advance(5.0)
    station.drive.receive(Temperature(header_factory.header(), 170.0))
    as_seen = {"last_raised_ms": seen["last_raised_ms"]}
    path = f"/alarms/{seen['alarm_id']}"
    refused = await commander.post(f"{path}/{what}", json=as_seen)
    assert refused.status_code == 409
    detail = refused.json()["detail"]
    assert "raised anew since you saw it, look again: FF-01: equipment at 170 °C" in detail
    (now,) = (await commander.get("/alarms")).json()
    assert now["last_raised_ms"] - now["raised_ms"] == 5_000
    as_seen = {"last_raised_ms": now["last_raised_ms"]}
    assert (await commander.post(f"{path}/{what}", json=as_seen)).status_code == 204


async def test_alarm_action_without_its_raising_is_refused(
    station: InProcessStation, commander: httpx.AsyncClient
) -> None:
    station.drive.submit("station", ReportProblem("log", "It fails"))
    station.projection.flush()
    (alarm,) = (await commander.get("/alarms")).json()
    for what in ("acknowledge", "resolve"):
        refused = await commander.post(f"/alarms/{alarm['alarm_id']}/{what}", json={})
        assert refused.status_code == 422
        assert refused.json()["detail"] == "last_raised_ms is missing; fill it in"


async def test_alarms_of_an_incident_show_when_they_were_raised_again(
    station: InProcessStation, commander: httpx.AsyncClient, clock: ManualClock
) -> None:
    """Worse, or again after somebody had acknowledged it; not where it eased, nor afterwards."""
    await commander.post("/units", json={"unit_id": "FF-01"})
    incident = (await commander.post("/incidents", json={"name": "Kitchen"})).json()
    header_factory = HeaderFactory("FF-01", 1, clock)

    def hot(degc: float, *times_s: float) -> None:
        for passed_s in times_s:
            clock.advance(passed_s)
            station.drive.receive(Temperature(header_factory.header(), degc))

    def mayday() -> None:
        clock.advance(1.0)
        station.drive.receive(UnitEvent(header_factory.header(), EventKind.MAYDAY))

    def now_ms() -> int:
        return clock.utc_ns() // NS_PER_MS

    hot(120.0, 1.0)
    first_ms = now_ms()
    hot(170.0, 1.0)
    worse_ms = now_ms()
    hot(120.0, 1.0, 11.0)
    mayday()
    pressed_ms = now_ms()
    station.projection.flush()
    heat, pressed = (await commander.get("/alarms")).json()[::-1]
    assert heat["changed_ms"] > worse_ms, "it has eased"
    clock.advance(1.0)
    assert (await acknowledge(commander, pressed["alarm_id"], pressed_ms)).status_code == 204
    mayday()
    again_ms = now_ms()
    path = f"/incidents/{incident['incident_id']}"
    clock.advance(1.0)
    await close_over_all(commander, path)
    assert (await acknowledge(commander, pressed["alarm_id"], again_ms)).status_code == 204
    mayday()
    station.projection.flush()
    reported = (await commander.get(f"{path}/alarms")).json()
    raisings = {one["rule"]: one["raisings"] for one in reported}
    assert [one["t_ms"] for one in raisings["mayday"]] == [pressed_ms, again_ms]
    assert [one["t_ms"] for one in raisings["heat"]] == [first_ms, worse_ms]
    at_first, worse = (one["text"] for one in raisings["heat"])
    assert ("at 120 °C" in at_first, "at 170 °C" in worse) == (True, True), "as it was said"


@pytest.mark.parametrize("part", ["log", "apart engine-2", "flood FF-01@tracker"])
async def test_alarm_of_any_failed_part_of_the_station_can_be_resolved(
    station: InProcessStation, commander: httpx.AsyncClient, clock: ManualClock, part: str
) -> None:
    station.drive.submit("station", ReportProblem(part, "It fails"))
    station.projection.flush()
    (alarm,) = (await commander.get("/alarms")).json()
    path = f"/alarms/{quote(alarm['alarm_id'])}"
    seen = {"last_raised_ms": alarm["last_raised_ms"]}
    clock.advance(1.0)
    assert (await commander.post(f"{path}/acknowledge", json=seen)).status_code == 204
    clock.advance(1.0)
    assert (await commander.post(f"{path}/resolve", json=seen)).status_code == 204
    assert (await commander.get(path)).json()["state"] == "resolved"


async def _walk(
    station: InProcessStation,
    commander: httpx.AsyncClient,
    clock: ManualClock,
    make_position: Callable[..., Position],
) -> str:
    """Ada walks north for ten seconds in an incident; returns its id."""
    await commander.post("/units", json={"unit_id": "FF-01"})
    person_id = (await commander.post("/people", json={"name": "=Ada", "crew": "A"})).json()[
        "person_id"
    ]
    await commander.post("/assignments", json={"unit_id": "FF-01", "person_id": person_id})
    incident = (await commander.post("/incidents", json={"name": "Kitchen <1>"})).json()
    for step in range(11):
        clock.advance(1.0)
        station.drive.receive(make_position(north_m=float(step)))
    await close_over_all(commander, f"/incidents/{incident['incident_id']}")
    return str(incident["incident_id"])


async def close_over_all(commander: httpx.AsyncClient, incident: str) -> None:
    refused = await commander.post(f"{incident}/close")
    assert refused.status_code == 409, "with somebody inside, or an open alarm"
    closed = await commander.post(f"{incident}/close", json=despite(refused.json()))
    assert closed.status_code == 204


async def test_tracks_can_be_thinned(
    station: InProcessStation,
    commander: httpx.AsyncClient,
    clock: ManualClock,
    make_position: Callable[..., Position],
) -> None:
    incident_id = await _walk(station, commander, clock, make_position)
    (every,) = (await commander.get(f"/incidents/{incident_id}/tracks")).json()
    (thin,) = (await commander.get(f"/incidents/{incident_id}/tracks?every_s=5")).json()
    assert every["unit_id"] == "FF-01"
    assert len(every["points"]) == 10
    assert 2 <= len(thin["points"]) <= 3
    assert all(point in every["points"] for point in thin["points"])


async def test_exports_contain_the_track_or_report_what_is_missing(
    station: InProcessStation,
    commander: httpx.AsyncClient,
    clock: ManualClock,
    make_position: Callable[..., Position],
) -> None:
    incident_id = await _walk(station, commander, clock, make_position)
    for exporter in EXPORTERS:
        answer = await commander.get(f"/incidents/{incident_id}/export/{exporter.name}")
        assert answer.status_code == (409 if exporter.needs_anchor else 200)

    table = (await commander.get(f"/incidents/{incident_id}/export/csv")).text.splitlines()
    assert len(table) == 11
    assert table[1].startswith("FF-01,'=Ada,A,")

    await commander.put("/site/anchor", json={"lat_deg": 52.0, "lon_deg": 13.0})
    assert (await commander.get("/site/anchor")).json()["lat_deg"] == 52.0
    late = await commander.get(f"/incidents/{incident_id}/export/gpx")
    assert late.status_code == 200  # an anchor that comes late is better than none


async def test_gpx_follows_its_schema(
    station: InProcessStation,
    commander: httpx.AsyncClient,
    clock: ManualClock,
    make_position: Callable[..., Position],
) -> None:
    await commander.put("/site/anchor", json={"lat_deg": 52.0, "lon_deg": 13.0})
    incident_id = await _walk(station, commander, clock, make_position)
    gpx = ET.fromstring((await commander.get(f"/incidents/{incident_id}/export/gpx")).content)
    points = list(gpx.iter("{http://www.topografix.com/GPX/1/1}trkpt"))
    assert len(points) == 10
    assert [child.tag.rpartition("}")[2] for child in points[0]] == ["ele", "time"]
    assert float(points[-1].get("lat", "0")) > float(points[0].get("lat", "0"))
    collection = (await commander.get(f"/incidents/{incident_id}/export/geojson")).json()
    (line,) = collection["features"]
    assert line["geometry"]["coordinates"][0][:2] == pytest.approx([13.0, 52.0], abs=1e-3)


async def test_a_plan_without_scale_is_refused(commander: httpx.AsyncClient) -> None:
    answer = await commander.put("/site/plan", json={"type": "FeatureCollection", "features": []})
    assert answer.status_code == 422
    assert "site-m" in answer.json()["detail"]
    plan = {"type": "FeatureCollection", "muster": {"frame": "site-m"}, "features": []}
    assert (await commander.put("/site/plan", json=plan)).status_code == 204
    assert (await commander.get("/site/plan")).json() == plan


async def test_plan_with_walls_on_a_floor_without_height_is_refused(
    commander: httpx.AsyncClient,
) -> None:
    """Nobody would heed them, and nobody would see that."""
    line = {"type": "LineString", "coordinates": [[0.0, 0.0], [9.0, 0.0]]}
    wall = {"type": "Feature", "properties": {"kind": "wall", "floor": 1}, "geometry": line}
    ground, upstairs = {"floor": 0, "down_m": 0.0}, {"floor": 1, "down_m": -3.0}
    for floors, status in (([], 422), ([ground], 422), ([ground, upstairs], 204)):
        site = {"frame": "site-m", "floors": floors}
        plan = {"type": "FeatureCollection", "muster": site, "features": [wall]}
        answer = await commander.put("/site/plan", json=plan)
        assert answer.status_code == status
        if status == 422:
            assert 'must list {"floor": 1, "down_m": ...}' in answer.json()["detail"]


async def test_errors_are_sentences(commander: httpx.AsyncClient) -> None:
    unknown = await commander.post("/units", json={"unit_id": "FF-01", "lable": "x"})
    assert unknown.status_code == 422
    assert unknown.headers["content-type"] == "application/problem+json"
    assert "lable" in unknown.json()["detail"]
    assert (await commander.get("/nothing")).json()["status"] == 404
    not_finite = await commander.put(
        "/site/anchor",
        content='{"lat_deg": NaN, "lon_deg": 1}',
        headers={"content-type": "application/json"},
    )
    assert not_finite.status_code == 422


async def test_actions_are_in_the_audit(
    commander: httpx.AsyncClient, administrator: httpx.AsyncClient
) -> None:
    await commander.post("/incidents", json={"name": "Kitchen"})
    entries = (await administrator.get("/audit")).json()
    assert ("commander", "OpenIncident") in {(one["by"], one["action"]) for one in entries}


async def test_users_are_managed_by_administrators(
    station: InProcessStation, administrator: httpx.AsyncClient
) -> None:
    new = {"username": "mia", "password": PASSWORD, "role": "viewer"}
    assert (await administrator.post("/users", json=new)).status_code == 204
    assert (await administrator.post("/users", json=new)).status_code == 409
    last = await administrator.delete("/users/administrator")
    assert last.status_code == 409
    assert "only administrator" in last.json()["detail"]
    async with station.client() as client:
        client.headers["origin"] = ORIGIN
        credentials = {"username": "mia", "password": PASSWORD}
        assert (await client.post("/login", json=credentials)).json()["role"] == "viewer"
        changed = {"old_password": PASSWORD, "new_password": "another long one"}
        assert (await client.post("/me/password", json=changed)).status_code == 204
        assert (await client.get("/me")).status_code == 401  # its sessions ended
