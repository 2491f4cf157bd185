"""Import of people from a CSV file over the API: all or none, and repeatable."""

from __future__ import annotations

from typing import Any

import httpx

from base_station.accounts.principals import Role
from tests.rig.in_process_station import InProcessStation

_CREWS = "Name;Crew\nAda;Engine 1\nJürgen Groß;Engine 1\n"


async def import_crews(client: httpx.AsyncClient, csv: str, **query: Any) -> httpx.Response:
    return await client.post("/people/import", content=csv.encode(), params=query)


async def crews(client: httpx.AsyncClient) -> dict[str, tuple[str, str]]:
    people = (await client.get("/people")).json()
    return {one["name"]: (one["crew"], one["role"]) for one in people}


async def test_preview_and_repeated_import_change_nothing(
    station: InProcessStation,
) -> None:
    async with station.client(Role.COMMANDER) as client:
        await client.post("/people", json={"name": "ada", "crew": "Old", "role": "Officer"})
        preview = (await import_crews(client, _CREWS, preview=True)).json()
        assert [one["change"] for one in preview["people"]] == ["change", "add"]
        assert await crews(client) == {"ada": ("Old", "Officer")}
        assert (await import_crews(client, _CREWS)).status_code == 200
        after = {"ada": ("Engine 1", "Officer"), "Jürgen Groß": ("Engine 1", "")}
        assert await crews(client) == after
        again = (await import_crews(client, _CREWS)).json()
        assert [one["change"] for one in again["people"]] == ["same", "same"]
        assert await crews(client) == after


async def test_a_file_with_a_fault_adds_no_person(station: InProcessStation) -> None:
    async with station.client(Role.COMMANDER) as client:
        for _ in range(2):
            await client.post("/people", json={"name": "Ada"})
        shown = await import_crews(client, f"{_CREWS};Engine 2\n", preview=True)
        assert [one["fault_code"]["code"] for one in shown.json()["faulty_lines"]] == [
            "csv-person-ambiguous",
            "csv-name-missing",
        ]
        refused = await import_crews(client, f"{_CREWS};Engine 2\n")
        assert refused.status_code == 422
        assert refused.json()["detail"] == (
            "no person was added: line 2: Ada is the name of two people here; rename one of them "
            "first (the first of 2 faults)"
        )
        assert await crews(client) == {"Ada": ("", "")}
        many = await import_crews(client, "Name\n" + "".join(f"P {n}\n" for n in range(10_000)))
        assert "more than 2000 people" in many.json()["detail"]


async def test_wearer_is_shown_with_the_imported_crew(station: InProcessStation) -> None:
    async with station.client(Role.COMMANDER) as client:
        person = (await client.post("/people", json={"name": "Ada"})).json()
        await client.post("/units", json={"unit_id": "FF-01"})
        worn = {"unit_id": "FF-01", "person_id": person["person_id"]}
        await client.post("/assignments", json=worn)
        await import_crews(client, _CREWS)
        (unit,) = station.services.picture().units
        assert unit.person is not None
        assert unit.person.crew == "Engine 1"
