"""A unit whose positions a remote agent computes, at the station."""

from __future__ import annotations

import msgspec
import pytest

from base_station.core.alarms import ALARMS
from base_station.core.checkpoint import read_checkpoint
from base_station.core.events import TrailBackfilled, UnitChanged, event_of
from base_station.core.pipeline import StationPipeline
from base_station.engine.projector import Projector
from base_station.fusion import FUSERS
from shared.channels import EVENT, NO_TRACKER, POSITION, STATUS, backfilled_key, tracker_id
from shared.clock import NS_PER_S
from shared.codec import encode
from shared.messages import Activity, AlarmChange, AlarmState, EventKind, Header, UnitEvent
from tests.rig import message_factory
from tests.rig.station_script import Script, new_pipeline

U = "FF-01"
AGENT = tracker_id(U)
AGENT_BOOT = 40
AGENT_CLOCK_S = 5_000.0  # of another machine, which has been on for longer


class Remote(Script):
    """The script with an agent that tracks for U, on a machine with a clock of its own."""

    def __init__(self, tracker: str = NO_TRACKER) -> None:
        super().__init__()
        self.boot_ids[AGENT] = AGENT_BOOT
        self.register(U)
        self.describe(tracker)

    def header(self, unit_id: str, captured_s: float | None = None) -> Header:
        header = super().header(unit_id, captured_s)
        if unit_id != AGENT:
            return header
        ahead_ns = round((AGENT_CLOCK_S - 1000.0) * NS_PER_S)
        return msgspec.structs.replace(header, t_mono_ns=header.t_mono_ns + ahead_ns)

    def describe(self, tracker: str, unit_id: str = U) -> None:
        self.say(message_factory.description(self.header(unit_id), tracker=tracker, has_gps=True))

    @property
    def unit(self):
        return self.pipeline.state.units[U]


@pytest.fixture
def script() -> Remote:
    return Remote()


def walk(script: Remote, duration_s: int = 10, tracked_by: str = AGENT) -> None:
    start_m = script.now_s

    def step() -> None:
        script.status(U)
        way_m = script.now_s - start_m
        script.position(tracked_by, way_m, 0.0, distance_m=way_m)

    script.wait(duration_s, step)


def test_positions_and_trail_are_shown_as_if_the_unit_tracked_itself(script: Remote) -> None:
    walk(script)
    itself = Remote(tracker="eskf")
    walk(itself, tracked_by=U)
    assert script.unit.trails.shown == itself.unit.trails.shown
    assert len(script.unit.trails.shown) == 10
    assert {fused.unit_id for fused in script.fused} == {U}
    assert set(script.pipeline.state.units) == {U}, "the agent is no unit"


def test_agent_is_no_sign_of_life_of_the_unit(script: Remote) -> None:
    walk(script)
    last_message_ns = script.unit.last_message_ns
    script.wait(40, lambda: script.position(AGENT, 10.0, 0.0))
    assert script.unit.last_message_ns == last_message_ns
    assert script.unit.link == "lost"
    assert any(alarm.unit_id == U for alarm in script.alarms)


def test_agent_gives_no_positions_for_a_unit_that_tracks_itself() -> None:
    script = Remote(tracker="eskf")
    script.position(U, 1.0, 2.0)
    script.position(AGENT, 50.0, 50.0)
    assert script.unit.position is not None
    assert script.unit.position.north_m == 1.0
    assert len(script.fused) == 1


def test_other_facts_of_the_agent_are_not_taken_for_the_units(script: Remote) -> None:
    walk(script)
    before = msgspec.structs.replace(script.unit, tracker=None)
    script.status(AGENT, battery=0.1, mayday=True)
    script.temperature(AGENT, 300.0)
    script.event(AGENT, EventKind.STOPPED)
    script.event(AGENT, EventKind.MAYDAY)
    script.gps(AGENT, 1.0, 1.0)
    assert msgspec.structs.replace(script.unit, tracker=None) == before


def test_status_takes_strides_from_the_agent_and_the_rest_from_the_unit(script: Remote) -> None:
    script.status(U, activity=Activity.STILL, steps=0, battery=0.8)
    assert script.unit.shown_status == script.unit.status
    script.status(
        AGENT, activity=Activity.STAIRS_UP, steps=120, cadence_hz=1.5, floors_climbed=2, battery=0.1
    )
    shown = script.unit.shown_status
    assert shown.activity is Activity.STAIRS_UP
    assert (shown.steps, shown.cadence_hz, shown.floors_climbed) == (120, 1.5, 2)
    assert shown.battery == 0.8
    assert shown.header == script.unit.status.header


