"""Growing lists come in pages, which have every entry once."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import pytest
from sqlalchemy import select

from base_station.accounts.principals import Role
from base_station.storage.db import models
from base_station.storage.db.store import Store
from shared.clock import NS_PER_MS
from tests.rig.in_process_station import InProcessStation

INCIDENT = "i-0"
START_MS = 1_000
EVERY_MS = (5, 5, 5, 6, 7, 7, 8, 9)  # some in one millisecond, and more of them than a page has
TIMES_NS = [(START_MS + ms) * NS_PER_MS + number for number, ms in enumerate(EVERY_MS)]
LISTS = {  # path: what names an entry, and its time
    "/alarms": ("alarm_id", "raised_ms"),
    f"/incidents/{INCIDENT}/alarms": ("alarm_id", "raised_ms"),
    "/assignments": ("person_id", "from_ms"),
    "/incidents": ("incident_id", "opened_ms"),
    "/audit": ("entry_id", "t_ms"),
}
BOUNDED = {  # lists that do not grow with what happens, by what bounds them
    "people and machines": {
        "/people",
        "/units",
        "/enrolments",
        "/users",
        "/tokens",
        "/accountability",
        "/incidents/{incident_id}/members",
        "/unassigned",
        "/units/{unit_id}/sample-tokens",  # five of a unit at most
        "/guides",  # one for each rescuer
        "/units/{unit_id}/routes",  # the nearest three
    },
    "what is shown now": {"/pins", "/beacons", "/commands", "/replays", "/recordings", "/dispatch"},
    "one incident": {"/incidents/{incident_id}/tracks", "/incidents/{incident_id}/imports"},
    "the program": {"/export-formats", "/incidents/{incident_id}/thresholds"},
    "the last wishes": {"/forgettings"},
}


def fill(store: Store, times_ns: Sequence[int]) -> None:
    """One entry of each list at each of these times, and an incident that was open all along."""
    with store.write() as session:
        session.add(incident(INCIDENT, 0))
        for number, t_ns in enumerate(times_ns):
            session.add_all(entries(t_ns, str(number)))


def incident(incident_id: str, opened_ns: int) -> models.IncidentRow:
    return models.IncidentRow(
        incident_id=incident_id, name="", opened_ns=opened_ns, opened_by="", closed_by=""
    )


def entries(t_ns: int, number: str) -> list[models.Base]:
    alarm = {"rule": "heat", "priority": 1, "state": "raised", "level": "", "text": "", "by": ""}
    worn = {"person_name": "", "crew": "", "role": "", "until_ns": None}
    return [
        incident(f"i-{t_ns}", t_ns),
        models.AlarmRow(alarm_id=number, unit_id="FF-01", raised_ns=t_ns, changed_ns=t_ns, **alarm),
        models.Assignment(
            action_id=number, unit_id="FF-01", person_id=number, from_ns=t_ns, **worn
        ),
        models.AuditEntry(entry_id=number, t_ns=t_ns, by="", action="", detail=""),
    ]


@pytest.mark.parametrize("path", LISTS)
async def test_pages_contain_every_entry_once(station: InProcessStation, path: str) -> None:
    fill(station.store, TIMES_NS)
    name, time = LISTS[path]
    async with station.client(Role.ADMINISTRATOR) as client:
        everything: list[Any] = (await client.get(path)).json()
        pages: list[list[Any]] = []
        query: dict[str, int] = {"limit": 2}
        while page := (await client.get(path, params=query)).json():
            pages.append(page)
            query["until_ms"] = page[-1][time]
    assert len(everything) >= len(TIMES_NS)
    paged = [one for page in pages for one in page]
    assert [one[name] for one in paged] == [one[name] for one in everything]
    assert [one[time] for one in paged] == sorted((one[time] for one in paged), reverse=True)
    assert all(len(page) == 2 or page[1][time] == page[-1][time] for page in pages[:-1])


async def test_search_results_are_paged(station: InProcessStation) -> None:
    fill(station.store, TIMES_NS)
    async with station.client(Role.VIEWER) as client:

        async def ids(**query: str | int) -> list[str]:
            answer = await client.get("/incidents", params=query)
            return [one["incident_id"] for one in answer.json()]

        assert INCIDENT in await ids(alarm="heat"), "they were raised while it was open"
        everything = await ids(text="eng")
        assert everything == []
        with station.store.write() as session:
            for row in session.scalars(select(models.IncidentRow)):
                row.name = "Engine house"
        everything = await ids(text="eng")
        assert len(everything) == len(TIMES_NS) + 1
        assert (await ids(text="eng", limit=2, until_ms=START_MS + 9))[0] in everything[1:]
        assert await ids(text="eng", limit=1, from_ms=START_MS + 9) == everything[:1]
        for refused in ({"text": "x" * 201}, {"alarm": "a\x00"}, {"person": "\n"}):
            assert (await client.get("/incidents", params=refused)).status_code == 422


@pytest.mark.parametrize("path", LISTS)
async def test_page_without_a_limit_is_bounded(station: InProcessStation, path: str) -> None:
    fill(station.store, [(number + 1) * NS_PER_MS for number in range(150)])
    async with station.client(Role.ADMINISTRATOR) as client:
        assert len((await client.get(path)).json()) == 100
        for refused in (0, 1001):
            answer = await client.get(path, params={"limit": refused})
            assert answer.status_code == 422


async def test_every_list_is_paged_or_bounded_otherwise(station: InProcessStation) -> None:
    async with station.client() as client:
        document = (await client.get("/openapi.json")).json()
    unpaged = set()
    for path, operations in document["paths"].items():
        answer = operations.get("get", {}).get("responses", {}).get("200", {})
        schema = answer.get("content", {}).get("application/json", {}).get("schema", {})
        asks = {one["name"] for one in operations.get("get", {}).get("parameters", ())}
        if schema.get("type") == "array" and not {"limit", "until_ms"} <= asks:
            unpaged.add(path.removeprefix("/api/v1"))
    assert unpaged == set().union(*BOUNDED.values())
