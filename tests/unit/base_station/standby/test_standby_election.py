"""Election of the leader of two stations, in simulated time."""

from __future__ import annotations

import pytest

from base_station.core.log_position import START, LogPosition
from base_station.standby.election import Decision, Election, LocalStatus
from base_station.standby.protocol import PROTOCOL, PeerHeartbeat, Role
from shared.clock import NS_PER_S

LEASE_S = 3.0
HERE = LogPosition(50, 1)


class Site:
    """Election of one station, and the messages that it receives of the other."""

    def __init__(self, *, preferred: bool = False) -> None:
        self.now_s = 100.0
        self.election = Election(round(LEASE_S * NS_PER_S), self.now_ns)
        self.me = LocalStatus("b", preferred, 1, HERE, stepped=HERE, units=1, unit_received_ns=0)

    @property
    def now_ns(self) -> int:
        return round(self.now_s * NS_PER_S)

    def receive(
        self, role: Role, *, term: int = 1, place: LogPosition = HERE, units: int = 1
    ) -> None:
        beat = PeerHeartbeat("a", PROTOCOL, role, term, place, True, 1, units, "http://a")
        self.election.receive(beat, self.now_ns)

    def decide(self, after_s: float = 0.0) -> Decision:
        self.now_s += after_s
        return self.election.decide(self.me, self.now_ns)

    def receive_unit(self, after_s: float) -> None:
        self.now_s += after_s
        self.me = self.me._replace(unit_received_ns=self.now_ns)
        self.decide()

    def become(self, role: Role) -> None:
        self.election.role = role


@pytest.mark.parametrize(("preferred", "waits_s"), [(True, LEASE_S), (False, 2 * LEASE_S)])
def test_single_station_leads_after_a_while(preferred: bool, waits_s: float) -> None:
    site = Site(preferred=preferred)
    assert site.decide(waits_s - 0.1) == "stay"
    assert site.decide(0.1) == "lead"


def test_returning_station_waits_for_a_linked_peer_without_messages() -> None:
    """The two routers have not linked: it would lead beside the leader."""
    site = Site(preferred=True)
    site.me = site.me._replace(other_listens=True)
    assert site.decide(3 * LEASE_S) == "stay"
    site.receive("active", term=2)
    assert site.decide() == "follow"


def test_station_whose_linked_peer_stays_silent_leads_in_the_end() -> None:
    site = Site(preferred=True)
    site.me = site.me._replace(other_listens=True)
    assert site.decide(10 * LEASE_S) == "lead"


def test_new_standby_with_an_empty_log_does_not_lead() -> None:
    site = Site(preferred=False)
    site.me = site.me._replace(place=START, term=0)
    assert site.decide(100 * LEASE_S) == "stay"
    site.me = site.me._replace(preferred=True)  # the first start of all
    assert site.decide() == "lead"


def test_station_follows_a_leader_whatever_its_own_log() -> None:
    site = Site(preferred=True)
    site.receive("active", term=1, place=START)
    assert site.decide() == "follow"


def test_longer_log_leads_of_two_that_wait() -> None:
    site = Site()
    site.receive("waiting", place=LogPosition(50, 2))
    assert site.decide() == "stay"
    site.receive("waiting", place=LogPosition(49, 9))
    assert site.decide() == "lead"


def test_preferred_station_leads_of_two_with_equal_logs() -> None:
    site = Site(preferred=False)
    site.receive("waiting")
    assert site.decide() == "stay"


def test_standby_takes_over_at_the_end_of_the_lease_and_not_before() -> None:
    site = Site()
    site.become("standby")
    site.receive("active")
    site.receive_unit(after_s=1.0)
    assert site.decide(LEASE_S - 1.1) == "stay"
    assert site.decide(0.1) == "lead"


def test_station_behind_the_log_waits_for_the_return_of_the_other() -> None:
    """It would lead without actions of people, and the other would have to cut those off."""
    site = Site()
    site.become("standby")
    hour = LogPosition(3600 * NS_PER_S, 1)
    site.receive("active", place=hour)
    site.receive_unit(after_s=1.0)
    assert site.decide(2 * LEASE_S) == "stay"
    assert site.election.lacks_log
    site.receive("waiting", place=hour)  # it has started again
    assert site.decide(1.0) == "stay"
    site.receive_unit(after_s=1.0)
    assert site.decide(20 * LEASE_S - 2.1) == "stay"
    assert site.decide(0.1) == "lead", "it does not come back"


@pytest.mark.parametrize("units", [0, 1])
def test_station_that_lacks_the_last_moments_does_not_wait(units: int) -> None:
    site = Site()
    site.become("standby")
    site.receive("active", place=LogPosition(3600 * NS_PER_S, 1), units=units)
    site.me = site.me._replace(stepped=LogPosition(3570 * NS_PER_S, 1))
    site.receive_unit(after_s=1.0)
    assert site.decide(LEASE_S) == "lead"


def test_missing_token_shortens_the_lease() -> None:
    site = Site()
    site.become("standby")
    site.receive("active")
    site.receive_unit(after_s=0.6)
    site.election.note_token(there=False)
    assert site.decide(0.9) == "stay"  # the lease of a station without a token is over
    assert site.decide(0.1) == "lead"


