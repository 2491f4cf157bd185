"""How often passwords can be tried, and what a try tells."""

from __future__ import annotations

import pytest
from pwdlib import PasswordHash

from base_station.api.problems import Problem
from base_station.api.security import LoginThrottle
from tests.station import PASSWORD, DeskStation


async def test_passwords_cannot_be_tried_without_end(station: DeskStation) -> None:
    async with station.client() as client:
        wrong = {"username": "commander", "password": "guess"}
        answers = [(await client.post("/login", json=wrong)) for _ in range(12)]
        assert [one.status_code for one in answers] == [401] * 10 + [429] * 2
        assert answers[-1].headers["retry-after"] == "60"
        # The name is locked from this address, whoever has the right password.
        right = {"username": "commander", "password": PASSWORD}
        assert (await client.post("/login", json=right)).status_code == 429


async def test_a_wrong_name_and_a_wrong_password_look_the_same(station: DeskStation) -> None:
    async with station.client() as client:
        one = await client.post("/login", json={"username": "commander", "password": "x"})
        other = await client.post("/login", json={"username": "nobody", "password": "x"})
    assert (one.status_code, one.json()) == (other.status_code, other.json())


async def test_a_name_that_nobody_has_costs_as_much_as_one_that_somebody_has(
    station: DeskStation, monkeypatch: pytest.MonkeyPatch
) -> None:
    """One verification of a hash that was made with the same parameters."""
    costs: list[str] = []
    verify = PasswordHash.verify

    def watched(hasher: PasswordHash, password: str, stored: str) -> bool:
        costs.append(stored.rsplit("$", 2)[0])  # kind, version and parameters
        return verify(hasher, password, stored)

    monkeypatch.setattr(PasswordHash, "verify", watched)
    async with station.client() as client:
        for name in ("commander", "nobody"):
            wrong = {"username": name, "password": "guess"}
            assert (await client.post("/login", json=wrong)).status_code == 401
    known, unknown = costs
    assert known == unknown
    assert known.startswith("$argon2id$")


@pytest.mark.parametrize(
    "addresses",
    [
        [f"2001:db8:1:2::{number:x}" for number in range(1, 13)],
        [f"fe80::{number:x}%eth0" for number in range(1, 13)],
        ["192.0.2.1", "::ffff:192.0.2.1"] * 6,
    ],
)
def test_another_address_of_one_network_is_no_way_round_the_limit(addresses: list[str]) -> None:
    throttle = LoginThrottle()
    for address in addresses[:10]:
        throttle.check(address, "commander")
    with pytest.raises(Problem):
        throttle.check(addresses[10], "commander")
    throttle.check("2001:db8:1:3::1", "commander")


async def test_headers_that_a_proxy_would_set_are_no_way_round_the_limit(
    station: DeskStation,
) -> None:
    async with station.client() as client:
        wrong = {"username": "commander", "password": "guess"}
        answers = [
            await client.post("/login", json=wrong, headers={"X-Forwarded-For": f"192.0.2.{one}"})
            for one in range(11)
        ]
    assert answers[-1].status_code == 429
