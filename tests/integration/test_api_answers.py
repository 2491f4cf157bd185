"""Answers of actions do not wait for the database; later queries find the action there."""

from __future__ import annotations

import asyncio
import time
from collections.abc import AsyncIterator, Iterator, Sequence
from contextlib import contextmanager
from typing import Any, NamedTuple

import httpx
import pytest
import pytest_asyncio
from sqlalchemy.orm import Session

from base_station.accounts.principals import Role
from base_station.api import current_tables
from base_station.storage.db.projecting import project_into
from base_station.storage.db.projection import SqlProjection
from base_station.storage.projection import Projection
from shared.clock import ManualClock
from shared.messages import EventKind, Header, UnitEvent
from shared.messages.station import ReportProblem
from tests.rig.in_process_station import InProcessStation
from tests.rig.waiting import PATIENCE_S

EVERYONE = {"target": {"everyone": True}}
SLOW_S = 0.2  # of each transaction
MANY_READERS = 60  # the routes share 40 threads


class Scene(NamedTuple):
    """Ada wears FF-01 in an open incident, and has pressed the button."""

    station: InProcessStation
    commander: httpx.AsyncClient
    incident_id: str
    mayday_id: str
    seen: dict[str, int]  # the raising on the screen


@pytest_asyncio.fixture
async def scene(station: InProcessStation, clock: ManualClock) -> AsyncIterator[Scene]:
    async with station.client(Role.ADMINISTRATOR) as commander:
        person = (await commander.post("/people", json={"name": "Ada", "crew": "A"})).json()
        await commander.post("/units", json={"unit_id": "FF-01"})
        worn = {"unit_id": "FF-01", "person_id": person["person_id"]}
        assert (await commander.post("/assignments", json=worn)).status_code == 204
        incident = (await commander.post("/incidents", json={"name": "Kitchen"})).json()
        clock.advance(1.0)
        station.projection.flush()
        station.drive.receive(UnitEvent(Header("FF-01", 7, 1, 5), EventKind.MAYDAY))
        (mayday,) = station.drive.picture().alarms
        clock.advance(1.0)
        seen = {"last_raised_ms": mayday.last_raised_ms}
        yield Scene(station, commander, incident["incident_id"], mayday.alarm_id, seen)


@pytest.fixture
def slow_database(monkeypatch: pytest.MonkeyPatch) -> None:
    def project_slowly(session: Session, batch: Sequence[Projection]) -> int:
        time.sleep(SLOW_S)
        return project_into(session, batch)

    monkeypatch.setattr("base_station.storage.db.projection.project_into", project_slowly)


@contextmanager
def database_hangs(station: InProcessStation) -> Iterator[None]:
    """A transaction takes for ever; who reads is answered as before."""
    with station.store.write():
        yield


async def act(scene: Scene, method: str, path: str, body: object) -> Any:
    path = path.format(mayday=scene.mayday_id, incident=scene.incident_id)
    answer = await scene.commander.request(method, path, json=body)
    assert answer.is_success, (path, answer.status_code, answer.text)
    return answer.json() if answer.content else None


async def carried_out(scene: Scene) -> list[str]:
    """By the audit, newest first."""
    entries = (await scene.commander.get("/audit")).json()
    return [entry["action"] for entry in entries]


