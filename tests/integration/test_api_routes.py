"""Every route of the API: rights, token scopes, and the audit of every change."""

from __future__ import annotations

import asyncio
import dataclasses
import io
from collections.abc import AsyncIterator, Awaitable, Callable
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import httpx
import pytest
import pytest_asyncio
from fastapi.routing import APIRoute, APIWebSocketRoute
from PIL import Image

from base_station.accounts.principals import Role
from base_station.api.authentication import Scope
from base_station.api.routes import ROUTERS
from base_station.security.pki.folder import PkiFolder
from base_station.storage.db.window import EVER, Window
from base_station.unit_sync.recordings.transfer_queue import TransferQueue
from base_station.views.wire import StandbyView
from shared.clock import NS_PER_MS, NS_PER_S, ManualClock
from shared.messages import EventKind, Header, UnitEvent
from tests.rig import message_factory
from tests.rig.in_process_station import ORIGIN, PASSWORD, InProcessStation
from tests.rig.waiting import until

V, C, A = Role
NOBODY = None  # needs no login
LEAST: dict[str, dict[str, Role | None]] = {
    "login": {"POST /login": NOBODY, "POST /login/hand-over": NOBODY, "POST /logout": NOBODY,
              "POST /hand-over": V, "GET /me": V},
    "users": {"GET /users": A, "POST /users": A, "PUT /users/{username}": A,
              "DELETE /users/{username}": A, "DELETE /users/{username}/sessions": A,
              "POST /me/password": V},
    "tokens": {"GET /tokens": V, "POST /tokens": V, "DELETE /tokens/{token_id}": V},
    "people": {"GET /people": V, "POST /people": C, "GET /people/{person_id}": V,
               "PUT /people/{person_id}": C, "DELETE /people/{person_id}": C,
               "POST /people/import": C,
               "GET /people/{person_id}/photo": V, "PUT /people/{person_id}/photo": C},
    "units": {"GET /units": V, "POST /units": C, "PUT /units/{unit_id}": C,
              "PUT /units/{unit_id}/start": C, "PUT /reference-barometer": C},
    "enrolments": {"GET /enrolments": A, "POST /enrolments": A},
    "samples": {"POST /units/{unit_id}/samples": A, "GET /units/{unit_id}/sample-tokens": A,
                "POST /units/{unit_id}/sample-tokens": A,
                "DELETE /units/{unit_id}/sample-tokens/{token_id}": A},
    "assignments": {"GET /assignments": V, "POST /assignments": C,
                    "DELETE /assignments/{unit_id}": C},
    "incidents": {"GET /incidents": V, "POST /incidents": C, "GET /incidents/{incident_id}": V,
                  "POST /incidents/{incident_id}/close": C,
                  "GET /incidents/{incident_id}/members": V,
                  "POST /incidents/{incident_id}/members": C,
                  "DELETE /incidents/{incident_id}/members/{unit_id}": C,
                  "GET /unassigned": V,
                  "GET /incidents/{incident_id}/alarms": V,
                  "GET /incidents/{incident_id}/dispatch": V,
                  "GET /incidents/{incident_id}/imports": V,
                  "POST /incidents/{incident_id}/imports": C,
                  "DELETE /incidents/{incident_id}/imports/{import_id}": C,
                  "GET /incidents/{incident_id}/imports/{import_id}/tracks": V,
                  "GET /incidents/{incident_id}/imports/{import_id}/picture": V,
                  "GET /incidents/{incident_id}/imports/{import_id}/file": V,
                  "GET /incidents/{incident_id}/assessment": V,
                  "GET /incidents/{incident_id}/thresholds": V,
                  "GET /incidents/{incident_id}/rehearsal": V},
    "dispatch": {"GET /dispatch": V, "POST /dispatch": C, "POST /dispatch/dismissals": C,
                 "POST /dispatch/alerts": C},
    "tracks": {"GET /units/{unit_id}/track": V, "GET /incidents/{incident_id}/tracks": V,
               "GET /incidents/{incident_id}/trails": V, "GET /units/{unit_id}/timeline": V},
    "alarms": {"GET /alarms": V, "GET /alarms/{alarm_id}": V,
               "GET /alarms/{alarm_id}/explanation": V,
               "POST /alarms/{alarm_id}/acknowledge": C, "POST /alarms/{alarm_id}/resolve": C},
    "commands": {"GET /commands": V, "POST /commands": C, "GET /commands/{command_id}": V,
                 "POST /commands/{command_id}/repeat": C,
                 "POST /commands/{command_id}/all-clear": C,
                 "POST /commands/{command_id}/stop": C,
                 "POST /commands/{command_id}/confirm": C,
                 "POST /commands/{command_id}/confirm/undo": C,
                 "GET /units/{unit_id}/routes": V, "GET /guides": V,
                 "POST /units/{unit_id}/guides": C, "DELETE /guides/{rescuer_id}": C},
    "accountability": {"GET /accountability": V, "GET /accountability/usual": V,
                       "POST /check-ins": C, "POST /check-ins/{check_in_id}/undo": C,
                       "PUT /incidents/{incident_id}/accountability": C,
                       "PUT /units/{unit_id}/rest": C},
    "site": {"GET /site/anchor": V, "PUT /site/anchor": C, "GET /site/plan": V,
             "PUT /site/plan": C, "POST /site/drafts": C,
             "GET /site/base-map": V, "PUT /site/base-map": A,
             "DELETE /site/base-map": A, "GET /site/base-map/{image_hash}": V},
    "pins": {"GET /pins": V, "POST /pins": C, "POST /pins/start": C, "POST /pins/meeting": C,
             "PUT /pins/{pin_id}": C, "DELETE /pins/{pin_id}": C, "GET /beacons": V,
             "PUT /beacons/{beacon_id}": C, "DELETE /beacons/{beacon_id}": C},
    "replays": {"GET /replays": V, "POST /replays": V, "GET /replays/{replay_id}": V,
                "POST /replays/{replay_id}": V, "DELETE /replays/{replay_id}": V},
    "recordings": {"GET /recordings": V, "POST /recordings": C,
                   "DELETE /recordings/{fetch_id}": C},
    "exports": {"GET /export-formats": V,
                "GET /incidents/{incident_id}/export/{format_name}": V,
                "GET /incidents/{incident_id}/incident.mcap": V,
                "GET /incidents/{incident_id}/report.html": V,
                "GET /incidents/{incident_id}/report.pdf": V},
    "radio": {"GET /incidents/{incident_id}/radio": V,
              "GET /incidents/{incident_id}/radio/{channel}": C},
    "forgetting": {"GET /forgettings": A, "POST /people/{person_id}/forget": A,
                   "POST /incidents/{incident_id}/forget": A},
    "health": {"GET /health": V, "GET /metrics": V},
    "audit": {"GET /audit": A, "GET /idempotency-keys/{key}": V},
    "standby": {"GET /standby": V, "GET /standby/leads": NOBODY, "POST /standby/take-over": C},
}  # fmt: skip
SOCKETS = {"/live", "/replays/{replay_id}/live"}
CHANGING = [r for routes in LEAST.values() for r in routes if not r.startswith("GET")]
# Looking at the past changes nothing at the standby.
WITHOUT_CHANGES = {"POST /login", "POST /login/hand-over", "POST /logout", "POST /replays",
                "POST /replays/{replay_id}", "DELETE /replays/{replay_id}",
                "POST /standby/take-over"}  # fmt: skip
