"""Limits on the links of each certificate holder: enrolled, revoked, or shut out for a time."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from base_station.security.pki.registry import Registry
from shared.enrolment import Holder
from shared.tls import TlsIdentity

# A unit has one link, two while the one before has not been noticed as gone, and a clone of it as
# many.  Stations and operators run several programs with one certificate.
_MAX_LINKS = {
    Holder.UNIT: 4,
    Holder.TRACKER: 4,
    Holder.OPERATOR: 16,
    Holder.STATION: 16,
    Holder.DEPARTMENT_STATION: 8,  # two stations that are one of two, as a unit
}
_NEW_LINKS_BURST = 16
_NEW_LINKS_PER_S = 2.0  # a unit tries every second at most


@dataclass(frozen=True, slots=True)
class ConnectionAdmission:
    """``identity``: of the acceptor; ``holders``: enrolled holders, by common name."""

    identity: TlsIdentity
    holders: Mapping[str, Holder]

    @staticmethod
    def of(identity: TlsIdentity, registry: Registry) -> ConnectionAdmission:
        entries = (entry for entry in registry.entries if entry.revoked is None)
        return ConnectionAdmission(identity, {entry.common_name: entry.holder for entry in entries})

    def max_links(self, common_name: str) -> int:
        """Return the number of links that a participant may have; 0: it is not enrolled, or
        revoked.
        """
        holder = self.holders.get(common_name)
        return 0 if holder is None else _MAX_LINKS[holder]


@dataclass(slots=True)
class _TokenBucket:
    """New links that one holder may still open."""

    tokens: float = _NEW_LINKS_BURST
    filled_s: float = 0.0


@dataclass(slots=True)
class LinkRates:
    """Rate of new links by holder, and holders shut out; times are a monotonic clock's."""

    _buckets: dict[str, _TokenBucket] = field(default_factory=dict)
    _banned_until: dict[str, float] = field(default_factory=dict)  # until when

    def take_token(self, common_name: str, now_s: float) -> bool:
        """Counts one that it allows."""
        bucket = self._buckets.setdefault(common_name, _TokenBucket(filled_s=now_s))
        tokens = bucket.tokens + (now_s - bucket.filled_s) * _NEW_LINKS_PER_S
        bucket.tokens, bucket.filled_s = min(tokens, _NEW_LINKS_BURST), now_s
        if bucket.tokens < 1.0:
            return False
        bucket.tokens -= 1.0
        return True

    def ban(self, common_name: str, until_s: float) -> None:
        self._banned_until[common_name] = until_s

    def is_banned(self, common_name: str, now_s: float) -> bool:
        until_s = self._banned_until.get(common_name)
        if until_s is None:
            return False
        if now_s >= until_s:
            del self._banned_until[common_name]
            return False
        return True

    def forget(self, common_name: str) -> None:
        self._buckets.pop(common_name, None)
        self._banned_until.pop(common_name, None)