async def test_requests_are_answered_while_the_database_hangs_and_stored_later(
    scene: Scene, monkeypatch: pytest.MonkeyPatch
) -> None:
    def flush(*_: object) -> bool:
        raise AssertionError("an answer waits for the database")

    monkeypatch.setattr(SqlProjection, "flush", flush)
    closing = {"despite_unit_ids": ["FF-01"]}
    with database_hangs(scene.station):
        await act(scene, "POST", "/alarms/{mayday}/acknowledge", scene.seen)
        (mayday,) = scene.station.drive.picture().alarms
        assert (mayday.state, mayday.by) == ("acknowledged", "administrator")
        await act(scene, "POST", "/alarms/{mayday}/resolve", scene.seen)
        await act(scene, "POST", "/check-ins", EVERYONE)
        order = await act(scene, "POST", "/commands", {"kind": "evacuate"} | EVERYONE)
        assert [one["unit_id"] for one in order["units"]] == ["FF-01"]
        await act(scene, "POST", "/incidents/{incident}/close", closing)
        opened = await act(scene, "POST", "/incidents", {"name": "Cellar"})
        assert (opened["name"], opened["opened_by"]) == ("Cellar", "administrator")
        registered = await act(scene, "POST", "/units", {"unit_id": "FF-02", "label": "two"})
        assert (registered["label"], registered["registered"]) == ("two", True)
        labelled = await act(scene, "PUT", "/units/FF-01", {"label": "one"})
        assert (labelled["label"], labelled["person_id"] is None) == ("one", False)
        await act(scene, "PUT", "/units/FF-02/start", {"north_m": 1.0, "east_m": 2.0})
        await act(scene, "DELETE", "/assignments/FF-01", None)
        with monkeypatch.context() as hurried:
            hurried.setattr(current_tables, "MAX_WAIT_S", 0.0)
            assert "AcknowledgeAlarm" not in await carried_out(scene), "it hangs"
    assert (await carried_out(scene))[:10] == [
        *("Unassign", "SetStart", "RegisterUnit", "RegisterUnit", "OpenIncident"),
        *("CloseIncident", "SendCommand", "CheckIn", "ResolveAlarm", "AcknowledgeAlarm"),
    ]


@pytest.mark.usefixtures("slow_database")
@pytest.mark.parametrize(
    ("request_", "read", "reported"),
    [
        (("POST", "/alarms/{mayday}/acknowledge", None), "/alarms", '"state":"acknowledged"'),
        (("POST", "/alarms/{mayday}/acknowledge", None), "/alarms/{mayday}", '"acknowledged"'),
        (
            ("POST", "/alarms/{mayday}/acknowledge", None),
            "/incidents/{incident}/alarms",
            '"state":"acknowledged"',
        ),
        (("POST", "/check-ins", EVERYONE), "/audit", '"CheckIn"'),
        (("POST", "/commands", {"kind": "evacuate"} | EVERYONE), "/audit", '"SendCommand"'),
        (("DELETE", "/assignments/FF-01", None), "/assignments", '"until_ms":1'),
        (("POST", "/units", {"unit_id": "FF-07"}), "/units", '"FF-07"'),
        (
            ("POST", "/incidents/{incident}/close", {"despite_unit_ids": ["FF-01"]}),
            "/incidents/{incident}",
            '"closed_by":"administrator"',
        ),
        (
            ("POST", "/incidents/{incident}/close", {"despite_unit_ids": ["FF-01"]}),
            "/incidents",
            '"closed_by":"administrator"',
        ),
        (("PUT", "/site/anchor", {"lat_deg": 50.0, "lon_deg": 8.5}), "/site/anchor", "8.5"),
    ],
)
async def test_answered_change_is_in_the_next_read(
    scene: Scene,
    request_: tuple[str, str, object],
    read: str,
    reported: str,
) -> None:
    method, path, body = request_
    if "close" in path:
        await act(scene, "POST", "/alarms/{mayday}/resolve", scene.seen)
    read = read.format(mayday=scene.mayday_id, incident=scene.incident_id)
    before = await scene.commander.get(read)
    assert reported not in before.text
    await act(scene, method, path, scene.seen if "acknowledge" in path else body)
    after = await scene.commander.get(read)
    assert (after.status_code, reported in after.text) == (200, True), after.text


@pytest.mark.usefixtures("slow_database")
async def test_unassignment_is_known_to_the_next_request(
    scene: Scene,
) -> None:
    (ada,) = (await scene.commander.get("/people")).json()
    path = f"/people/{ada['person_id']}"
    assert (await scene.commander.delete(path)).status_code == 409
    await act(scene, "DELETE", "/assignments/FF-01", None)
    assert (await scene.commander.delete(path)).status_code == 204


