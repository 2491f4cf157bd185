"""Backfilled positions go to their own time, and never set the present back."""

from __future__ import annotations

import msgspec
import pytest

from base_station.core.alarms import ALARMS
from base_station.core.checkpoint import read_checkpoint
from base_station.core.events import Received, Rejected, TrailBackfilled, event_of
from base_station.core.pipeline import StationPipeline
from base_station.fusion import FUSERS
from base_station.fusion.fuser_memory import FuserMemory
from shared.channels import EVENT, POSITION, backfilled_key
from shared.clock import NS_PER_S
from shared.codec import encode
from shared.messages import STATION_ID, EventKind, FusedPosition, Header, OperatorAction, UnitEvent
from shared.messages.station import RegisterUnit

START_NS = 1_700_000_000 * NS_PER_S


class Walked:
    """A unit that walks north at 1 m/s, a position a second; some of them came late."""

    def __init__(self, make_position):
        self.pipeline = StationPipeline(ALARMS, FUSERS[0])
        action = OperatorAction(Header(STATION_ID, 1, 1, 0), "a", "b", RegisterUnit("FF-01", ""))
        self.pipeline.step(Received(START_NS, STATION_ID, action))
        self._make_position = make_position

    def position(self, second: int, part: float = 0.0, boot_id: int = 7):
        t_s = second + part
        header = Header("FF-01", boot_id, second + 1 + round(1000 * part), round(t_s * NS_PER_S))
        return self._make_position(header=header, north_m=t_s, east_m=0.0, distance_m=t_s)

    def live(self, second: int, boot_id: int = 7):
        key, payload = POSITION.key("FF-01"), encode(self.position(second, boot_id=boot_id))
        return self.pipeline.step(event_of(START_NS + second * NS_PER_S, key, payload))

    def late(self, second: int, at_second: int, part: float = 0.0):
        key = backfilled_key("FF-01", POSITION.suffix)
        payload = encode(self.position(second, part))
        return self.pipeline.step(event_of(START_NS + at_second * NS_PER_S, key, payload))

    @property
    def unit(self):
        return self.pipeline.state.units["FF-01"]


@pytest.fixture
def walked(make_position):
    walked = Walked(make_position)
    for second in (*range(11), *range(20, 31)):
        walked.live(second)
    return walked


def test_gap_in_the_trail_is_filled_at_its_own_time(walked):
    for second in range(11, 20):
        outputs = walked.late(second, at_second=31)
        fused = next(output for output in outputs if isinstance(output, FusedPosition))
        assert fused.t_meas_ns == START_NS + second * NS_PER_S
        assert fused.north_m == pytest.approx(second)
        assert any(isinstance(output, TrailBackfilled) for output in outputs)
    trail = walked.unit.trails.shown
    assert [round(step.north_m) for step in trail] == list(range(31))
    assert [step.t_ns for step in trail] == sorted(step.t_ns for step in trail)


def test_late_position_is_shown_once_for_each_second(walked):
    """One of five positions a second, as in trail and store; a late fix finds all of them."""
    reported = [
        output.north_m
        for second in (11, 12)
        for part in (0.1, 0.3, 0.5, 0.7, 0.9)
        for output in walked.late(second, at_second=31, part=part)
        if isinstance(output, FusedPosition)
    ]
    assert reported == pytest.approx([11.1, 12.1])
    saved = read_checkpoint(walked.pipeline.checkpoint())
    assert saved is not None
    path = msgspec.msgpack.decode(saved.fusers["FF-01"], type=FuserMemory).path
    known_s = {round(point.t_ns / NS_PER_S, 1) for point in path.points}
    assert known_s >= {11.1, 11.3, 11.5, 11.7, 11.9, 12.1, 12.3, 12.5, 12.7, 12.9}


def test_present_position_is_unchanged(walked):
    before = msgspec.msgpack.encode(
        (walked.unit.place.fused, walked.unit.position, walked.unit.last_message_ns)
    )
    walked.late(15, at_second=31)
    after = msgspec.msgpack.encode(
        (walked.unit.place.fused, walked.unit.position, walked.unit.last_message_ns)
    )
    assert after == before


