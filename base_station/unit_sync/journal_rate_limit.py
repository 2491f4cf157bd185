"""Rate limit on messages from a unit's journal, so that one unit fills neither the log nor its
disk.  ``engine.rate_limiter`` bounds live messages.  A journal may send at once the messages of
some hours; beyond that it is queried at the rate of live messages.  Nothing is lost: the rest is
queried later.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from threading import Lock

from base_station.core.state.message_stream import ALERTS_HZ, BYTES_PER_S, MESSAGES_HZ
from base_station.process.token_bucket import TokenBucket
from shared.clock import NS_PER_S, Clock
from shared.coded_text import coded
from shared.messages.station import ReportProblem

MESSAGES_AT_ONCE = 250_000
BYTES_AT_ONCE = 64_000_000
ALERTS_AT_ONCE = 500
URGENT_BYTES_AT_ONCE, URGENT_BYTES_PER_S = 4_000_000, 200_000  # an alert has some hundred
_REPORTED_AFTER_NS = 3 * NS_PER_S  # of waiting
_OVER_AFTER_NS = 30 * NS_PER_S
_PART = "journal share "  # and the unit


class _Unit:
    """Remaining share of one journal."""

    __slots__ = ("alerts", "bytes", "messages", "urgent_bytes")

    def __init__(self, now_ns: int) -> None:
        self.messages = TokenBucket(MESSAGES_HZ, MESSAGES_AT_ONCE, now_ns)
        self.bytes = TokenBucket(BYTES_PER_S, BYTES_AT_ONCE, now_ns)
        self.alerts = TokenBucket(ALERTS_HZ, ALERTS_AT_ONCE, now_ns)
        self.urgent_bytes = TokenBucket(URGENT_BYTES_PER_S, URGENT_BYTES_AT_ONCE, now_ns)


class JournalRateLimit:
    """Limits of all units; one thread fetches, another may read the changes."""

    def __init__(self, clock: Clock) -> None:
        self._clock = clock
        self._units: dict[str, _Unit] = {}
        self._lock = Lock()
        self._waits: dict[str, tuple[int, int]] = {}  # since when, and when last; monotonic

    def note(
        self, unit_id: str, came_bytes: int, messages: int, alerts: int, *, urgent: bool
    ) -> None:
        """One reply of a journal: its kept messages, and all its bytes.  ``urgent``: alerts were
        asked for; all other messages in it count as such, or they would not be bounded.
        """
        now_ns, unit = self._clock.monotonic_ns(), self._unit(unit_id)
        if urgent:
            alerts = messages
            unit.urgent_bytes.spend(came_bytes, now_ns)
        unit.bytes.spend(came_bytes, now_ns)
        unit.messages.spend(messages, now_ns)
        unit.alerts.spend(alerts, now_ns)

    def may_ask(self, unit_id: str, *, urgent: bool) -> bool:
        """``urgent``: for alerts only, which have a share of their own."""
        now_ns, unit = self._clock.monotonic_ns(), self._unit(unit_id)
        of_alerts = (unit.alerts, unit.urgent_bytes)
        shares = of_alerts if urgent else (unit.alerts, unit.messages, unit.bytes)
        if not any(share.wait_s(now_ns) for share in shares):
            return True
        with self._lock:
            since_ns, _ = self._waits.get(unit_id, (now_ns, now_ns))
            self._waits[unit_id] = since_ns, now_ns
        return False

    def changes(self, known: Mapping[str, str]) -> Iterator[ReportProblem]:
        """Units whose journal begins to be held back, and units whose is no longer.

        ``known``: the problems that stand reported, by part, perhaps by an earlier run.
        """
        now_ns = self._clock.monotonic_ns()
        with self._lock:
            over = [who for who, (_, last) in self._waits.items() if now_ns - last > _OVER_AFTER_NS]
            for unit_id in over:
                del self._waits[unit_id]
            throttled = [
                who
                for who, (since, last) in self._waits.items()
                if last - since >= _REPORTED_AFTER_NS
            ]
        parts = {f"{_PART}{unit_id}": _text(unit_id) for unit_id in throttled}
        for part, text in parts.items():
            if part not in known:
                yield ReportProblem.of(part, text)
        for part in [one for one in known if one.startswith(_PART) and one not in parts]:
            yield ReportProblem(part, "")

    def _unit(self, unit_id: str) -> _Unit:
        unit = self._units.get(unit_id)
        if unit is None:
            unit = self._units[unit_id] = _Unit(self._clock.monotonic_ns())
        return unit


def _text(unit_id: str) -> str:
    return coded(
        "journal-floods",
        "{unit_id}'s journal brings more than a unit sends in hours ({most:,} messages, "
        "{most_mb:.0f} MB or {most_alerts} alerts): the rest is fetched slowly. If it was not out "
        "of reach for long, switch it off, or revoke it: muster pki revoke {unit_id}",
        unit_id=unit_id,
        most=MESSAGES_AT_ONCE,
        most_mb=BYTES_AT_ONCE / 1e6,
        most_alerts=ALERTS_AT_ONCE,
    )