async def test_waiting_reads_do_not_block_actions(
    scene: Scene, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(current_tables, "MAX_WAIT_S", PATIENCE_S)
    with database_hangs(scene.station):
        reading = [asyncio.create_task(scene.commander.get("/alarms")) for _ in range(MANY_READERS)]
        async with asyncio.timeout(PATIENCE_S / 2):
            await act(scene, "POST", "/alarms/{mayday}/acknowledge", scene.seen)
        assert not any(one.done() for one in reading)
    answers = await asyncio.gather(*reading)
    assert {answer.status_code for answer in answers} == {200}


async def test_database_that_does_not_keep_up_is_read_in_its_current_state(
    scene: Scene, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(current_tables, "MAX_WAIT_S", 0.05)
    with database_hangs(scene.station):
        answer = await scene.commander.get("/incidents")
    assert [one["name"] for one in answer.json()] == ["Kitchen"]


@pytest.mark.parametrize("what", ["acknowledge", "resolve"])
async def test_an_alarm_that_is_unknown_is_distinguished_from_one_that_is_over(
    scene: Scene, clock: ManualClock, what: str
) -> None:
    for n in range(30):  # more than the picture keeps
        scene.station.drive.submit("station", ReportProblem(f"part-{n}", "It fails"))
        scene.station.drive.submit("station", ReportProblem(f"part-{n}", ""))
        clock.advance(1.0)
    of_the_picture = {one.alarm_id for one in scene.station.drive.picture().alarms}
    alarms = (await scene.commander.get("/alarms")).json()
    past = [one for one in alarms if one["alarm_id"] not in of_the_picture]
    shown = [one for one in alarms if one["state"] == "resolved" and one not in past]
    assert past
    for over in (past[0], shown[0]):
        path = f"/alarms/{over['alarm_id']}/{what}"
        refused = await scene.commander.post(path, json=scene.seen)
        assert refused.status_code == 409
        assert refused.json()["detail"] == f"no open alarm {over['alarm_id']}"
    unknown = await scene.commander.post(f"/alarms/mayday:FF-99:1/{what}", json=scene.seen)
    assert unknown.status_code == 404
    assert unknown.json()["detail"] == "There is no such alarm."


async def test_alarm_unknown_to_a_late_database_is_refused_as_not_open(
    scene: Scene, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(SqlProjection, "flush", lambda *_: False)
    refused = await scene.commander.post("/alarms/mayday:FF-99:1/acknowledge", json=scene.seen)
    assert refused.status_code == 409
    assert refused.json()["detail"] == "no open alarm mayday:FF-99:1"


@pytest.mark.parametrize(
    ("method", "path", "body"),
    [
        ("POST", "/incidents/nowhere/close", {}),
        ("PUT", "/units/FF-99", {"label": "one"}),
        ("PUT", "/units/FF-99/start", {"north_m": 1.0, "east_m": 2.0}),
        ("PUT", "/reference-barometer", {"unit_id": "FF-99"}),
    ],
)
async def test_action_on_an_unknown_object_is_not_found(
    scene: Scene, method: str, path: str, body: object
) -> None:
    answer = await scene.commander.request(method, path, json=body)
    assert answer.status_code == 404
    assert answer.json()["detail"].startswith("There is no ")


async def test_repeated_opening_after_the_close_returns_the_closed_incident(
    scene: Scene, clock: ManualClock
) -> None:
    await act(scene, "POST", "/alarms/{mayday}/resolve", scene.seen)
    await act(scene, "POST", "/incidents/{incident}/close", {"despite_unit_ids": ["FF-01"]})
    key, new = {"Idempotency-Key": "k-1"}, {"name": "Cellar"}
    first = await scene.commander.post("/incidents", json=new, headers=key)
    clock.advance(1.0)
    path = f"/incidents/{first.json()['incident_id']}"
    assert (await scene.commander.get(path)).json() == first.json()
    await scene.commander.post(f"{path}/close", json={"despite_unit_ids": ["FF-01"]})
    again = await scene.commander.post("/incidents", json=new, headers=key)
    assert (again.status_code, again.json()) == (201, (await scene.commander.get(path)).json())
    assert again.json()["closed_ms"] is not None