def test_lost_agent_does_not_keep_its_wearer_walking(script: Remote) -> None:
    script.status(AGENT, activity=Activity.WALKING, steps=120)
    script.wait(12, lambda: script.status(U, activity=Activity.STILL, steps=0))
    shown = script.unit.shown_status
    assert shown.activity is Activity.STILL
    assert shown.cadence_hz == 0.0
    assert shown.steps == 120


def test_stale_strides_of_the_agent_do_not_replace_the_activity(script: Remote) -> None:
    script.status(U)
    before = script.header(AGENT)
    script.wait(3, lambda: script.status(AGENT, activity=Activity.CRAWLING, steps=120))
    late = message_factory.status(before, activity=Activity.RUNNING, steps=10)
    script.record(backfilled_key(AGENT, STATUS.suffix), encode(late))
    shown = script.unit.shown_status
    assert (shown.activity, shown.steps) == (Activity.CRAWLING, 120)


def test_agent_reports_the_activity_of_a_unit_that_only_posts_samples(script: Remote) -> None:
    assert not script.unit.shown_status
    script.status(AGENT, activity=Activity.WALKING, steps=12, battery=0.1, mayday=True)
    shown = script.unit.shown_status
    assert (shown.activity, shown.steps) == (Activity.WALKING, 12)
    assert (shown.battery, shown.mayday) == (None, False)
    assert script.unit.shown_status_ns == script.t_ns


def test_unit_that_tracks_itself_shows_its_own_status() -> None:
    script = Remote(tracker="eskf")
    script.status(U, steps=10)
    script.status(AGENT, steps=120)
    assert script.unit.shown_status == script.unit.status


def test_unit_that_tracks_itself_again_ignores_the_agents_last_messages(
    script: Remote,
) -> None:
    script.status(U, steps=10)
    script.status(AGENT, steps=120)
    script.describe("eskf")
    assert script.unit.shown_status == script.unit.status


def test_unreadable_message_counts_as_received_from_its_sender(script: Remote) -> None:
    script.status(AGENT)
    state = script.pipeline.state
    assert state.sender(AGENT) is script.unit.tracker
    assert state.sender(U) is script.unit
    assert state.sender("FF-09") is None


def gone(script: Remote) -> list[AlarmState]:
    return [alarm.state for alarm in script.alarms if alarm.rule == "tracker-gone"]


def test_lost_tracking_raises_an_alarm_resolved_by_tracking(script: Remote) -> None:
    walk(script)
    script.wait(28, lambda: script.status(U))
    assert gone(script) == []
    script.wait(4, lambda: script.status(U))
    assert gone(script) == [AlarmState.RAISED]
    walk(script, 5)
    assert gone(script) == [AlarmState.RAISED, AlarmState.RESOLVED]


def test_tracking_that_never_began_raises_an_alarm(script: Remote) -> None:
    script.wait(40, lambda: script.status(U))
    assert gone(script) == [AlarmState.RAISED]


def test_switched_off_unit_needs_no_tracking(script: Remote) -> None:
    walk(script)
    script.event(U, EventKind.STOPPED)
    script.wait(60, lambda: None)
    assert gone(script) == []


def test_switching_the_unit_off_ends_the_alarm_of_tracking(script: Remote) -> None:
    walk(script)
    script.wait(40, lambda: script.status(U))
    script.event(U, EventKind.STOPPED)
    assert gone(script) == [AlarmState.RAISED, AlarmState.RESOLVED]
    assert script.alarms[-1].by == "the unit was switched off"


def test_agent_has_its_grace_time_when_the_unit_is_on_again(script: Remote) -> None:
    walk(script)
    script.event(U, EventKind.STOPPED)
    script.wait(600)
    script.boot_ids[U] = 8
    script.describe(NO_TRACKER)
    script.wait(29, lambda: script.status(U))
    assert gone(script) == []
    script.wait(2, lambda: script.status(U))
    assert gone(script) == [AlarmState.RAISED]


def test_one_message_of_the_agent_and_a_restart_of_the_unit_are_no_tracking(
    script: Remote,
) -> None:
    walk(script)
    script.wait(40, lambda: script.status(U))
    walk(script, 1)
    script.wait(5, lambda: script.status(U))
    script.boot_ids[U] = 8
    script.describe(NO_TRACKER)
    script.wait(8, lambda: script.status(U))
    assert gone(script) == [AlarmState.RAISED]


