"""What one sender may say, so that one that runs wild holds up no other.

A unit says some fifty messages a second.  What is far beyond that never reaches the feed: it costs
no log and no step.  From an honest unit it comes all the same, out of its journal.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

from shared.clock import NS_PER_S, Clock
from shared.messages.station import ReportProblem

MESSAGES_HZ = 400
ALERTS_HZ = 20  # of their own: a mayday comes through whatever else its unit says
BYTES_PER_S = 1_000_000
BURST_S = 1.0  # so much may come at once: what a link has held up
_TOLD_AFTER_NS = 3 * NS_PER_S  # of being beyond it: one burst is no matter
_PAUSE_NS = 2 * NS_PER_S  # without any that is too much: it begins anew
_OVER_AFTER_NS = 30 * NS_PER_S
_MOST_SENDERS = 2000  # that are told apart; on a bus without certificates there may be any number
_PART = "flood "  # and whose
_TEXT = (
    f"{{0}} says more than any unit does (over {MESSAGES_HZ} messages or {BYTES_PER_S / 1e6:g} MB "
    "a second): what is too much is dropped. Switch it off, or revoke it: muster pki revoke {0}"
)


class _Allowance:
    """Fills at a rate, up to a burst; what is taken beyond it is not had."""

    __slots__ = ("_filled_ns", "_left", "_per_s")

    def __init__(self, per_s: float, now_ns: int) -> None:
        self._per_s = per_s
        self._left = per_s * BURST_S
        self._filled_ns = now_ns

    def take(self, amount: float, now_ns: int) -> bool:
        filled = self._left + (now_ns - self._filled_ns) * self._per_s / NS_PER_S
        self._filled_ns = now_ns
        self._left = min(filled, self._per_s * BURST_S)
        if amount > self._left:
            return False
        self._left -= amount
        return True


class _Sender:
    """What one may still say."""

    __slots__ = ("alerts", "bytes", "messages")

    def __init__(self, now_ns: int) -> None:
        self.messages = _Allowance(MESSAGES_HZ, now_ns)
        self.alerts = _Allowance(ALERTS_HZ, now_ns)
        self.bytes = _Allowance(BYTES_PER_S, now_ns)


class FairShare:
    """``offer`` hands on what its sender's share allows."""

    def __init__(self, offer: Callable[[str, bytes], None], clock: Clock) -> None:
        self._offer = offer
        self._clock = clock
        self._senders: dict[str, _Sender] = {}
        self._beyond: dict[str, tuple[int, int]] = {}  # since when, and when last; monotonic
        self._told: set[str] = set()

    def offer(self, key: str, payload: bytes) -> None:
        """What a bus calls, from one thread at a time; ``muster/v1/SENDER/...``."""
        parts = key.split("/", 3)
        what = parts[-1]
        if what.startswith("command/"):  # said to a unit, not by it
            self._offer(key, payload)
            return
        now_ns = self._clock.monotonic_ns()
        sender_id = parts[2] if len(parts) == 4 else ""
        sender = self._senders.get(sender_id) or self._new(sender_id, now_ns)
        share = sender.alerts if what.startswith("alert/") else sender.messages
        if share.take(1, now_ns) and sender.bytes.take(len(payload), now_ns):
            self._offer(key, payload)
            return
        since_ns, last_ns = self._beyond.get(sender_id, (now_ns, now_ns))
        self._beyond[sender_id] = now_ns if now_ns - last_ns > _PAUSE_NS else since_ns, now_ns

    def news(self, known: Mapping[str, str]) -> Iterator[ReportProblem]:
        """Who has begun to be beyond its share, and who has long been well again; one thread.

        ``known``: the problems that stand reported, by part.  What an earlier run of the program
        told, or the other of two stations, ends here too.
        """
        now_ns = self._clock.monotonic_ns()
        for sender_id in [one.removeprefix(_PART) for one in list(known) if one.startswith(_PART)]:
            self._told.add(sender_id)
            self._beyond.setdefault(sender_id, (now_ns, now_ns))
        for sender_id, (since_ns, last_ns) in list(self._beyond.items()):
            part = f"{_PART}{sender_id}"
            if now_ns - last_ns >= _OVER_AFTER_NS:
                self._beyond.pop(sender_id, None)
                if sender_id in self._told:
                    self._told.remove(sender_id)
                    yield ReportProblem(part, "")
            elif sender_id not in self._told and last_ns - since_ns >= _TOLD_AFTER_NS:
                self._told.add(sender_id)
                yield ReportProblem(part, _TEXT.format(sender_id))

    def _new(self, sender_id: str, now_ns: int) -> _Sender:
        if len(self._senders) >= _MOST_SENDERS:
            self._senders.clear()
            self._beyond = {one: when for one, when in self._beyond.items() if one in self._told}
        sender = self._senders[sender_id] = _Sender(now_ns)
        return sender
