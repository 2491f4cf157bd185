"""Bans of units that flood the bus with messages that cost others time even if they are dropped."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from threading import Lock
from typing import NamedTuple

from shared.clock import NS_PER_S, Clock
from shared.coded_text import coded
from shared.messages.station import ReportProblem

FIRST_S, LONGEST_S = 60.0, 3600.0
_TIMES = 4  # longer than the time before
_WELL_AFTER_NS = 3600 * NS_PER_S  # since the last one ended: it begins anew
_REPORT_FOR_NS = 30 * NS_PER_S  # behind the end of one
_PART = "shut out "  # and the unit


class _Ban(NamedTuple):
    reason: str
    seconds: float
    begun_ns: int

    @property
    def end_ns(self) -> int:
        return self.begun_ns + round(self.seconds * NS_PER_S)


class SenderBans:
    """Bans of senders, each longer than the one before.  Any thread may ban; one thread asks for
    the changes.
    """

    def __init__(self, order: Callable[[str, float], None], clock: Clock) -> None:
        """``order`` takes the links of a sender away for a number of seconds."""
        self._order = order
        self._clock = clock
        self._lock = Lock()
        self._bans: dict[str, _Ban] = {}

    def ban(self, sender_id: str, reason: str) -> None:
        """Ban a unit.  ``reason``: half a sentence that follows the name of the unit."""
        now_ns = self._clock.monotonic_ns()
        with self._lock:
            before = self._bans.get(sender_id)
            if before is not None and now_ns < before.begun_ns + NS_PER_S:
                return  # on its way when the sender was shut out
            seconds = FIRST_S
            if before is not None and now_ns < before.end_ns + _WELL_AFTER_NS:
                is_over = now_ns >= before.end_ns
                longer = min(before.seconds * _TIMES, LONGEST_S)
                seconds = longer if is_over else before.seconds
            self._bans[sender_id] = _Ban(reason, seconds, now_ns)
        self._order(sender_id, seconds)

    def changes(self, known: Mapping[str, str]) -> Iterator[ReportProblem]:
        """Return reports on bans that begin or have ended.  ``known``: problems that stand
        reported, by part, perhaps by an earlier run.
        """
        now_ns = self._clock.monotonic_ns()
        with self._lock:
            self._drop_old(now_ns)
            reports = {
                f"{_PART}{sender_id}": _text(sender_id, one)
                for sender_id, one in self._bans.items()
                if now_ns < one.end_ns + _REPORT_FOR_NS
            }
        for part, text in reports.items():
            if known.get(part) != text:
                yield ReportProblem.of(part, text)
        for part in [one for one in known if one.startswith(_PART) and one not in reports]:
            yield ReportProblem(part, "")

    def _drop_old(self, now_ns: int) -> None:
        well = [
            sender_id
            for sender_id, ban in self._bans.items()
            if now_ns >= ban.end_ns + _WELL_AFTER_NS
        ]
        for sender_id in well:
            del self._bans[sender_id]


def _text(sender_id: str, one: _Ban) -> str:
    return coded(
        "sender-shut-out",
        "{sender_id} {reason}: it is shut out for {minutes:.0f} min, as it holds up others, and "
        "its wearer is out of contact meanwhile: ask by voice. Exchange the unit, or revoke it: "
        "muster pki revoke {sender_id}",
        sender_id=sender_id,
        reason=one.reason,
        minutes=one.seconds / 60.0,
    )
