"""The reference barometer over the API: set, removed, refused, and rights."""

from __future__ import annotations

from base_station.accounts.principals import Role
from tests.rig.in_process_station import InProcessStation

PATH = "/reference-barometer"


async def test_reference_is_set_and_removed(station: InProcessStation) -> None:
    async with station.client(Role.COMMANDER) as commander:
        assert (await commander.post("/units", json={"unit_id": "REF"})).status_code == 201
        answer = await commander.put(PATH, json={"unit_id": "REF", "down_m": -1.0})
        assert answer.status_code == 204, answer.text
        assert (await commander.put(PATH, json={"unit_id": ""})).status_code == 204


async def test_invalid_reference_is_refused(station: InProcessStation) -> None:
    async with station.client(Role.COMMANDER) as commander:
        answer = await commander.put(PATH, json={"unit_id": "FF-99"})
        assert answer.status_code == 404
        assert "FF-99" in answer.text
        assert (await commander.put(PATH, json={"unit_id": "*"})).status_code == 422
    async with station.client(Role.VIEWER) as viewer:
        assert (await viewer.put(PATH, json={"unit_id": ""})).status_code == 403
