"""Addresses of the API: parameters and methods, the same on every route."""

from __future__ import annotations

import httpx
import pytest

from base_station.accounts.principals import Role
from tests.rig.api_addresses import addresses
from tests.rig.in_process_station import ORIGIN, InProcessStation

GUESSED = "nmae"  # a parameter of no route
INCIDENT = "/incidents/x"


async def refusal(client: httpx.AsyncClient, method: str, path: str) -> str:
    answer = await client.request(method, path)
    assert answer.status_code == 422, (method, path, answer.text)
    assert answer.headers["content-type"] == "application/problem+json"
    return str(answer.json()["detail"])


async def test_every_route_refuses_a_parameter_that_it_does_not_take(
    station: InProcessStation,
) -> None:
    tried = 0
    async with station.client(Role.ADMINISTRATOR) as client:
        for method, path in addresses():
            reported = await refusal(client, method, f"{path}?{GUESSED}=1")
            assert reported.startswith(f"{GUESSED} is not a parameter here"), (method, path)
            tried += 1
    assert tried > 80


@pytest.mark.parametrize(
    ("path", "reported"),
    [
        (f"{INCIDENT}/export/csv?person=Ada", "person is not a parameter here; known here: "),
        ("/alarms?limt=3", "limt is not a parameter here; did you mean limit?"),
        ("/alarms?from_s=3", "from_s is not a parameter here; its unit is another: from_ms"),
        ("/people?limit=3", "limit is not a parameter here; this address takes no parameters"),
        (
            "/people?a=1&b=2",
            "a is not a parameter here; this address takes no parameters; b is not",
        ),
    ],
)
async def test_refusal_suggests_the_probable_parameter(
    station: InProcessStation, path: str, reported: str
) -> None:
    async with station.client(Role.VIEWER) as viewer:
        assert (await refusal(viewer, "GET", path)).startswith(reported)


async def test_an_upload_with_a_wrong_parameter_is_refused_and_not_stored(
    station: InProcessStation,
) -> None:
    async with station.client(Role.COMMANDER) as commander:
        person_id = (await commander.post("/people", json={"name": "Ada"})).json()["person_id"]
        path = f"/people/{person_id}/photo"
        jpeg = {"content-type": "image/jpeg"}
        answer = await commander.put(f"{path}?crop=1", content=b"no picture", headers=jpeg)
        assert answer.status_code == 422
        assert "crop is not a parameter here" in answer.json()["detail"]
        assert (await commander.get(path)).status_code == 404


async def test_head_is_answered_wherever_get_is(station: InProcessStation) -> None:
    async with station.client(Role.ADMINISTRATOR) as client:
        assert (await client.post("/people", json={"name": "Ada"})).status_code == 201
        paths = [path for method, path in addresses() if method == "GET"]
        assert (await client.get(f"{ORIGIN}/?whatever=1")).status_code == 200
        for path in (*paths, f"{ORIGIN}/", f"{ORIGIN}/api/v1/openapi.json"):
            get, head = await client.get(path), await client.head(path)
            assert get.status_code < 500 or path == "/health", (path, get.text)
            assert head.status_code == get.status_code, path
            assert head.content == b"", path
            assert head.headers["content-type"] == get.headers["content-type"], path
            if path != "/metrics":  # whose numbers have other digits by then
                assert head.headers["content-length"] == get.headers["content-length"], path


async def test_refused_method_gets_the_allowed_ones(
    station: InProcessStation,
) -> None:
    """All of the address, though each method is a route of its own."""
    known: dict[str, set[str]] = {}
    for method, path in addresses():
        known.setdefault(path, set()).add(method)
    # A fixed path is an example of a variable one: DELETE of the pin "start" is answered.
    known["/pins/start"] = known["/pins/meeting"] = {"POST", "PUT", "DELETE"}
    known["/standby/leads"] = {"GET"}
    known["/people/import"] |= known["/people/person_id"]
    async with station.client(Role.ADMINISTRATOR) as client:
        for path, methods in known.items():
            answer = await client.request("PATCH", path)
            allowed = methods | ({"HEAD"} if "GET" in methods else set())
            assert answer.status_code == 405, path
            assert set(answer.headers["allow"].split(", ")) == allowed, path
            assert answer.headers["content-type"] == "application/problem+json", path
        page = await client.post(f"{ORIGIN}/")
        assert (page.status_code, page.headers["allow"]) == (405, "GET, HEAD")
        assert (await client.post("/nothing")).status_code == 404
