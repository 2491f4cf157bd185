"""The peer of a station: which sender it accepts, and which it only reports."""

from __future__ import annotations

import msgspec
import pytest

from base_station.core.log_position import START, LogPosition
from base_station.standby.election import Election
from base_station.standby.peer_monitor import PeerMonitor
from base_station.standby.protocol import PROTOCOL, PeerHeartbeat, ReplicationAck, key_of, pack
from shared.bus_memory import MemoryRouter
from shared.channels import Qos, alive_key
from shared.clock import NS_PER_S, ManualClock

RUN = 7
OTHER = PeerHeartbeat(
    station="b",
    protocol=PROTOCOL,
    role="active",
    term=1,
    place=START,
    preferred=False,
    run=8,
    units=0,
    url="",
)


class Ends:
    """Station a, which receives, and the senders."""

    def __init__(self) -> None:
        router = MemoryRouter()
        self.clock = ManualClock()
        self.election = Election(3 * NS_PER_S, self.clock.monotonic_ns())
        self.beats = 0
        self.places: list[LogPosition] = []
        self.hearing = PeerMonitor(
            "a",
            RUN,
            router.attach_station(),
            self.clock,
            self.election,
            on_beat=self._count,
            on_have=self.places.append,
        )
        self.speaker = router.attach_station()
        self.unit = router.attach_unit()

    def say(self, what: str, payload: bytes) -> None:
        self.speaker.publish(key_of("b", what), payload, Qos.ALERT)

    def beat(self, **changes: object) -> None:
        self.say("beat", pack(msgspec.structs.replace(OTHER, **changes)))

    def _count(self, _beat: PeerHeartbeat) -> None:
        self.beats += 1


@pytest.fixture
def ends() -> Ends:
    return Ends()


def test_the_other_station_is_received(ends: Ends) -> None:
    ends.beat()
    assert ends.election.other == OTHER
    assert ends.beats == 1
    assert ends.hearing.stranger == ""


def test_own_heartbeat_and_invalid_ones_are_ignored(ends: Ends) -> None:
    ends.beat(station="a", run=RUN)
    ends.say("beat", b"rubbish")
    ends.say("have", b"rubbish")
    assert (ends.election.other, ends.beats, ends.hearing.stranger) == (None, 0, "")


@pytest.mark.parametrize(
    ("changes", "reported"),
    [
        ({"station": "a"}, "Two stations call themselves a"),
        ({"protocol": PROTOCOL + 1}, "Station b is of another version"),
    ],
)
def test_foreign_station_is_reported_while_it_is_there(
    ends: Ends, changes: dict[str, object], reported: str
) -> None:
    ends.beat(**changes)
    assert ends.election.other is None
    assert ends.hearing.stranger.startswith(reported)
    ends.clock.advance(6.0)
    assert ends.hearing.stranger == ""


def test_only_a_follower_of_this_run_has_its_log(ends: Ends) -> None:
    ends.say("have", pack(ReplicationAck(RUN, LogPosition(5, 1))))
    ends.say("have", pack(ReplicationAck(RUN + 1, LogPosition(9, 1))))
    assert ends.places == [LogPosition(5, 1)]


def test_linked_units_are_counted(ends: Ends) -> None:
    token = ends.unit.declare_alive(alive_key("anna"))
    assert ends.hearing.units == 1
    token.close()
    assert ends.hearing.units == 0


def test_station_that_announced_its_stop_is_awaited_half_as_long(ends: Ends) -> None:
    token = ends.speaker.declare_alive(key_of("b", "alive"))
    own = ends.speaker.declare_alive(key_of("a", "alive"))
    ends.beat()
    own.close()
    ends.clock.advance(2.0)
    assert ends.election.is_peer_alive(ends.clock.monotonic_ns()), (
        "its own token says nothing of it"
    )
    token.close()
    assert not ends.election.is_peer_alive(ends.clock.monotonic_ns())