# What leaves no entry: it changes nothing but what one looks at oneself, or is a unit's message.
LOOKING_ON = {"POST /hand-over", "POST /replays/{replay_id}", "DELETE /replays/{replay_id}",
              "POST /units/{unit_id}/samples", "POST /site/drafts"}  # fmt: skip
PLAN = {"type": "FeatureCollection", "muster": {"frame": "site-m"}, "features": []}
Do = Callable[..., Awaitable[Any]]


class FixedHaStatus:
    def view(self) -> StandbyView:
        return StandbyView("a", "active", ORIGIN, "b", "standby", "", in_step=True)

    def refusal(self) -> None:
        return None

    def take_over(self) -> None:
        pass


@pytest_asyncio.fixture
async def station(tmp_path: Path, clock: ManualClock) -> AsyncIterator[InProcessStation]:
    station = InProcessStation(tmp_path, clock)
    station.hub.connect(asyncio.get_running_loop(), station.drive)
    with TransferQueue(lambda *_: None, tmp_path / "recordings", clock) as desk:
        pki = PkiFolder(tmp_path)
        pki.create("Test", [], ["tls/192.0.2.7:7447"])
        services = dataclasses.replace(
            station.services, recordings=desk, ha_status=FixedHaStatus(), pki=pki
        )
        station.services = station.app.state.services = services
        yield station
    station.close()


def concrete(path: str) -> str:
    return path.replace("{format_name}", "csv").replace("{", "").replace("}", "")