def test_reopened_router_removes_the_token_for_a_moment_only() -> None:
    site = Site()
    site.become("standby")
    for _ in range(20):
        site.receive("active")
        site.election.note_token(there=False)
        assert site.decide(0.5) == "stay"


def test_station_without_units_that_the_leader_had_is_cut_off_and_waits() -> None:
    site = Site()
    site.become("standby")
    site.receive("active", units=2)
    site.receive_unit(after_s=0.2)  # sent before the cable was cut
    assert site.decide(10 * LEASE_S) == "stay"
    assert site.election.is_cut_off(site.now_ns)
    site.receive_unit(after_s=0.2)  # it has changed to this station's router
    assert site.decide(0.9) == "stay"
    assert site.decide(0.1) == "lead"


def test_unit_received_first_after_the_cable_is_repaired_changes_nothing() -> None:
    site = Site()
    site.become("standby")
    site.receive("active")
    assert site.decide(10 * LEASE_S) == "stay"
    site.receive_unit(after_s=0.2)
    assert site.decide(0.3) == "stay"
    site.receive("active")
    assert site.decide(2.0) == "stay"


def test_units_are_not_waited_for_where_the_leader_had_none() -> None:
    site = Site()
    site.become("standby")
    site.receive("active", units=0)
    assert site.decide(LEASE_S) == "lead"
    assert not site.election.is_cut_off(site.now_ns)


def test_reopening_router_is_waited_for_without_evidence() -> None:
    """As both do when the first unit is enrolled: for seconds neither station receives the
    other.
    """
    site = Site()
    site.become("standby")
    site.receive("active", units=0)
    site.election.note_token(there=False)
    for listens in (True, False, True, False):
        site.me = site.me._replace(other_listens=listens)
        assert site.decide(0.9) == "stay"
    site.receive("active", units=1)
    assert site.decide() == "stay"


def test_lost_station_is_not_waited_for_long_without_evidence() -> None:
    site = Site()
    site.become("standby")
    site.receive("active", units=0)
    site.me = site.me._replace(other_listens=True)
    assert site.decide(LEASE_S) == "stay"
    site.me = site.me._replace(other_listens=False)
    assert site.decide(0.9) == "stay"
    assert site.decide(0.1) == "lead"


def test_hanging_station_is_replaced_in_the_end_without_evidence() -> None:
    site = Site()
    site.become("standby")
    site.receive("active", units=0)
    site.me = site.me._replace(other_listens=True)
    for _ in range(4):
        assert site.decide(LEASE_S) == "stay"
    assert site.decide(LEASE_S) == "lead"


def test_standby_leads_when_the_leader_restarts_with_less() -> None:
    site = Site()
    site.become("standby")
    site.receive("waiting", place=LogPosition(49, 1))
    assert site.decide() == "lead"


@pytest.mark.parametrize(("theirs", "decision"), [(2, "step back"), (1, "step back"), (0, "stay")])
def test_later_take_over_stays_of_two_leaders(theirs: int, decision: Decision) -> None:
    site = Site(preferred=False)  # as the other one is, which decides between equal terms
    site.become("active")
    site.receive("active", term=theirs)
    assert site.decide() == decision


def test_one_of_two_leaders_steps_back_and_not_both() -> None:
    for mine in (1, 2, 3):
        for theirs in (1, 2, 3):
            here = Site(preferred=False)
            here.become("active")
            here.me = here.me._replace(term=mine)
            here.receive("active", term=theirs)
            there = Election(round(LEASE_S * NS_PER_S), 0)
            there.role = "active"
            there.receive(PeerHeartbeat("b", PROTOCOL, "active", mine, START, False, 2, 1, ""), 0)
            other = there.decide(LocalStatus("a", True, theirs, START, START, 1, 0), 0)
            assert {here.decide(), other} == {"stay", "step back"}


def test_leader_continues_when_the_other_is_gone() -> None:
    site = Site()
    site.become("active")
    site.receive("standby")
    assert site.decide(100 * LEASE_S) == "stay"


def test_leader_does_not_step_back_for_a_follower() -> None:
    """Though that one's name, preference and log be the greater."""
    site = Site()
    site.become("active")
    for role in ("standby", "waiting"):
        site.receive(role, term=2)
        assert site.decide() == "stay"


def test_cut_off_is_reported_only_where_a_standby_receives_neither_station_nor_unit() -> None:
    site = Site()

    def is_cut_off() -> bool:
        return site.election.is_cut_off(site.now_ns)

    assert not is_cut_off(), "nobody was ever heard"
    site.receive("active")
    site.become("standby")
    assert not is_cut_off(), "the active station is heard"
    site.decide(LEASE_S)
    assert is_cut_off()
    site.receive_unit(0.1)
    site.decide(1.0)
    assert not is_cut_off(), "it is the other one that is gone"
    site.become("active")
    site.now_s += 60.0
    assert not is_cut_off(), "it leads"


def test_units_received_before_the_other_returned_are_no_evidence() -> None:
    site = Site()
    site.receive("active")
    site.become("standby")
    site.receive_unit(1.0)
    site.receive("active")
    site.receive_unit(0.1)
    assert site.decide(LEASE_S) == "stay", "nobody has been heard for longer than the other"
