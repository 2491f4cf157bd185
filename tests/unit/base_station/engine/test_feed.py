"""Live feed: station time, order and bounds."""

from __future__ import annotations

from threading import Thread

import pytest

from base_station.engine.feed import LiveFeed
from base_station.engine.station_clock import SteadyClock
from shared.channels import EVENT, POSITION
from shared.clock import NS_PER_S, ManualClock

KEY = POSITION.key("anna")
ALERT = EVENT.key("anna")
DAY_NS = 86_400 * NS_PER_S


class JumpingClock(ManualClock):
    """A clock whose UTC a person sets."""

    def __init__(self) -> None:
        super().__init__()
        self.set_by_ns = 0

    def utc_ns(self) -> int:
        return super().utc_ns() + self.set_by_ns


def test_records_come_out_in_order_with_station_time() -> None:
    machine = JumpingClock()
    feed = LiveFeed(SteadyClock(machine))
    t0_ns = machine.utc_ns()
    feed.offer(KEY, b"1")
    machine.advance(1.0)
    machine.set_by_ns = -DAY_NS
    feed.offer(KEY, b"2")
    assert feed.take(0.0) == [(t0_ns, KEY, b"1"), (t0_ns + NS_PER_S, KEY, b"2")]
    assert feed.take(0.0) == []


def test_take_waits_for_a_message_from_another_thread() -> None:
    feed = LiveFeed(ManualClock())
    sender = Thread(target=feed.offer, args=(KEY, b"1"))
    sender.start()
    assert [payload for _, _, payload in feed.take(60.0)] == [b"1"]
    sender.join()


def test_wake_ends_the_wait_even_if_it_came_first() -> None:
    feed = LiveFeed(ManualClock())
    feed.wake()
    assert feed.take(60.0) == []


def test_live_data_beyond_the_bound_is_dropped_and_counted_but_alerts_are_not() -> None:
    feed = LiveFeed(ManualClock(), records_max=3)
    for number in range(5):
        feed.offer(KEY, bytes([number]))
    for number in range(5):
        feed.offer(ALERT, bytes([number]))
    taken = feed.take(0.0)
    assert [key for _, key, _ in taken] == [KEY] * 3 + [ALERT] * 3
    assert feed.overflowed == 4
    feed.offer(KEY, b"")
    assert len(feed.take(0.0)) == 1


def test_overflow_is_reported_while_it_lasts_and_for_a_minute() -> None:
    clock = ManualClock()
    feed = LiveFeed(clock, records_max=1)
    reported = []
    for later_s in (0.0, 59.0, 61.0, 0.0):  # the first one has room
        feed.offer(KEY, b"")
        clock.advance(later_s)
        reported.append(feed.overflows)
    assert reported == [False, True, False, True]
    assert feed.overflowed == 3


def test_bound_holds_for_bytes_too() -> None:
    feed = LiveFeed(ManualClock(), bytes_max=100)
    for _ in range(10):
        feed.offer("elsewhere", bytes(60))
    assert len(feed.take(0.0)) == 2
    assert feed.overflowed == 8


def payloads_of(records: list[tuple[int, str, bytes]]) -> list[bytes]:
    return [payload for _, _, payload in records]


def deliver(feed: LiveFeed, count: int) -> None:
    for _ in range(count):
        feed.deliver(KEY, b"late")


def test_live_records_go_first_and_deferred_ones_follow_in_portions() -> None:
    feed = LiveFeed(ManualClock())
    late = [number.to_bytes(2) for number in range(100)]
    for payload in late:
        feed.deliver(KEY, payload)
    feed.offer(KEY, b"live 1")
    first = payloads_of(feed.take(60.0))
    assert feed.late_waits  # it is in no log yet
    feed.offer(KEY, b"live 2")
    second = payloads_of(feed.take(60.0))
    assert [first[0], second[0]] == [b"live 1", b"live 2"]
    assert 1 < len(first) < 50
    assert first[1:] + second[1:] == late[: len(first) + len(second) - 2]


def test_station_time_never_goes_back_between_live_and_deferred_records() -> None:
    machine = ManualClock()
    feed = LiveFeed(machine)
    taken: list[tuple[int, str, bytes]] = []
    for _ in range(100):
        feed.deliver(KEY, b"late")
        machine.advance(0.001)
        feed.offer(KEY, b"live")
        machine.advance(0.001)
        taken += feed.take(0.0)
    times_ns = [t_ns for t_ns, _, _ in taken]
    assert times_ns == sorted(times_ns)
    assert payloads_of(taken).count(b"late") == payloads_of(taken).count(b"live") == 100


def test_sender_of_deferred_records_waits_and_takes_no_room_from_live_ones() -> None:
    feed = LiveFeed(ManualClock(), records_max=10)
    count = 5000
    bringing = Thread(target=deliver, args=(feed, count))
    bringing.start()
    taken: list[bytes] = []
    for _ in range(100):
        feed.offer(KEY, b"live")
        taken += payloads_of(feed.take(60.0))
    while len(taken) < count + 100:
        taken += payloads_of(feed.take(60.0))
    bringing.join()
    assert feed.overflowed == 0
    assert taken.count(b"late") == count


@pytest.mark.parametrize("key", [KEY, ALERT])
def test_delivered_record_is_pending_until_the_next_take(key: str) -> None:
    """It is in no log before: it must not count as stored."""
    feed = LiveFeed(ManualClock())
    waited = [feed.late_waits]
    feed.deliver(key, b"fetched")
    waited.append(feed.late_waits)
    feed.take(60.0)
    waited.append(feed.late_waits)
    feed.take(0.0)
    waited.append(feed.late_waits)
    assert waited == [False, True, True, False]


def test_record_delivered_meanwhile_waits_too() -> None:
    feed = LiveFeed(ManualClock())
    feed.deliver(KEY, b"fetched")
    feed.take(60.0)
    feed.deliver(KEY, b"while that is dealt with")
    feed.take(60.0)
    assert feed.late_waits
    feed.take(0.0)
    assert not feed.late_waits


def test_fetched_alert_waits_behind_no_deferred_record() -> None:
    feed = LiveFeed(ManualClock())
    for _ in range(100):
        feed.deliver(KEY, b"late")
    feed.deliver(ALERT, b"fell")
    assert payloads_of(feed.take(60.0))[0] == b"fell"


def test_closed_feed_releases_waiting_senders() -> None:
    feed = LiveFeed(ManualClock())
    bringing = Thread(target=deliver, args=(feed, 5000))
    bringing.start()
    feed.close()
    bringing.join()