def test_second_copy_changes_nothing(walked):
    walked.late(15, at_second=31)
    assert walked.late(15, at_second=32) == []
    assert walked.unit.duplicates == 1


def test_mayday_lost_by_the_radio_is_raised_when_backfilled(walked):
    mayday = UnitEvent(Header("FF-01", 7, 500, 15 * NS_PER_S), EventKind.MAYDAY)
    key = backfilled_key("FF-01", EVENT.suffix)
    walked.pipeline.step(event_of(START_NS + 31 * NS_PER_S, key, encode(mayday)))
    assert any(alarm.rule == "mayday" for alarm in walked.pipeline.state.alarms.values())


def test_path_of_the_run_before_is_filled_in(walked):
    """The unit's program was restarted beyond the radio's range."""
    for second in range(50, 56):
        walked.live(second, boot_id=8)
    before = msgspec.msgpack.encode((walked.unit.place.fused, walked.unit.position))
    for second in (*range(11, 20), *range(31, 45)):
        outputs = walked.late(second, at_second=56)
        fused = next(output for output in outputs if isinstance(output, FusedPosition))
        assert fused.t_meas_ns == START_NS + second * NS_PER_S
        assert fused.north_m == pytest.approx(second)
    assert msgspec.msgpack.encode((walked.unit.place.fused, walked.unit.position)) == before
    trail = [(step.t_ns - START_NS) // NS_PER_S for step in walked.unit.trails.shown]
    assert trail == [*range(45), 50], "which way the new run walks nobody knows"


def test_duplicate_device_under_the_same_name_is_not_drawn(walked):
    for second in range(50, 56):
        walked.live(second, boot_id=8)
    for second in (52, 54):
        outputs = walked.late(second, at_second=56)
        assert not any(isinstance(output, FusedPosition) for output in outputs)


def test_unknown_run_is_not_the_present_one(walked):
    earlier = walked.position(3)
    header = msgspec.structs.replace(earlier.header, boot_id=6)
    payload = encode(msgspec.structs.replace(earlier, header=header))
    key = backfilled_key("FF-01", POSITION.suffix)
    walked.pipeline.step(event_of(START_NS + 31 * NS_PER_S, key, payload))
    assert [boot.boot_id for boot in walked.unit.boots] == [6, 7]


def test_journal_of_an_unregistered_unit_is_not_used(walked):
    """Like its live messages: its contact is shown, and nobody is placed by it."""
    for second, backfilled in ((5, False), (3, True)):
        reported = walked.position(second)
        header = msgspec.structs.replace(reported.header, unit_id="FF-66")
        payload = encode(msgspec.structs.replace(reported, header=header))
        key = backfilled_key("FF-66", POSITION.suffix) if backfilled else POSITION.key("FF-66")
        outputs = walked.pipeline.step(event_of(START_NS + 31 * NS_PER_S, key, payload))
        assert not any(isinstance(one, FusedPosition | TrailBackfilled) for one in outputs)
    stranger = walked.pipeline.state.units["FF-66"]
    assert (stranger.place.fused, stranger.trails.shown) == (None, [])


def test_unreadable_backfilled_message_counts_as_received(walked):
    """A message of a newer program, or a damaged one, is not fetched repeatedly."""
    payload = encode(walked.position(15))
    key = POSITION.key("FF-01")
    unread = Rejected(START_NS + 31 * NS_PER_S, key, "of a newer program", ("FF-01", 7, 16))
    assert not walked.unit.has(7, 16)
    walked.pipeline.step(unread)
    assert walked.unit.has(7, 16)
    assert walked.pipeline.state.counts.undecodable == 1
    late = event_of(START_NS + 32 * NS_PER_S, backfilled_key("FF-01", POSITION.suffix), payload)
    assert walked.pipeline.step(late) == []
