"""Admission of connections to the bus: who is accepted, which connection is closed first, and
reports.
"""

from __future__ import annotations

import asyncio

import pytest

from base_station.security.router.admission import ConnectionAdmission, LinkRates
from base_station.security.router.pending import PendingConnections, RoundRobin
from base_station.security.router.refusals import Refusal, Refusals, RefusalSummary, refusal_problem
from shared.enrolment import Holder
from shared.tls import TlsIdentity

NOBODY = TlsIdentity(b"", b"", b"")


async def never() -> None:
    await asyncio.Event().wait()


def new_task() -> asyncio.Task[None]:
    return asyncio.get_running_loop().create_task(never())


@pytest.mark.asyncio
async def test_oldest_connection_of_the_largest_network_is_closed_beyond_the_limit() -> None:
    pending = PendingConnections(max_count=4)
    alone, first, second, third = (new_task() for _ in range(4))
    assert pending.add("10.0.0.1", alone) is None
    for task in (first, second, third):
        assert pending.add("10.0.0.2", task) is None
    assert pending.add("10.0.0.3", new_task()) is first
    assert pending.add("10.0.0.2", new_task()) is second
    pending.remove("10.0.0.2", second)  # has closed already
    assert len(pending) == 4


@pytest.mark.asyncio
async def test_networks_take_turns_however_many_connections_wait() -> None:
    turns = RoundRobin(asyncio.get_running_loop())
    order: list[str] = []

    async def step(network: str) -> None:
        await turns.wait(network)
        order.append(network)

    async with asyncio.TaskGroup() as group:
        for _ in range(50):
            group.create_task(step("10.0.0.2"))
        group.create_task(step("10.0.0.1"))
    assert "10.0.0.1" in order[:2]
    assert len(order) == 51


@pytest.mark.asyncio
async def test_closed_connection_takes_no_turn() -> None:
    turns = RoundRobin(asyncio.get_running_loop())
    gone = asyncio.get_running_loop().create_task(turns.wait("10.0.0.1"))
    await asyncio.sleep(0)
    gone.cancel()
    await asyncio.wait_for(turns.wait("10.0.0.1"), 1.0)


def test_only_enrolled_clients_have_links_and_a_unit_few() -> None:
    admission = ConnectionAdmission(NOBODY, {"anna": Holder.UNIT, "station:base": Holder.STATION})
    assert admission.max_links("ben") == 0
    assert 2 <= admission.max_links("anna") < admission.max_links("station:base")


def test_client_that_opens_links_without_end_is_slowed() -> None:
    rates = LinkRates()
    opened = sum(rates.take_token("anna", 0.01 * turn) for turn in range(1000))
    assert 30 <= opened <= 40
    assert rates.take_token("ben", 10.0)
    assert rates.take_token("anna", 20.0)


def test_banned_client_may_return() -> None:
    rates = LinkRates()
    rates.ban("anna", 60.0)
    assert rates.is_banned("anna", 59.0)
    assert not rates.is_banned("ben", 59.0)
    assert not rates.is_banned("anna", 60.0)


def test_minute_of_refusals_is_reported_and_ends() -> None:
    refusals = Refusals()
    assert refusal_problem(refusals.summary(0.0)) == ""
    for number in range(200):
        refusals.add(Refusal.NOT_TLS, "10.0.0.7", 0.1 * number)
    refusals.add(Refusal.SILENT, "10.0.0.8", 19.0)
    assert refusals.summary(20.0) == RefusalSummary(
        201, 201, Refusal.NOT_TLS.value, "10.0.0.7", 200
    )
    problem = refusal_problem(refusals.summary(20.0))
    assert "201 connections" in problem
    assert "200 of them from 10.0.0.7" in problem
    assert refusals.summary(90.0) == RefusalSummary(201)
    assert refusal_problem(refusals.summary(90.0)) == ""


def test_addresses_beyond_the_limit_are_counted_together() -> None:
    refusals = Refusals()
    for number in range(10_000):
        refusals.add(Refusal.SILENT, f"10.0.{number // 250}.{number % 250}", 1.0)
    assert refusals.summary(2.0).network == "other addresses"