def test_the_tables_name_every_route_and_socket() -> None:
    known = {
        f"{method} {route.path}"
        for router in ROUTERS
        for route in router.routes
        if isinstance(route, APIRoute)
        for method in route.methods or ()
    }
    assert known == {route for routes in LEAST.values() for route in routes}
    assert {
        route.path
        for router in ROUTERS
        for route in router.routes
        if isinstance(route, APIWebSocketRoute)
    } == SOCKETS


async def test_each_route_requires_its_role(station: InProcessStation) -> None:
    for role in (None, *Role):
        async with station.client(role) as client:
            for route, least in (one for routes in LEAST.values() for one in routes.items()):
                method, path = route.split()
                answer = await client.request(method, concrete(path))
                if least is None:
                    continue
                if role is None:
                    assert answer.status_code == 401, route
                elif role < least:
                    assert answer.status_code == 403, (route, role)
                    assert "needs the role" in answer.json()["detail"], (route, role)
                elif route != "POST /hand-over":  # which is for browsers
                    assert answer.status_code not in (401, 403), (route, role)


async def test_a_token_for_another_part_opens_no_route(station: InProcessStation) -> None:
    accounts = station.services.accounts
    for tag, routes in LEAST.items():
        others = {scope.value for scope in Scope} - {tag}
        _, secret = accounts.add_token("administrator", "t", Role.ADMINISTRATOR, None, others)
        async with station.client() as program:
            program.headers["authorization"] = f"Bearer {secret}"
            for route, least in routes.items():
                method, path = route.split()
                answer = await program.request(method, concrete(path))
                if least is not None and tag != "login":
                    assert answer.status_code == 403, route
                    assert "This token is for" in answer.json()["detail"], route


async def test_page_of_another_origin_changes_nothing_by_any_route(
    station: InProcessStation,
) -> None:
    async with station.client() as browser:
        browser.headers["origin"] = ORIGIN
        credentials = {"username": "administrator", "password": PASSWORD}
        assert (await browser.post("/login", json=credentials)).status_code == 200
        for route in CHANGING:
            method, path = route.split()
            foreign = {"origin": "http://elsewhere"}
            answer = await browser.request(method, concrete(path), headers=foreign)
            assert answer.status_code == 403, route
            assert "not the station's own" in answer.json()["detail"], route
        del browser.headers["origin"]
        for route in CHANGING:
            method, path = route.split()
            answer = await browser.request(method, concrete(path))
            assert answer.status_code == 403, route
            assert "must name its origin" in answer.json()["detail"], route


