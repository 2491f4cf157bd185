"""Connections to the bus that were refused: how many, why, and from where."""

from __future__ import annotations

from collections import Counter, deque
from enum import StrEnum
from typing import NamedTuple

import msgspec

from shared.coded_text import Term, coded

_WINDOW_S = 60
_MIN_REPORTED = 120  # in that time: as of two units that are refused once a second
_MAX_NETWORKS = 4096  # that are counted apart in a second; further ones are counted together
_OTHER_NETWORKS = "other addresses"


class Refusal(StrEnum):
    """Half a sentence for the console."""

    SILENT = "no greeting in time"
    ENDED = "ended before a greeting"
    NOT_TLS = "no TLS, or no certificate of this station's authority"
    NOT_ENROLLED = "a certificate that was revoked, or is not on the list"
    BANNED = "a holder that is shut out for a while"
    TOO_OFTEN = "more links of one holder than there may be"
    EVICTED = "more connections at once than there may be"


class RefusedError(Exception):
    """This connection is not handed on."""

    def __init__(self, reason: Refusal) -> None:
        super().__init__(reason.value)
        self.reason = reason


class RefusalSummary(msgspec.Struct, frozen=True):
    """Message of the router's process to the station."""

    total: int = 0  # since the process began
    in_window: int = 0  # in the last minute
    reason: str = ""  # the most frequent one in the last minute
    network: str = ""  # from which most came
    of_network: int = 0


class _Second(NamedTuple):
    second: int
    reasons: Counter[Refusal]
    networks: Counter[str]


class Refusals:
    """Counts over the last minute, second by second; for one thread."""

    def __init__(self) -> None:
        self._total = 0
        self._seconds: deque[_Second] = deque()

    def add(self, reason: Refusal, network: str, now_s: float) -> None:
        self._total += 1
        if not self._seconds or self._seconds[-1].second != int(now_s):
            self._seconds.append(_Second(int(now_s), Counter(), Counter()))
        _, reasons, networks = self._seconds[-1]
        reasons[reason] += 1
        if network not in networks and len(networks) >= _MAX_NETWORKS:
            network = _OTHER_NETWORKS
        networks[network] += 1

    def summary(self, now_s: float) -> RefusalSummary:
        while self._seconds and self._seconds[0].second <= now_s - _WINDOW_S:
            self._seconds.popleft()
        reasons: Counter[Refusal] = Counter()
        networks: Counter[str] = Counter()
        for one in self._seconds:
            reasons += one.reasons
            networks += one.networks
        if not reasons:
            return RefusalSummary(self._total)
        [(network, of_network)] = networks.most_common(1)
        [(reason, _)] = reasons.most_common(1)
        return RefusalSummary(self._total, reasons.total(), reason.value, network, of_network)


def refusal_problem(refused: RefusalSummary) -> str:
    """A sentence for the console; empty where it is no matter."""
    if refused.in_window < _MIN_REPORTED:
        return ""
    return coded(
        "connections-refused",
        "{count} connections to the bus were refused in the last minute ({total} since the router "
        "began), {of_network} of them from {network}, most for: {reason}. Units are let in all "
        "the same; see docs/howto/when-attacked.md",
        count=refused.in_window,
        total=refused.total,
        of_network=refused.of_network,
        network=refused.network,
        reason=Term(Refusal(refused.reason).name.lower(), refused.reason),
    )
