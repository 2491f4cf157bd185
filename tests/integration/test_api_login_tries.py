"""Limits of login attempts, and their answers."""

from __future__ import annotations

import asyncio
import threading
import time
from collections.abc import Callable
from functools import partial

import pytest
from pwdlib import PasswordHash

from base_station.accounts.principals import Role
from base_station.api.admission import LoginQueue
from base_station.api.attempt_limiter import AttemptLimiter
from base_station.api.login_throttle import LoginThrottle
from base_station.api.problems import Problem
from base_station.storage.db.records import Records
from tests.rig.in_process_station import ORIGIN, PASSWORD, InProcessStation

HERE = "192.0.2.1"


class SteppedClock:
    """A clock that nobody sets."""

    def __init__(self) -> None:
        self.now_s = 1000.0

    def __call__(self) -> float:
        return self.now_s


def refused(check: Callable[[], object]) -> bool:
    try:
        check()
    except Problem as problem:
        return problem.status_code == 429
    return False


async def test_login_attempts_are_limited(station: InProcessStation) -> None:
    async with station.client() as client:
        wrong = {"username": "commander", "password": "guess"}
        answers = [(await client.post("/login", json=wrong)) for _ in range(12)]
        assert [one.status_code for one in answers] == [401] * 10 + [429] * 2
        assert answers[-1].headers["retry-after"] == "60"
        # The name is locked from this address, whoever has the right password.
        right = {"username": "commander", "password": PASSWORD}
        assert (await client.post("/login", json=right)).status_code == 429


async def test_wrong_name_and_wrong_password_get_the_same_answer(station: InProcessStation) -> None:
    async with station.client() as client:
        one = await client.post("/login", json={"username": "commander", "password": "x"})
        other = await client.post("/login", json={"username": "nobody", "password": "x"})
    assert (one.status_code, one.json()) == (other.status_code, other.json())


async def test_unknown_name_takes_the_same_time_as_a_known_one(
    station: InProcessStation, monkeypatch: pytest.MonkeyPatch
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
def test_limit_holds_for_all_addresses_of_a_network(addresses: list[str]) -> None:
    throttle = LoginThrottle()
    for address in addresses[:10]:
        throttle.check(address, "commander")
    with pytest.raises(Problem):
        throttle.check(addresses[10], "commander")
    throttle.check("2001:db8:1:3::1", "commander")


async def test_limit_ignores_proxy_headers(
    station: InProcessStation,
) -> None:
    async with station.client() as client:
        wrong = {"username": "commander", "password": "guess"}
        answers = [
            await client.post("/login", json=wrong, headers={"X-Forwarded-For": f"192.0.2.{one}"})
            for one in range(11)
        ]
    assert answers[-1].status_code == 429


def test_limit_ends_after_a_minute_independent_of_the_wall_clock(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    seconds, wall_s = SteppedClock(), time.time()
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


def test_limit_of_a_name_blocks_no_other_name_of_the_network() -> None:
    throttle = LoginThrottle(SteppedClock())
    for _ in range(100):
        refused(lambda: throttle.check(HERE, "dispatch"))
    throttle.check(HERE, "commander")


def test_all_names_of_a_network_share_a_limit() -> None:
    throttle = LoginThrottle(SteppedClock())
    for number in range(60):
        throttle.check(HERE, f"user {number}")
    assert refused(lambda: throttle.check(HERE, "commander"))
    assert refused(lambda: throttle.check_network(HERE))
    throttle.check("192.0.2.2", "commander")


def test_old_attempts_are_removed_from_memory() -> None:
    seconds = SteppedClock()
    tries = AttemptLimiter(10, 60.0, seconds)
    for number in range(100):
        tries.record(f"user {number}")
        tries.record("somebody who tries all the time")
        seconds.now_s += 6.0
    assert len(tries) <= 11


async def test_login_transfers_are_limited_separately(
    station: InProcessStation,
) -> None:
    accounts = station.services.accounts
    session = accounts.log_in("commander", PASSWORD) or ""
    async with station.client() as client:
        client.headers["origin"] = ORIGIN
        for _ in range(70):
            ticket = {"ticket": accounts.create_login_ticket(session)}
            assert (await client.post("/login/hand-over", json=ticket)).status_code == 200
            client.cookies.clear()
        wrong = {"ticket": "guess"}
        answers = [await client.post("/login/hand-over", json=wrong) for _ in range(61)]
    assert [one.status_code for one in answers] == [401] * 60 + [429]


async def test_attempts_at_the_old_password_are_limited(station: InProcessStation) -> None:
    guess = {"old_password": "guess", "new_password": f"{PASSWORD} 2"}
    async with station.client(Role.VIEWER) as client:
        answers = [await client.post("/me/password", json=guess) for _ in range(11)]
    assert [one.status_code for one in answers] == [403] * 10 + [429]


def test_name_has_a_limit_over_all_networks() -> None:
    throttle = LoginThrottle(SteppedClock())
    for number in range(30):
        throttle.check(f"192.0.2.{number}", "commander")
    assert refused(lambda: throttle.check("192.0.2.99", "commander"))
    throttle.check("192.0.2.99", "viewer")


def test_known_network_can_log_in_while_others_guess() -> None:
    throttle = LoginThrottle(SteppedClock())
    assert throttle.check(HERE, "commander") is False
    throttle.record_login(HERE, "commander")
    for number in range(100, 140):
        refused(partial(throttle.check, f"192.0.2.{number}", "commander"))
    assert throttle.check(HERE, "commander") is True
    for _ in range(8):  # the limits of the place hold
        throttle.check(HERE, "commander")
    assert refused(lambda: throttle.check(HERE, "commander"))


async def test_blocked_network_is_refused_before_its_request_is_read(
    station: InProcessStation,
) -> None:
    throttle: LoginThrottle = station.app.state.login_throttle
    for number in range(60):
        throttle.check("127.0.0.1", f"user {number}")
    async with station.client() as client:
        answer = await client.post("/login", content=b"no JSON")
    assert answer.status_code == 429
    assert (answer.headers["retry-after"], answer.headers["connection"]) == ("60", "close")


async def test_waiting_logins_are_limited_with_places_for_known_networks() -> None:
    queue, go = LoginQueue(), threading.Event()
    held = [asyncio.create_task(queue.run(go.wait, is_known=False)) for _ in range(6)]
    await asyncio.sleep(0)
    with pytest.raises(Problem) as refusal:
        await queue.run(go.wait, is_known=False)
    assert (refusal.value.status_code, refusal.value.headers) == (503, {"Retry-After": "5"})
    known = asyncio.create_task(queue.run(go.wait, is_known=True))
    await asyncio.sleep(0)
    go.set()
    assert await asyncio.gather(*held, known) == [True] * 7
    queue.close()


async def test_large_reads_do_not_use_all_threads(
    station: InProcessStation, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The framework has forty of them for all routes."""
    station.hub.connect(asyncio.get_running_loop(), station.drive)
    go = threading.Event()
    monkeypatch.setattr(Records, "incident", lambda *_: go.wait() and None)
    async with station.client(Role.COMMANDER) as client:
        path = "/incidents/x/trails"
        reading = [asyncio.create_task(client.get(path)) for _ in range(50)]
        await asyncio.sleep(0.1)
        async with asyncio.timeout(10.0):
            assert (await client.post("/units", json={"unit_id": "FF-01"})).status_code == 201
        go.set()
        assert {one.status_code for one in await asyncio.gather(*reading)} == {404}
