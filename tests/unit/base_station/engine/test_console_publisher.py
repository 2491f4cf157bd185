"""Publication of a pipeline's state to consoles: content and portions."""

from __future__ import annotations

import msgspec

from base_station.core.events import (
    CommandChanged,
    NamesErased,
    PinsChanged,
    TrailBackfilled,
    UnitChanged,
)
from base_station.core.pipeline import StationPipeline
from base_station.core.state import Incident, UnitState
from base_station.core.state.trail import TrailStep
from base_station.engine.console_publisher import TRAILS_PER_DELTA, ConsolePublisher
from base_station.site.plan import read_plan
from base_station.storage.db.known_people import person_lookup
from base_station.views.wire import Delta, ReplayView
from shared.clock import NS_PER_S
from shared.geo import Anchor
from shared.messages import STATION_ID, AlarmChange, AlarmState, Header
from tests.rig.live_station import Screen, make_pipeline

UNITS = [f"FF-{i:02}" for i in range(2 * TRAILS_PER_DELTA + 3)]
REPLAY = ReplayView("i1", 0, 9000, 1000, 1.0, playing=True)


def walked(screen: Screen) -> ConsolePublisher:
    return walked_in(make_pipeline(), screen)


def walked_in(pipeline: StationPipeline, screen: Screen) -> ConsolePublisher:
    for unit_id in UNITS:
        unit = pipeline.state.units[unit_id] = UnitState(unit_id)
        unit.trails.shown.append(TrailStep(NS_PER_S, 1.0, 2.0, 0))
    return ConsolePublisher(pipeline, screen, person_lookup({}))


def alarm_of(unit_id: str) -> AlarmChange:
    header = Header(STATION_ID, 1, 1, 0, 0)
    return AlarmChange(
        header, "a1", "mayday", unit_id, 1, AlarmState.RAISED, "alarm", "MAYDAY", "",
        NS_PER_S, NS_PER_S,
    )  # fmt: skip


def new_deltas(screen: Screen) -> list[Delta]:
    """Deltas since the last call."""
    deltas = screen.deltas.copy()
    screen.deltas.clear()
    return deltas


def units_of(deltas: list[Delta]) -> list[list[str]]:
    return [[unit.unit_id for unit in delta.units] for delta in deltas]


def test_delta_has_a_change_once_and_health_on_request() -> None:
    screen = Screen()
    publisher = walked(screen)
    publisher.publish_delta()
    assert new_deltas(screen) == []
    publisher.mark_changed([UnitChanged("FF-01"), UnitChanged("FF-01")])
    for health in (False, False, True):
        publisher.publish_delta(health)
    unit, health_only = new_deltas(screen)
    assert units_of([unit, health_only]) == [["FF-01"], []]
    assert (unit.health is None, health_only.health is None) == (True, False)
    assert (unit.pins, unit.beacons, unit.replay) == (None, None, None)
    assert [unit.seq, health_only.seq] == [1, 2]


def test_deferred_change_goes_with_health_or_the_next_change_of_its_unit() -> None:
    screen = Screen()
    publisher = walked(screen)
    publisher.mark_changed([UnitChanged("FF-01", soon=False), UnitChanged("FF-02", soon=False)])
    publisher.publish_delta()
    assert new_deltas(screen) == []
    publisher.mark_changed([UnitChanged("FF-02")])
    for health in (False, True, True):
        publisher.publish_delta(health)
    assert units_of(new_deltas(screen)) == [["FF-02"], ["FF-01"], []]
    publisher.mark_changed([UnitChanged("FF-03", soon=False)])
    publisher.publish_delta(replay=REPLAY)
    (shown,) = new_deltas(screen)
    assert (units_of([shown]), shown.replay) == ([["FF-03"]], REPLAY)


def test_alarms_commands_and_pins_are_urgent_until_they_are_published() -> None:
    for output in (alarm_of("FF-04"), alarm_of(""), CommandChanged("c1"), PinsChanged(())):
        screen = Screen()
        publisher = walked(screen)
        urgent = [publisher.is_urgent]
        publisher.mark_changed([output])
        urgent.append(publisher.is_urgent)
        publisher.publish_delta()
        publisher.publish_delta()
        urgent.append(publisher.is_urgent)
        assert urgent == [False, True, False]
        (shown,) = new_deltas(screen)
        raised = isinstance(output, AlarmChange)
        assert [one.alarm_id for one in shown.alarms] == (["a1"] if raised else [])
        unit_id = output.unit_id if isinstance(output, AlarmChange) else ""
        assert units_of([shown]) == [[unit_id] if unit_id else []]
        pins = () if isinstance(output, PinsChanged) else None
        assert (shown.pins, shown.beacons) == (pins, pins)


