"""How often passwords can be tried, and what a try tells."""

from __future__ import annotations

import time
from collections.abc import Callable

import pytest
from pwdlib import PasswordHash

from base_station.accounts.principals import Role
from base_station.api.problems import Problem
from base_station.api.security import LoginThrottle
from base_station.api.tries import Tries
from tests.station import ORIGIN, PASSWORD, DeskStation

HERE = "192.0.2.1"


class Seconds:
    """A clock that nobody sets."""

    def __init__(self) -> None:
        self.now_s = 1000.0

    def __call__(self) -> float:
        return self.now_s


def refused(check: Callable[[], None]) -> bool:
    try:
        check()
    except Problem as problem:
        return problem.status_code == 429
    return False


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


def test_a_minute_later_it_may_be_tried_again_though_the_machines_time_was_put_right(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    seconds, wall_s = Seconds(), time.time()
    throttle = LoginThrottle(seconds)
    for _ in range(10):
        throttle.check(HERE, "commander")
        seconds.now_s += 1.0
    monkeypatch.setattr(time, "time", lambda: wall_s - 86_400.0)
    seconds.now_s = 1059.9
    assert refused(lambda: throttle.check(HERE, "commander"))
    seconds.now_s = 1060.0  # the first of the ten is over, and no other
    throttle.check(HERE, "commander")
    assert refused(lambda: throttle.check(HERE, "commander"))


def test_who_tries_one_name_without_end_locks_out_no_other_of_the_place() -> None:
    throttle = LoginThrottle(Seconds())
    for _ in range(100):
        refused(lambda: throttle.check(HERE, "dispatch"))
    throttle.check(HERE, "commander")


def test_all_names_of_a_place_together_have_their_limit() -> None:
    throttle = LoginThrottle(Seconds())
    for number in range(60):
        throttle.check(HERE, f"user {number}")
    assert refused(lambda: throttle.check(HERE, "commander"))
    assert refused(lambda: throttle.check_place(HERE))
    throttle.check("192.0.2.2", "commander")


def test_what_was_tried_long_ago_takes_no_memory() -> None:
    seconds = Seconds()
    tries = Tries(10, 60.0, seconds)
    for number in range(100):
        tries.note(f"user {number}")
        tries.note("somebody who tries all the time")
        seconds.now_s += 6.0
    assert len(tries) <= 11


async def test_all_consoles_of_a_place_go_on_at_the_other_station_at_once(
    station: DeskStation,
) -> None:
    accounts = station.services.accounts
    session = accounts.log_in("commander", PASSWORD) or ""
    async with station.client() as client:
        client.headers["origin"] = ORIGIN
        for _ in range(70):
            ticket = {"ticket": accounts.hand_over(session)}
            assert (await client.post("/login/hand-over", json=ticket)).status_code == 200
            client.cookies.clear()
        wrong = {"ticket": "guess"}
        answers = [await client.post("/login/hand-over", json=wrong) for _ in range(61)]
    assert [one.status_code for one in answers] == [401] * 60 + [429]


async def test_an_old_password_cannot_be_guessed_without_end(station: DeskStation) -> None:
    guess = {"old_password": "guess", "new_password": f"{PASSWORD} 2"}
    async with station.client(Role.VIEWER) as client:
        answers = [await client.post("/me/password", json=guess) for _ in range(11)]
    assert [one.status_code for one in answers] == [403] * 10 + [429]
