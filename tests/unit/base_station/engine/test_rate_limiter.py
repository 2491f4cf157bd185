"""Rate limit of a sender: its excess is dropped, and others lose nothing."""

from __future__ import annotations

import pytest

from base_station.core.state.message_stream import ALERTS_HZ, BYTES_PER_S, MESSAGES_HZ
from base_station.engine.rate_limiter import SenderRateLimiter
from shared.channels import COMMAND, EVENT, POSITION, STATUS
from shared.clock import ManualClock

KEY, ALERT, OTHER = POSITION.key("evil"), EVENT.key("evil"), STATUS.key("anna")


class Station:
    def __init__(self) -> None:
        self.clock = ManualClock()
        self.passed: list[str] = []
        self.known: dict[str, str] = {}
        self.start()

    def start(self) -> None:
        """Start again, with the state of the log."""
        self.share = SenderRateLimiter(lambda key, _: self.passed.append(key), self.clock)

    def offered(self, key: str, times: int, size: int = 100) -> int:
        """Number of messages that pass."""
        before = self.passed.count(key)
        for _ in range(times):
            self.share.offer(key, bytes(size))
        return self.passed.count(key) - before

    def flood(self, seconds: int) -> None:
        for _ in range(10 * seconds):
            self.clock.advance(0.1)
            self.offered(KEY, MESSAGES_HZ)

    def changes(self) -> list[tuple[str, bool]]:
        reports = list(self.share.changes(self.known))
        for one in reports:
            self.known[one.part] = one.text
            if not one.text:
                del self.known[one.part]
        return [(one.part, bool(one.text)) for one in reports]


@pytest.fixture
def station() -> Station:
    return Station()


def test_messages_beyond_the_share_are_dropped_and_those_of_others_kept(station: Station) -> None:
    assert station.offered(KEY, 10_000) == MESSAGES_HZ
    assert station.offered(OTHER, 50) == 50
    station.clock.advance(0.5)
    assert station.offered(KEY, 10_000) == MESSAGES_HZ // 2
    station.clock.advance(3600.0)
    assert station.offered(KEY, 10_000) == MESSAGES_HZ


def test_alerts_have_a_share_of_their_own(station: Station) -> None:
    station.offered(KEY, 10_000)
    assert station.offered(ALERT, 1000) == ALERTS_HZ


def test_bytes_count_too(station: Station) -> None:
    assert station.offered(KEY, 100, size=50_000) == BYTES_PER_S // 50_000


def test_messages_to_a_unit_do_not_count_as_its_own(station: Station) -> None:
    station.offered(KEY, 10_000)
    assert station.offered(COMMAND.key("evil"), 1000) == 1000


def test_key_without_unit_has_a_share(station: Station) -> None:
    assert station.offered("muster/v1", 10_000) == MESSAGES_HZ


def test_unit_at_the_usual_rate_is_never_limited(station: Station) -> None:
    for _ in range(1000):
        station.clock.advance(0.1)
        assert station.offered(KEY, 5, size=1000) == 5
    station.clock.advance(5.0)
    assert station.offered(KEY, 250, size=1000) == 250, "what a link has held up"
    assert station.changes() == []


def test_flood_is_reported_once_and_so_is_its_end(station: Station) -> None:
    station.offered(KEY, 10_000)
    assert station.changes() == [], "one burst"
    station.flood(5)
    assert station.changes() == [("flood evil", True)]
    station.flood(5)
    assert station.changes() == []
    station.clock.advance(10.0)
    assert station.changes() == [], "it may go on"
    station.clock.advance(30.0)
    assert station.changes() == [("flood evil", False)]
    assert station.changes() == []


def test_flood_reported_before_a_restart_ends_as_well(station: Station) -> None:
    station.known["log"] = "the disk is full"
    station.flood(5)
    assert station.changes() == [("flood evil", True)]
    station.start()
    station.flood(5)
    assert station.changes() == [], "it goes on, and is known"
    station.start()
    assert station.changes() == []
    station.clock.advance(25.0)
    assert station.changes() == []
    station.clock.advance(10.0)
    assert station.changes() == [("flood evil", False)]
    assert station.known == {"log": "the disk is full"}
    assert station.changes() == []


def test_dismissed_flood_is_not_reported_again_while_it_lasts(
    station: Station,
) -> None:
    station.flood(5)
    assert station.changes() == [("flood evil", True)]
    station.known.clear()
    station.flood(5)
    assert station.changes() == []


def test_bursts_far_apart_are_no_flood(station: Station) -> None:
    for _ in range(10):
        station.offered(KEY, 2 * MESSAGES_HZ)
        station.clock.advance(5.0)
    assert station.changes() == []


def test_any_number_of_senders_costs_bounded_memory(station: Station) -> None:
    for number in range(5000):
        station.share.offer(POSITION.key(f"s{number}"), b"")
    assert len(station.share._senders) <= 2000