def test_fall_detected_by_the_agent_is_the_units(script: Remote) -> None:
    outputs = script.event(AGENT, EventKind.FALL)
    assert script.unit.fall.t_ns == script.t_ns
    alarms = [one for one in outputs if isinstance(one, AlarmChange)]
    assert [(one.rule, one.unit_id) for one in alarms] == [("fall", U)], "at once"
    assert UnitChanged(U) in outputs, "and on every console"


def test_fixes_of_the_unit_meet_the_path_at_their_time_on_the_agents_clock(
    script: Remote,
) -> None:
    walk(script)
    script.gps(U, 49.0, 8.0)
    script.wait(1, lambda: script.position(AGENT, 11.0, 0.0, distance_m=11.0))
    itself = Remote(tracker="eskf")
    walk(itself, tracked_by=U)
    itself.gps(U, 49.0, 8.0)
    itself.wait(1, lambda: itself.position(U, 11.0, 0.0, distance_m=11.0))
    assert script.fused[-1].since_gps_s is not None
    assert script.fused[-1].since_gps_s == pytest.approx(itself.fused[-1].since_gps_s)
    assert script.fused[-1].north_m == pytest.approx(itself.fused[-1].north_m)


def test_late_positions_fill_the_trail_at_their_time(script: Remote) -> None:
    walk(script, 5)
    walked = script.header(AGENT)
    script.wait(10, lambda: script.status(U))
    walk(script, 5)
    late = Script.published(script, type(script.unit.position))[-1]
    header = msgspec.structs.replace(walked, t_mono_ns=walked.t_mono_ns + 5 * NS_PER_S)
    payload = encode(msgspec.structs.replace(late, header=header, north_m=8.0))
    outputs = script.record(backfilled_key(AGENT, POSITION.suffix), payload)
    assert any(isinstance(one, TrailBackfilled) and one.unit_id == U for one in outputs)
    assert [step.t_ns for step in script.unit.trails.shown] == sorted(
        s.t_ns for s in script.unit.trails.shown
    )


def test_second_copy_changes_nothing(script: Remote) -> None:
    walk(script)
    fused = len(script.fused)
    _, key, payload = next(r for r in reversed(script.records) if r[1] == POSITION.key(AGENT))
    assert script.record(key, payload) == []
    assert len(script.fused) == fused


def test_log_replays_the_same_also_from_a_checkpoint(script: Remote) -> None:
    walk(script)
    saved = script.pipeline.checkpoint()
    half = len(script.records)
    walk(script)
    again = new_pipeline()
    outputs = [output for record in script.records for output in again.step(event_of(*record))]
    assert outputs == script.outputs
    resumed = StationPipeline(ALARMS, FUSERS[0], read_checkpoint(saved))
    for record in script.records[half:]:
        resumed.step(event_of(*record))
    assert resumed.checkpoint() == script.pipeline.checkpoint()


def test_database_gets_the_unit_and_no_agent(script: Remote) -> None:
    walk(script, 1)
    projector = Projector()
    for record in script.records:
        event = event_of(*record)
        projector.note(event, script.outputs)
    script.describe("eskf", AGENT)
    projector.note(event_of(*script.records[-1]), script.outputs)
    projection = projector.take(script.t_ns)
    assert projection is not None
    assert dict(projection.last_messages).keys() == {U}
    assert {one.header.unit_id for one in projection.descriptions} == {U}


def faults(script: Remote, *, rule: str = "tracker-fault") -> list[str]:
    return [one.text for one in script.alarms if one.rule == rule]


@pytest.mark.parametrize("is_late", [False, True])
def test_fault_of_the_agent_is_reported_as_the_agents(script: Remote, is_late: bool) -> None:
    walk(script)
    event = UnitEvent(script.header(AGENT), EventKind.STORAGE_FAULT, "its disk is full")
    if is_late:
        walk(script)
        script.record(backfilled_key(AGENT, EVENT.suffix), encode(event))
    else:
        script.say(event)
    walk(script, 3)
    assert faults(script) == [f"unit {U}'s tracking agent {AGENT}: its disk is full"]
    assert faults(script, rule="unit-fault") == []
    assert script.unit.fault is None


def test_agent_before_its_unit_is_shown_once_the_unit_comes() -> None:
    """A starting agent reports its missing inputs at once, and a unit its description only now and
    then.
    """
    script = Remote(tracker="eskf")
    script.event(AGENT, EventKind.STORAGE_FAULT, "its disk is full")
    script.wait(2)
    assert faults(script) == [], "nobody tracks for it"
    script.describe(NO_TRACKER)
    script.wait(2)
    assert len(faults(script)) == 1