async def test_a_standby_changes_nothing_by_any_route(
    station: InProcessStation, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(FixedHaStatus, "refusal", lambda _: "this is the standby")
    async with station.client(Role.ADMINISTRATOR) as client:
        for route in CHANGING:
            method, path = route.split()
            answer = await client.request(method, concrete(path))
            refused = answer.status_code == 503 and "Nothing was changed" in answer.text
            assert refused == (route not in WITHOUT_CHANGES), route


async def test_replay_station_refuses_changes_by_any_route(
    station: InProcessStation,
) -> None:
    services = dataclasses.replace(station.services, is_replay_only=True)
    station.app.state.services = services
    async with station.client(Role.ADMINISTRATOR) as client:
        for route in CHANGING:
            method, path = route.split()
            answer = await client.request(method, concrete(path))
            refused = answer.status_code == 409 and "only replays" in answer.text
            assert refused == (route not in WITHOUT_CHANGES), route


class EveryAction:
    """Somebody who does everything once, and looks what the audit says of it."""

    def __init__(
        self, station: InProcessStation, client: httpx.AsyncClient, clock: ManualClock
    ) -> None:
        self._station = station
        self._clock = clock
        self._client = client
        self.done: set[str] = set()

    async def do(self, route: str, body: object = None, query: str = "", **names: str) -> Any:
        before = len(self._authors())
        self._clock.advance(1.0)
        method, path = route.split()
        for name, value in names.items():
            path = path.replace(f"{{{name}}}", value)
        content: Any = {"content": body} if isinstance(body, bytes) else {"json": body}
        if isinstance(body, bytes) and body.startswith(b"<alert>"):
            content["headers"] = {"content-type": "application/cap+xml"}
        answer = await self._client.request(method, path + query, **content)
        assert answer.status_code < 300, (route, answer.text)
        self.done.add(route)
        if route not in LOOKING_ON:
            until(lambda: len(self._authors()) > before, f"an entry of {route}")
            assert set(self._authors()[before:]) == {"administrator"}, route
        return answer.json() if answer.content else None

    def _authors(self) -> list[str]:
        self._station.services.projection.flush()
        entries = self._station.services.records.audit_entries(EVER)
        return [entry.by for entry in sorted(entries, key=lambda one: one.number)]


async def test_every_changing_route_is_in_the_audit(
    station: InProcessStation, clock: ManualClock
) -> None:
    async with station.client() as client:
        client.headers["origin"] = ORIGIN
        actions = EveryAction(station, client, clock)
        do = actions.do
        await do("POST /login", {"username": "administrator", "password": PASSWORD})
        await act_on_accounts(do)
        await act_on_an_incident(do, station)
        await do("POST /standby/take-over")
        ticket = (await do("POST /hand-over"))["ticket"]
        await do("POST /login/hand-over", {"ticket": ticket})
        changed = {"old_password": PASSWORD, "new_password": f"{PASSWORD} 2"}
        await do("POST /me/password", changed)
        await do("POST /login", {"username": "administrator", "password": f"{PASSWORD} 2"})
        await do("POST /logout")
    assert set(CHANGING) - actions.done == {
        # They need a log: test_served_closed_incident.py and test_erasure_service.py have them.
        "POST /replays",
        "POST /replays/{replay_id}",
        "DELETE /replays/{replay_id}",
        "POST /incidents/{incident_id}/forget",
    }


async def act_on_accounts(do: Do) -> None:
    await do("POST /users", {"username": "mia", "password": PASSWORD, "role": "viewer"})
    await do("PUT /users/{username}", {"role": "commander"}, username="mia")
    await do("DELETE /users/{username}/sessions", username="mia")
    await do("DELETE /users/{username}", username="mia")
    await do("POST /enrolments", {"unit_id": "FF-09"})
    token = await do("POST /tokens", {"name": "cot", "role": "viewer"})
    await do("DELETE /tokens/{token_id}", token_id=token["token_id"])


async def act_on_dispatches(do: Do) -> None:
    await do("POST /dispatch", {"number": "2026-7"})
    await do("POST /dispatch/dismissals", {"number": "2026-7"})
    names = "<sender>s</sender><identifier>i</identifier>"
    await do("POST /dispatch/alerts", f"<alert>{names}<status>Test</status></alert>".encode())


async def act_on_an_incident(do: Do, station: InProcessStation) -> None:
    unit, other = {"unit_id": "FF-01"}, {"unit_id": "FF-02"}
    await do("POST /units", unit)
    await do("POST /units", other)
    await do("PUT /units/{unit_id}", {"label": "one"}, **unit)
    await act_on_samples(do)
    person = (await do("POST /people", {"name": "Ada"}))["person_id"]
    await do("PUT /people/{person_id}", {"name": "Bea"}, person_id=person)
    await do("POST /people/import", b"Name;Crew\nBea;Engine 1\nDan;Engine 1\n")
    await do("PUT /people/{person_id}/photo", picture(64), person_id=person)
    await act_on_the_site(do)
    await act_on_dispatches(do)
    incident = (await do("POST /incidents", {"name": "Fire"}))["incident_id"]
    await do("POST /assignments", unit | {"person_id": person})
    await do("PUT /units/{unit_id}/start", {"north_m": 1.0, "east_m": 2.0}, **unit)
    await do("PUT /reference-barometer", other)
    times = {"par_interval_s": 900.0, "work_limit_s": 1800.0}
    await do("PUT /incidents/{incident_id}/accountability", times, incident_id=incident)
    await do("PUT /units/{unit_id}/rest", {"resting": True}, **unit)
    await do("POST /check-ins", {"target": {"everyone": True}, "check_in_id": "k1"})
    await do("POST /check-ins/{check_in_id}/undo", {}, check_in_id="k1")
    reported = await do("POST /commands", {"kind": "text", "text": "out", "target": unit})
    await do("POST /commands/{command_id}/confirm", unit, command_id=reported["command_id"])
    await do("POST /commands/{command_id}/confirm/undo", unit, command_id=reported["command_id"])
    out = await do("POST /commands", {"kind": "evacuate", "target": {"everyone": True}})
    await do("POST /commands/{command_id}/repeat", {}, command_id=out["command_id"])
    await do("POST /commands/{command_id}/all-clear", {}, command_id=out["command_id"])
    locate = await do("POST /commands", {"kind": "locate", "target": unit})
    await do("POST /commands/{command_id}/stop", {}, command_id=locate["command_id"])
    await act_on_pins(do)
    for here in (unit, other):
        station.drive.receive(message_factory.position(Header(here["unit_id"], 7, 1, 4)))
    await do("POST /units/{unit_id}/guides", {"rescuer_id": "FF-02"}, **unit)
    await do("DELETE /guides/{rescuer_id}", rescuer_id="FF-02")
    station.drive.receive(UnitEvent(Header("FF-01", 7, 2, 5), EventKind.MAYDAY))
    station.services.projection.flush()
    (alarm, *_) = station.services.records.alarms(Window(0, 2**62))
    seen = {"last_raised_ms": alarm.last_raised_ns // NS_PER_MS}
    await do("POST /alarms/{alarm_id}/acknowledge", seen, alarm_id=alarm.alarm_id)
    await do("POST /alarms/{alarm_id}/resolve", seen, alarm_id=alarm.alarm_id)
    pull = await do("POST /recordings", unit | {"from_ms": 1_000, "to_ms": 2_000})
    await do("DELETE /recordings/{fetch_id}", fetch_id=pull["fetch_id"])
    await do("DELETE /assignments/{unit_id}", **unit)
    await do("DELETE /incidents/{incident_id}/members/{unit_id}", incident_id=incident, **unit)
    await do("POST /incidents/{incident_id}/members", {"target": unit}, incident_id=incident)
    await act_on_imports(do, station, incident)
    await do("POST /incidents/{incident_id}/close", incident_id=incident)
    await do("POST /people/{person_id}/forget", {"name": "Bea"}, person_id=person)
    gone = (await do("POST /people", {"name": "Cy"}))["person_id"]
    await do("DELETE /people/{person_id}", person_id=gone)


async def act_on_imports(do: Do, station: InProcessStation, incident_id: str) -> None:
    now = datetime.fromtimestamp(station.services.clock.utc_ns() / NS_PER_S, UTC).isoformat()
    track = f'<gpx><wpt lat="48" lon="11"><time>{now}</time></wpt></gpx>'.encode()
    adding = "POST /incidents/{incident_id}/imports"
    added = await do(adding, track, "?file_name=a.gpx", incident_id=incident_id)
    taking_out = "DELETE /incidents/{incident_id}/imports/{import_id}"
    await do(taking_out, incident_id=incident_id, import_id=added["import_id"])


async def act_on_samples(do: Do) -> None:
    unit = {"unit_id": "FF-02"}
    token = await do("POST /units/{unit_id}/sample-tokens", {}, **unit)
    columns = {"accel_mps2": [[0.0, 0.0, 9.8]] * 2, "gyro_radps": [[0.0, 0.0, 0.0]] * 2}
    batch = {"seq": 1, "t_ns": [0, 10_000_000], **columns}
    await do("POST /units/{unit_id}/samples", {"boot_id": 1, "batches": [batch]}, **unit)
    removing = "DELETE /units/{unit_id}/sample-tokens/{token_id}"
    await do(removing, token_id=token["token_id"], **unit)


async def act_on_the_site(do: Do) -> None:
    await do("PUT /site/anchor", {"lat_deg": 48.0, "lon_deg": 11.0})
    await do("PUT /site/plan", PLAN)
    await do("POST /site/drafts", picture(64))
    world = "?world=1e-5&world=0&world=0&world=-1e-5&world=11&world=48"
    await do("PUT /site/base-map", picture(64), world)
    await do("DELETE /site/base-map")


async def act_on_pins(do: Do) -> None:
    here = {"unit_id": "FF-01", "north_m": 1.0, "east_m": 2.0}
    pin = (await do("POST /pins", here))["pin_id"]
    await do("PUT /pins/{pin_id}", here | {"east_m": 3.0}, pin_id=pin)
    await do("DELETE /pins/{pin_id}", pin_id=pin)
    await do("POST /pins/start", {"unit_ids": ["FF-01"], "north_m": 1.0, "east_m": 2.0})
    await do("POST /pins/meeting", {"unit_id": "FF-01", "other_unit_id": "FF-02"})
    await do("PUT /beacons/{beacon_id}", {"north_m": 1.0, "east_m": 2.0}, beacon_id="b1")
    await do("DELETE /beacons/{beacon_id}", beacon_id="b1")


def picture(side_px: int) -> bytes:
    written = io.BytesIO()
    Image.new("RGB", (side_px, side_px)).save(written, "PNG")
    return written.getvalue()
