"""A journal that delivers more than its unit can have sent is fetched slowly, and reported."""

from __future__ import annotations

from base_station.core.state.message_stream import ALERTS_HZ, BYTES_PER_S, MESSAGES_HZ
from base_station.unit_sync.journal_rate_limit import (
    ALERTS_AT_ONCE,
    BYTES_AT_ONCE,
    MESSAGES_AT_ONCE,
    URGENT_BYTES_AT_ONCE,
    URGENT_BYTES_PER_S,
    JournalRateLimit,
)
from shared.clock import ManualClock


class Watch:
    def __init__(self) -> None:
        self.clock = ManualClock()
        self.share = JournalRateLimit(self.clock)
        self.known: dict[str, str] = {}

    def fetch(
        self, seconds: int, messages: int, size: int, alerts: int = 0, *, urgent: bool = False
    ) -> tuple[int, int]:
        """Messages, and bytes, fetched from a journal that always has more."""
        count = total = 0
        for _ in range(10 * seconds):
            self.clock.advance(0.1)
            if self.share.may_ask("evil", urgent=urgent):
                self.share.note("evil", messages * size, messages, alerts, urgent=urgent)
                count, total = count + messages, total + messages * size
        return count, total

    def changes(self) -> list[tuple[str, bool]]:
        reports = [(one.part, one.text) for one in self.share.changes(self.known)]
        self.known = {k: v for k, v in (self.known | dict(reports)).items() if v}
        return [(part, bool(text)) for part, text in reports]


def test_messages_of_an_hour_are_fetched_at_once() -> None:
    watch = Watch()
    count, _ = watch.fetch(18, 1000, 200)
    assert count == 180_000
    assert watch.changes() == []


def test_excess_is_fetched_no_faster_than_a_unit_may_send() -> None:
    watch = Watch()
    count, _ = watch.fetch(600, 2000, 10)
    assert MESSAGES_AT_ONCE < count < MESSAGES_AT_ONCE + 600 * MESSAGES_HZ + 2000
    assert watch.share.may_ask("anna", urgent=False)


def test_large_messages_count_by_their_bytes() -> None:
    watch = Watch()
    _, total = watch.fetch(60, 8, 60_000)
    assert 2 * total > BYTES_AT_ONCE
    assert total < BYTES_AT_ONCE + 60 * BYTES_PER_S + 480_000


def test_all_answers_to_an_alert_request_count_as_alerts() -> None:
    """Positions of a journal that marks them as urgent were not bounded at all."""
    count, _ = Watch().fetch(60, 10, 100, urgent=True)
    assert ALERTS_AT_ONCE < count < ALERTS_AT_ONCE + 60 * ALERTS_HZ + 10


def test_alerts_are_bounded_in_bytes_too() -> None:
    _, total = Watch().fetch(60, 1, 500_000, urgent=True)
    assert total < URGENT_BYTES_AT_ONCE + 60 * URGENT_BYTES_PER_S + 500_000


def test_alerts_count_separately_and_an_empty_share_of_others_delays_none() -> None:
    watch = Watch()
    count, _ = watch.fetch(60, 10, 100, alerts=10)
    assert ALERTS_AT_ONCE < count <= ALERTS_AT_ONCE + 60 * ALERTS_HZ + 10
    watch = Watch()
    watch.fetch(60, 100_000, 10)
    assert not watch.share.may_ask("evil", urgent=False)
    assert watch.share.may_ask("evil", urgent=True)


def test_ban_is_reported_with_its_name_while_it_lasts() -> None:
    watch = Watch()
    watch.fetch(60, 100_000, 10)
    [(part, is_reported)] = watch.changes()
    assert is_reported
    assert "evil's journal brings more" in watch.known[part]
    assert "muster pki revoke evil" in watch.known[part]
    assert watch.changes() == []
    watch.clock.advance(31.0)
    assert watch.changes() == [(part, False)]


def test_ban_reported_by_an_earlier_run_ends() -> None:
    watch = Watch()
    watch.known = {"journal share evil": "as told before", "disk": "another's matter"}
    assert watch.changes() == [("journal share evil", False)]
