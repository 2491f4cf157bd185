"""Replays over the API: owners, and rights to move and to end them."""

from __future__ import annotations

import asyncio
import dataclasses

import pytest

from base_station.accounts.principals import Role
from base_station.api.hub import Hub
from base_station.api.replays import Replays
from base_station.storage.db.models import IncidentRow
from base_station.storage.db.window import Window
from tests.rig.in_process_station import InProcessStation
from tests.rig.recording_replay import NotedReplay

INCIDENT = IncidentRow(incident_id="i-1", name="Kitchen", opened_ns=0)


@pytest.fixture
def replays(station: InProcessStation) -> Replays:
    replays = Replays(lambda *_: NotedReplay())
    station.services = dataclasses.replace(station.services, replays=replays)
    station.app.state.services = station.services
    return replays


def begun_by(replays: Replays, user: str) -> tuple[str, NotedReplay]:
    lasting = None if user else Hub()
    opened = replays.open(INCIDENT, 1.0, asyncio.get_running_loop(), user, lasting)
    assert isinstance(opened.player, NotedReplay)
    return f"/replays/{opened.replay_id}", opened.player


async def test_viewer_controls_and_ends_only_the_own_replay(
    station: InProcessStation, replays: Replays
) -> None:
    own, own_player = begun_by(replays, "viewer")
    others, others_player = begun_by(replays, "commander")
    async with station.client(Role.VIEWER) as viewer:
        listed = (await viewer.get("/replays")).json()
        assert [one["begun_by"] for one in listed] == ["viewer", "commander"]
        for refused in (
            await viewer.post(others, json={"at_ms": 5}),
            await viewer.delete(others),
        ):
            assert refused.status_code == 403
            assert "commander's" in refused.json()["detail"]
        assert (others_player.reported, others_player.closed) == ([], False)
        assert (await viewer.post(own, json={"playing": False})).status_code == 204
        assert own_player.reported == ["pause"]
        assert (await viewer.delete(own)).status_code == 204
        assert own_player.closed
    assert [one.begun_by for one in replays.all()] == ["commander"]


@pytest.mark.parametrize("role", [Role.COMMANDER, Role.ADMINISTRATOR])
async def test_commander_ends_any_replay_and_controls_only_the_own(
    station: InProcessStation, replays: Replays, role: Role
) -> None:
    others, player = begun_by(replays, "viewer")
    async with station.client(role) as commander:
        assert (await commander.post(others, json={"speed": 8.0})).status_code == 403
        assert player.reported == []
        assert (await commander.delete(others)).status_code == 204
        assert (await commander.delete(others)).status_code == 404
    (entry,) = station.services.records.audit_entries(Window(0, 2**62), 10)
    assert (entry.by, entry.action, entry.detail) == (role.word, "EndedReplay", "i-1 of viewer")


@pytest.mark.parametrize("role", [Role.VIEWER, Role.ADMINISTRATOR])
async def test_replay_of_a_replay_station_is_shared_and_cannot_be_ended(
    station: InProcessStation, replays: Replays, role: Role
) -> None:
    """There is nothing behind it: the console would show a picture that stands."""
    path, player = begun_by(replays, "")
    async with station.client(role) as client:
        assert (await client.post(path, json={"playing": True})).status_code == 204
        assert player.reported == ["play"]
        refused = await client.delete(path)
        assert refused.status_code == 403
        assert "ends with the command" in refused.json()["detail"]
    assert not player.closed


async def test_replay_belongs_to_the_user_who_starts_it(
    station: InProcessStation, replays: Replays
) -> None:
    station.app.state.loop = asyncio.get_running_loop()
    async with station.client(Role.COMMANDER) as commander:
        incident = (await commander.post("/incidents", json={"name": "Fire"})).json()
        body = {"incident_id": incident["incident_id"]}
        begun = await commander.post("/replays", json=body)
        assert (begun.status_code, begun.json()["begun_by"]) == (201, "commander")
