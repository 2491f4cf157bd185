"""Leader election between two stations.  Pure: time and heartbeats come in, a decision comes out.

A station leads for as long as its heartbeats arrive (its lease).  A station cannot distinguish a
dead partner from a cut cable, so messages of units decide: a station that receives none, while the
other one had units, is probably cut off, and waits for a person.
"""

from __future__ import annotations

from typing import Literal, NamedTuple

from base_station.core.log_position import START, LogPosition
from base_station.standby.protocol import PeerHeartbeat, Role
from shared.clock import NS_PER_S

Decision = Literal["stay", "follow", "lead", "step back"]
LACKING_LEASES = 20  # that a standby waits for one of which it has not got everything
_TOKEN_GONE_SHARE = 0.5  # of the lease: with the token gone, heartbeats are not just lost
_ON_THE_WAY_NS = NS_PER_S // 2  # messages from before a cable was cut have come by then
_GREETING_LEASES = 5  # longest wait of a station for a heartbeat of one whose router listens
_LACKING_NS = 30 * NS_PER_S  # of the other one's log: more is not the last moments
_OPENING_NS = NS_PER_S  # that a router takes no connection when it opens again
_WITNESS_NS = NS_PER_S  # a cable that is whole again may bring a unit's message before a heartbeat


class LocalStatus(NamedTuple):
    """State of this station at the moment, for the election."""

    station: str
    preferred: bool
    term: int  # of the last take-over in its log
    place: LogPosition
    stepped: LogPosition  # its disk may have less of the other one's log
    units: int  # that are linked with either router, as far as it knows
    unit_received_ns: int  # time of the last message of any unit; monotonic
    other_listens: bool = False  # the other one's router takes connections


class Election:
    """``receive`` the other one's heartbeats, then ``decide``, several times a second."""

    def __init__(self, lease_ns: int, now_ns: int) -> None:
        self._lease_ns = lease_ns
        self._since_ns = now_ns  # start of the wait for another station
        self._other: PeerHeartbeat | None = None
        self._received_ns = 0
        self._token_there = False
        self._listened_ns: int | None = None  # when the other one's router last did
        self._witness_ns: int | None = None  # since when units send, and the other station does not
        self.lacks_log = False  # much of the other one's; people's actions may be in that
        self.role: Role = "waiting"

    @property
    def other(self) -> PeerHeartbeat | None:
        """Last heartbeat of the other station, however long ago."""
        return self._other

    @property
    def is_undecided(self) -> bool:
        """True if units do not show which of the two is cut off: the other one had none."""
        return self._other is not None and self._other.units == 0

    def receive(self, beat: PeerHeartbeat, now_ns: int) -> None:
        self._other, self._received_ns = beat, now_ns
        self._token_there = True
        self._witness_ns = None

    def note_token(self, *, there: bool) -> None:
        """True if the other one's liveliness token is on the bus."""
        self._token_there = there

    def is_peer_alive(self, now_ns: int) -> bool:
        """True if heartbeats of the other station arrive."""
        if self._other is None:
            return False
        patience_ns = self._lease_ns * (1.0 if self._token_there else _TOKEN_GONE_SHARE)
        return now_ns - self._received_ns < patience_ns

    def is_cut_off(self, now_ns: int) -> bool:
        """This standby receives neither the active station nor a unit, though that one had some."""
        alone = self.role == "standby" and not self.is_peer_alive(now_ns)
        return alone and not self._has_witness(now_ns)

    def decide(self, me: LocalStatus, now_ns: int) -> Decision:
        self._note_witness(me, now_ns)
        if me.other_listens:
            self._listened_ns = now_ns
        self.lacks_log = (
            self._other is not None
            and LogPosition(*self._other.place).t_ns - me.stepped.t_ns > _LACKING_NS
        )
        other = self._other if self.is_peer_alive(now_ns) else None
        if self.role == "active":
            loses = other is not None and other.role == "active" and _claim(other) > _claim_of(me)
            return "step back" if loses else "stay"
        if other is None:
            return self._alone(me, now_ns)
        if other.role == "active":
            return "stay" if self.role == "standby" else "follow"
        return "lead" if _rank_of(me) > _rank(other) else "stay"

    def _alone(self, me: LocalStatus, now_ns: int) -> Decision:
        if self.role == "standby":
            goes = self._has_witness(now_ns) and not self._is_awaited(now_ns)
            return "lead" if goes else "stay"
        if me.place == START and not me.preferred:
            return "stay"  # made to follow: a log of its own would keep it from that for ever
        leases = 1 if me.preferred else 2
        if me.other_listens:  # it may lead, and the two routers have not linked yet
            leases = _GREETING_LEASES
        return "lead" if now_ns - self._since_ns >= leases * self._lease_ns else "stay"

    def _note_witness(self, me: LocalStatus, now_ns: int) -> None:
        if self._witness_ns is None and me.unit_received_ns > self._received_ns + _ON_THE_WAY_NS:
            self._witness_ns = now_ns

    def _has_witness(self, now_ns: int) -> bool:
        """True if it is the other station that is gone, and not this one."""
        if self.is_undecided:
            return True
        return self._witness_ns is not None and now_ns - self._witness_ns >= _WITNESS_NS

    def _is_awaited(self, now_ns: int) -> bool:
        """True if the other station may only be out of reach while the routers link again, or has
        events that this one lacks and may come back with them.
        """
        silent_ns = now_ns - self._received_ns
        if self.lacks_log and silent_ns < LACKING_LEASES * self._lease_ns:
            return True
        if not self.is_undecided:
            return False
        listened_ns = self._listened_ns
        listens = listened_ns is not None and now_ns - listened_ns < _OPENING_NS
        return silent_ns < (_GREETING_LEASES if listens else 1) * self._lease_ns


def _claim(beat: PeerHeartbeat) -> tuple[int, bool, str]:
    """Rank of a leader's claim: of two that lead, the later take-over stays."""
    return beat.term, beat.preferred, beat.station


def _claim_of(me: LocalStatus) -> tuple[int, bool, str]:
    return me.term, me.preferred, me.station


def _rank(beat: PeerHeartbeat) -> tuple[int, LogPosition, bool, str]:
    """Rank of one that does not lead: of two, the one with more of the log begins."""
    return beat.term, LogPosition(*beat.place), beat.preferred, beat.station


def _rank_of(me: LocalStatus) -> tuple[int, LogPosition, bool, str]:
    return me.term, me.place, me.preferred, me.station
