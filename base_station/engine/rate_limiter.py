"""Rate limiter for each sender, so that a flooding sender delays no other.

A unit sends about fifty messages a second.  What is far beyond that never reaches the feed, and so
costs neither log nor processing.  An honest unit loses nothing by it: the messages are fetched from
its journal.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

from base_station.core.state.message_stream import ALERTS_HZ, BYTES_PER_S, MESSAGES_HZ
from base_station.process.token_bucket import TokenBucket
from shared.clock import NS_PER_S, Clock
from shared.coded_text import coded
from shared.messages.station import ReportProblem

BURST_S = 1.0  # so much may come at once, after a link was held up
_REPORT_AFTER_NS = 3 * NS_PER_S  # of excess: one burst is no problem
_PAUSE_NS = 2 * NS_PER_S  # without any that is too much: it begins anew
_OVER_AFTER_NS = 30 * NS_PER_S
_MOST_SENDERS = 2000  # that are kept apart; on a bus without certificates there may be any number
_PART = "flood "  # and the sender


class _Sender:
    """Token buckets of one sender."""

    __slots__ = ("alerts", "bytes", "messages")

    def __init__(self, now_ns: int) -> None:
        self.messages = TokenBucket(MESSAGES_HZ, MESSAGES_HZ * BURST_S, now_ns)
        self.alerts = TokenBucket(ALERTS_HZ, ALERTS_HZ * BURST_S, now_ns)
        self.bytes = TokenBucket(BYTES_PER_S, BYTES_PER_S * BURST_S, now_ns)


class SenderRateLimiter:
    """Limiter that passes on the messages within the limits of their sender."""

    def __init__(self, offer: Callable[[str, bytes], None], clock: Clock) -> None:
        self._offer = offer
        self._clock = clock
        self._senders: dict[str, _Sender] = {}
        self._over_limit: dict[str, tuple[int, int]] = {}  # since when, and when last; monotonic
        self._reported: set[str] = set()

    def offer(self, key: str, payload: bytes) -> None:
        """Callback for a bus, from one thread at a time; the key is ``muster/v1/SENDER/...``."""
        parts = key.split("/", 3)
        what = parts[-1]
        if what.startswith("command/"):  # sent to a unit, not by it
            self._offer(key, payload)
            return
        now_ns = self._clock.monotonic_ns()
        sender_id = parts[2] if len(parts) == 4 else ""
        sender = self._senders.get(sender_id) or self._new(sender_id, now_ns)
        share = sender.alerts if what.startswith("alert/") else sender.messages
        if share.take(1, now_ns) and sender.bytes.take(len(payload), now_ns):
            self._offer(key, payload)
            return
        since_ns, last_ns = self._over_limit.get(sender_id, (now_ns, now_ns))
        self._over_limit[sender_id] = now_ns if now_ns - last_ns > _PAUSE_NS else since_ns, now_ns

    def changes(self, known: Mapping[str, str]) -> Iterator[ReportProblem]:
        """Return reports on senders that now exceed their share, or that have kept it again for
        long.  For one thread.

        ``known``: problems that stand reported, by part; reports of an earlier run of the program,
        or of the other of two stations, end here too.
        """
        now_ns = self._clock.monotonic_ns()
        for sender_id in [one.removeprefix(_PART) for one in list(known) if one.startswith(_PART)]:
            self._reported.add(sender_id)
            self._over_limit.setdefault(sender_id, (now_ns, now_ns))
        for sender_id, (since_ns, last_ns) in list(self._over_limit.items()):
            part = f"{_PART}{sender_id}"
            if now_ns - last_ns >= _OVER_AFTER_NS:
                self._over_limit.pop(sender_id, None)
                if sender_id in self._reported:
                    self._reported.remove(sender_id)
                    yield ReportProblem(part, "")
            elif sender_id not in self._reported and last_ns - since_ns >= _REPORT_AFTER_NS:
                self._reported.add(sender_id)
                yield ReportProblem.of(part, _text(sender_id))

    def _new(self, sender_id: str, now_ns: int) -> _Sender:
        if len(self._senders) >= _MOST_SENDERS:
            self._senders.clear()
            self._over_limit = {
                one: when for one, when in self._over_limit.items() if one in self._reported
            }
        sender = self._senders[sender_id] = _Sender(now_ns)
        return sender


def _text(sender_id: str) -> str:
    return coded(
        "sender-floods",
        "{sender_id} sends more than any unit does (over {most} messages or {most_mb:g} MB a "
        "second): what is too much is dropped. Switch it off, or revoke it: muster pki revoke "
        "{sender_id}",
        sender_id=sender_id,
        most=MESSAGES_HZ,
        most_mb=BYTES_PER_S / 1e6,
    )