def test_erasure_resets_all_consoles_whatever_was_pending() -> None:
    """Alarms that a console has shown, or is about to, may name the person."""
    screen = Screen()
    publisher = walked(screen)
    publisher.mark_changed([alarm_of("FF-03"), NamesErased()])
    publisher.publish_delta()
    assert (new_deltas(screen), len(screen.resets)) == ([], 1)
    publisher.publish_delta()
    assert (new_deltas(screen), len(screen.resets)) == ([], 1)


def test_another_incident_resets_all_consoles_with_what_was_pending() -> None:
    screen, pipeline = Screen(), make_pipeline()
    publisher = walked_in(pipeline, screen)
    pipeline.state.incidents["i1"] = Incident("i1", "Mill Lane", NS_PER_S)
    later, touched = UnitChanged("FF-01", soon=False), UnitChanged("FF-02")
    publisher.mark_changed(
        [later, touched, alarm_of("FF-03"), CommandChanged("c1"), PinsChanged(())]
    )
    publisher.publish_delta()
    publisher.publish_delta(health=True)
    (whole,) = screen.resets
    assert whole.incident is not None
    (after,) = new_deltas(screen)
    assert units_of([after]) == [[]]
    assert (after.alarms, after.pins, after.seq) == ((), None, whole.seq + 1)


def test_other_plan_or_anchor_resets_all_consoles() -> None:
    screen, pipeline = Screen(), make_pipeline()
    publisher = walked_in(pipeline, screen)
    geojson = b'{"type":"FeatureCollection","features":[],"muster":{"frame":"site-m"}}'
    pipeline.state.site.plan = read_plan(geojson)
    publisher.publish_delta()
    pipeline.state.site.anchor = Anchor(48.0, 11.0, 0.0, 0.0)
    publisher.publish_delta()
    publisher.publish_delta()
    laid, anchored = screen.resets
    assert (bytes(laid.plan or b""), laid.anchor) == (geojson, None)
    assert anchored.anchor is not None
    assert anchored.anchor.lat_deg == 48.0


def test_console_that_joins_continues_with_the_next_delta() -> None:
    screen = Screen()
    publisher = walked(screen)
    publisher.mark_changed([UnitChanged("FF-01"), PinsChanged(())])
    shown, _ = publisher.snapshot()
    publisher.mark_changed([UnitChanged("FF-02")])
    publisher.publish_delta()
    before, after = new_deltas(screen)
    assert (before.seq, after.seq) == (shown.seq, shown.seq + 1)
    assert units_of([before, after]) == [["FF-01"], ["FF-02"]]
    assert after.pins is None


def test_console_that_joins_gets_every_trail_beside_the_snapshot() -> None:
    shown, trails = walked(Screen()).snapshot()
    assert [unit.unit_id for unit in shown.units] == UNITS
    assert {unit_id: msgspec.json.decode(points) for unit_id, points in trails.items()} == {
        unit_id: [[1000, 1.0, 2.0, 0]] for unit_id in UNITS
    }


def test_backfilled_trails_are_published_some_at_a_time() -> None:
    """A radio that is back fills all trails at once; positions do not wait for all of them."""
    screen = Screen()
    publisher = walked(screen)
    publisher.mark_changed([TrailBackfilled(unit_id) for unit_id in UNITS])
    publisher.publish_delta()
    assert not screen.deltas, "once a second will do"
    for health in (True, False, False, False, True):
        publisher.publish_delta(health)
    filled = [list(delta.trails) for delta in screen.deltas]
    assert [len(trails) for trails in filled] == [TRAILS_PER_DELTA, TRAILS_PER_DELTA, 3, 0], (
        "each once"
    )
    assert sorted(one for trails in filled for one in trails) == UNITS


def test_reset_replaces_unpublished_changes() -> None:
    screen = Screen()
    publisher = walked(screen)
    publisher.mark_changed([TrailBackfilled(unit_id) for unit_id in UNITS])
    publisher.publish_delta(health=True)
    publisher.reset()
    publisher.publish_delta()
    assert (len(screen.deltas), len(screen.resets)) == (1, 1)
