"""Input of a station's engine, before it leads and after."""

from __future__ import annotations

import pytest

from base_station.engine.feed import LiveFeed
from base_station.engine.station_clock import SteadyClock
from base_station.standby.standby_feed import StandbyFeed
from shared.channels import EVENT, POSITION, TICK, backfilled_key
from shared.clock import ManualClock
from shared.messages import STATION_ID

TICKED = TICK.key(STATION_ID)
EVENTS = [(1000, TICKED, b"event 0"), (1001, TICKED, b"event 1")]


@pytest.fixture
def feed(clock: ManualClock) -> StandbyFeed:
    return StandbyFeed(LiveFeed(SteadyClock(clock)), clock)


def test_log_of_the_other_comes_first_then_replicated_records_then_the_bus(
    feed: StandbyFeed,
) -> None:
    feed.offer(EVENT.key("u"), b"heard")
    feed.deliver(EVENTS)
    feed.lead()
    assert list(feed.take(1.0)) == EVENTS
    follows = [feed.follows]
    assert [r[1:] for r in feed.take(1.0)] == [(backfilled_key("u", EVENT.suffix), b"heard")]
    follows.append(feed.follows)
    assert follows == [True, False]
    feed.offer(POSITION.key("u"), b"live")
    assert [r[1:] for r in feed.take(1.0)] == [(POSITION.key("u"), b"live")]


def test_only_the_last_messages_of_the_bus_are_kept(feed: StandbyFeed, clock: ManualClock) -> None:
    feed.offer(EVENT.key("u"), b"long ago")
    clock.advance(31.0)
    feed.offer(EVENT.key("u"), b"just now")
    feed.lead()
    assert [payload for _, _, payload in feed.take(1.0)] == [b"just now"]


def test_only_messages_of_units_are_kept(feed: StandbyFeed) -> None:
    feed.offer(TICKED, b"forged")
    feed.offer("muster/v1/u/command/send", b"the other station said it")
    feed.lead()
    assert list(feed.take(0.0)) == []


def test_number_of_kept_messages_is_bounded(feed: StandbyFeed) -> None:
    size = 1_000_000
    for number in range(40):
        feed.offer(POSITION.key("u"), number.to_bytes(2, "big") + bytes(size))
    feed.lead()
    kept = [int.from_bytes(payload[:2], "big") for _, _, payload in feed.take(1.0)]
    assert kept == list(range(kept[0], 40)), "the newest"
    assert 10 <= len(kept) <= 17


def test_wait_for_events_can_be_woken(feed: StandbyFeed) -> None:
    feed.wake()
    assert list(feed.take(3600.0)) == []
    feed.deliver(EVENTS)
    assert list(feed.take(3600.0)) == EVENTS
