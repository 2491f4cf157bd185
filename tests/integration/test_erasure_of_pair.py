"""An erasure rewrites the same records at both stations of a pair, whatever happens meanwhile."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from base_station.core.erasure.erasure_order import orders_of
from base_station.core.events import Received, event_of
from shared.messages import Header, Heartbeat
from shared.messages.station import (
    Assign,
    BeginErasure,
    CloseIncident,
    OpenIncident,
    RegisterUnit,
    Unassign,
)
from tests.rig.erasing_pair import ErasingPair, ErasingStation

UNIT, ANA, BO = "FF-01", "p-ana", "p-bo"


@pytest.fixture
def pair(tmp_path: Path) -> Iterator[ErasingPair]:
    """Ana has worn the unit, and Bo wears it; the second station has all of it."""
    pair = ErasingPair(tmp_path)
    first = pair.first
    first.take_over(1)
    first.act(RegisterUnit(UNIT, UNIT))
    first.act(Assign(UNIT, ANA))
    for _ in range(3):
        pair.live(first, UNIT, delay_s=0.25)
    first.act(Unassign(UNIT))
    first.act(Assign(UNIT, BO))
    pair.live(first, UNIT, delay_s=0.25)
    first.end_segment()
    pair.second.follow(first)
    yield pair
    pair.close()


def messages(station: ErasingStation) -> dict[int, bool]:
    """By the number of each message of the unit, whether it is erased."""
    events = [event_of(*record) for record in station.events()]
    own = [one for one in events if isinstance(one, Received) and one.unit_id == UNIT]
    numbers = [one.message.header.seq for one in own]
    assert len(numbers) == len({*numbers}), "each is there once"
    return {one.message.header.seq: isinstance(one.message, Heartbeat) for one in own}


def both_erase(pair: ErasingPair) -> None:
    """The one that leads, and then the one that follows it."""
    leader, follower = (pair.first, pair.second) if pair.first.leads else (pair.second, pair.first)
    leader.erase(ANA)
    follower.follow(leader)
    follower.erase(ANA)


def test_message_that_arrives_while_both_erase_is_the_same_at_both(pair: ErasingPair) -> None:
    first, late = pair.first, list[Header]()

    def message_of_ana() -> None:
        late.append(pair.late(first, UNIT, captured_s=4.0))

    message_of_ana()
    first.on_ordered = message_of_ana  # behind the order, before the leader's end
    first.erase(ANA)
    first.on_ordered = lambda: None
    message_of_ana()  # behind the leader's end, before the follower's
    pair.second.follow(first)
    pair.second.erase(ANA)
    assert pair.second.events() == first.events()
    erased = messages(first)
    assert [erased[one.seq] for one in late] == [True, False, False]
    both_erase(pair)
    assert pair.second.events() == first.events()
    assert all(messages(first)[one.seq] for one in late), "erased again, they go"


def test_erasure_whose_order_is_cut_off_erases_the_same_as_the_one_that_replaces_it(
    pair: ErasingPair,
) -> None:
    """A less delayed message on the branch would place the late one in Ana's time."""
    first, second = pair.first, pair.second
    late = pair.late(first, UNIT, captured_s=6.9)  # placed 0.25 s later: when Ana had returned it
    second.follow(first)
    pair.live(first, UNIT, delay_s=0.0)
    first.erase(ANA)
    before = messages(first)
    second.take_over(2)
    pair.live(second, UNIT, delay_s=0.25)
    assert first.follow(second) is not None, "its order is cut off"
    both_erase(pair)
    assert first.events() == second.events()
    assert messages(first)[late.seq] == before[late.seq]


@pytest.mark.parametrize("killed_at", range(4))
def test_erasure_killed_anywhere_at_either_station_ends_the_same(
    pair: ErasingPair, killed_at: int
) -> None:
    first, second = pair.first, pair.second
    pair.late(first, UNIT, captured_s=4.0)
    first.erase(ANA, killed_at=killed_at)
    pair.late(first, UNIT, captured_s=4.0)
    first.erase(ANA)
    second.follow(first)
    second.erase(ANA, killed_at=killed_at)
    second.erase(ANA)
    assert second.events() == first.events()
    assert [number for number, erased in messages(first).items() if erased] == [1, 2, 3, 5, 6]


def test_station_that_leads_after_a_kill_in_the_middle_erases_all(pair: ErasingPair) -> None:
    first, second = pair.first, pair.second
    first.erase(ANA, killed_at=1)
    second.take_over(2)
    pair.late(second, UNIT, captured_s=4.0)
    first.follow(second)
    both_erase(pair)
    assert first.events() == second.events()
    assert [number for number, erased in messages(first).items() if erased] == [1, 2, 3, 5]


def test_station_that_was_away_for_long_erases_the_same_when_it_is_back(pair: ErasingPair) -> None:
    first, second = pair.first, pair.second
    pair.late(first, UNIT, captured_s=4.0)
    first.erase(ANA)
    first.act(Unassign(UNIT))
    first.act(Assign(UNIT, ANA))
    pair.live(first, UNIT)
    first.end_segment()
    second.restart()
    second.follow(first)
    second.erase(ANA)
    assert second.events() == first.events()
    assert list(messages(first).values()) == [True, True, True, False, True, False]


def test_incident_that_is_open_in_the_leaders_log_comes_back_whole(pair: ErasingPair) -> None:
    """The first has closed it, alone, and erased Ana; in the second's log she is still in it."""
    first, second = pair.first, pair.second
    first.act(OpenIncident("i1", "Mill Lane"))
    first.act(Assign(UNIT, ANA))
    pair.live(first, UNIT)
    second.follow(first)
    whole = second.events()
    first.act(CloseIncident("i1"))
    first.act(Unassign(UNIT))
    first.erase(ANA)
    second.take_over(2)
    first.follow(second)
    assert first.events()[-3:] == second.events()[-3:], "a take-over must find her there"
    assert second.events()[: len(whole)] == whole
    second.act(CloseIncident("i1"))
    second.act(Unassign(UNIT))
    both_erase(pair)
    assert first.events() == second.events()
    assert list(messages(first).values()) == [True, True, True, False, True]


def test_order_stands_in_the_log_once_an_erasure(pair: ErasingPair) -> None:
    both_erase(pair)
    orders = [action for _, action in orders_of(pair.second.events())]
    assert orders == [BeginErasure("person", ANA)]
