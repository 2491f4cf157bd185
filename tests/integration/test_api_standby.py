"""The API of a station of a pair."""

from __future__ import annotations

import dataclasses

import pytest

from base_station.accounts.principals import Role
from base_station.api.headers import content_policy
from base_station.views.wire import StandbyView
from tests.rig.in_process_station import InProcessStation

HERE, THERE = "https://b:8443", "https://a:8443"
STANDBY = StandbyView("second", "standby", HERE, "first", "active", THERE, in_step=True)


class FakeHaStatus:
    def __init__(self, refusal: str | None) -> None:
        self._refusal = refusal
        self.taken_over = 0

    def view(self) -> StandbyView:
        return STANDBY

    def refusal(self) -> str | None:
        return self._refusal

    def take_over(self) -> None:
        self.taken_over += 1


@pytest.fixture
def ha_status(station: InProcessStation) -> FakeHaStatus:
    """The station is a standby from now on."""
    ha_status = FakeHaStatus("this is the standby: the active station is first at https://a:8443")
    station.services = dataclasses.replace(station.services, ha_status=ha_status)
    station.app.state.services = station.services
    return ha_status


@pytest.mark.usefixtures("ha_status")
async def test_standby_is_readable_and_refuses_changes_with_a_reason(
    station: InProcessStation,
) -> None:
    async with station.client(Role.ADMINISTRATOR) as client:
        assert (await client.get("/units")).status_code == 200
        assert (await client.get("/standby")).json()["other_url"] == THERE
        for method, path in (("POST", "/incidents"), ("POST", "/people"), ("PUT", "/site/anchor")):
            answer = await client.request(method, path, json={})
            assert answer.status_code == 503
            assert "the active station is first at https://a:8443" in answer.json()["detail"]


@pytest.mark.usefixtures("ha_status")
async def test_people_log_in_at_a_standby(station: InProcessStation) -> None:
    async with station.client() as client:
        answer = await client.post("/login", json={"username": "viewer", "password": "x"})
    assert answer.status_code == 401  # asked for, and the password is wrong


async def test_takeover_is_for_commanders_only(
    station: InProcessStation, ha_status: FakeHaStatus
) -> None:
    for role, status in ((Role.VIEWER, 403), (Role.COMMANDER, 202)):
        async with station.client(role) as client:
            assert (await client.post("/standby/take-over")).status_code == status
    assert ha_status.taken_over == 1


async def test_console_of_the_other_station_can_query_the_leader(
    station: InProcessStation, ha_status: FakeHaStatus
) -> None:
    async with station.client() as client:
        answer = await client.get("/standby/leads", headers={"Origin": THERE})
        assert answer.json() == {"leads": False}
        assert answer.headers["access-control-allow-origin"] == "*"
        ha_status._refusal = None
        assert (await client.get("/standby/leads")).json() == {"leads": True}


async def test_single_station_has_no_standby_status(station: InProcessStation) -> None:
    async with station.client(Role.COMMANDER) as client:
        assert (await client.get("/standby")).status_code == 404


@pytest.mark.parametrize(
    ("other", "allowed"),
    [
        ("https://10.0.0.2:8443", "connect-src 'self' https://10.0.0.2:8443;"),
        ("", "connect-src 'self';"),
        ("https://x; script-src *", "connect-src 'self';"),
        ("javascript:alert(1)", "connect-src 'self';"),
    ],
)
def test_content_policy_allows_the_other_station_only(other: str, allowed: str) -> None:
    assert allowed in content_policy(other)
