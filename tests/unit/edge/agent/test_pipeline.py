"""Messages of a unit's path and their rates, in any batching of its samples."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from edge.agent.fitted_sensor import FittedSensor
from edge.agent.pipeline import TrackerPipeline, UnitIdentity
from edge.clocks.timeline import Timeline
from edge.samples import SensorBatch, SensorDescription
from edge.tracker.choice.interface import Choice
from edge.tracker.choice.one_sensor import OneSensorTracker
from edge.tracker.interface import Quality, Reason
from shared.clock import NS_PER_S, ManualClock
from shared.header_factory import HeaderFactory
from shared.messages import (
    Activity,
    BodyPosture,
    EventKind,
    Mobility,
    Position,
    Status,
    UnitDescription,
    UnitEvent,
)
from tests.rig.body_postures import PostureStay, posed_body
from tests.rig.straight_tracker import RATE_HZ, SENSOR, StraightAhead, of, pipeline, steps, walk


@pytest.mark.slow
def test_channels_have_the_rates_of_the_table():
    messages = steps(pipeline(), walk(120 * RATE_HZ), [5] * (120 * RATE_HZ // 5))
    assert len(of(messages, Position)) == 5 * 120
    assert len(of(messages, Status)) == 120
    assert len(of(messages, UnitDescription)) == 2


def test_messages_begin_with_a_start_and_a_description():
    event, description = pipeline().start()
    assert isinstance(event, UnitEvent)
    assert event.kind is EventKind.STARTED
    assert isinstance(description, UnitDescription)
    assert (description.sensor_name, description.tracker) == ("fake", "straight")


@pytest.mark.slow
@pytest.mark.parametrize("sizes", [[1] * 999, [7] * 140, [500], [333, 1, 600]])
def test_positions_do_not_depend_on_the_batching(sizes):
    imu = walk(1000)
    whole = of(steps(pipeline(), imu, []), Position)
    parts = of(steps(pipeline(), imu, sizes), Position)
    for one, other in zip(whole, parts, strict=True):
        assert replace_header(one) == replace_header(other)
        assert one.header.t_mono_ns == other.header.t_mono_ns


def replace_header(position: Position):
    return {
        name: getattr(position, name) for name in position.__struct_fields__ if name != "header"
    }


def test_position_equals_its_row():
    position = of(steps(pipeline(), walk(1000), []), Position)[-1]
    t_s = position.header.t_mono_ns / NS_PER_S
    assert position.north_m == pytest.approx(t_s)
    assert (position.std_north_m, position.std_east_m) == (pytest.approx(0.2), pytest.approx(0.1))
    assert position.heading_rad == 0.0
    assert position.distance_m == pytest.approx(t_s)
    assert position.pressure_pa == pytest.approx(100_000.0 + t_s * RATE_HZ)
    assert (position.quality, position.reasons) == (Quality.DEGRADED, Reason.NO_STANCE)


def test_positions_are_lost_while_the_unit_moves_as_no_foot_does():
    """A hip turns slowly, and never rests while its wearer walks."""
    imu = walk(2000)
    bounce = np.zeros((len(imu), 3))
    bounce[:, 2] = 3.0 * np.sin(12.0 * imu.t_ns / NS_PER_S)
    on_hip = replace(imu, accel_mps2=imu.accel_mps2 + bounce, gyro_radps=imu.gyro_radps + 1.0)
    first, *_, last = of(steps(pipeline(), on_hip, [5] * 399), Position)
    assert (first.quality, first.reasons) == (Quality.DEGRADED, Reason.NO_STANCE)
    assert (last.quality, last.reasons) == (Quality.LOST, Reason.NO_STANCE | Reason.NOT_ON_FOOT)
    assert last.path_quality is Quality.LOST


def test_rows_that_are_no_numbers_are_counted_and_not_sent():
    messages = steps(pipeline(StraightAhead(spoil=True)), walk(300), [])
    assert not of(messages, Position)
    assert of(messages, Status)[-1].tracker_rows_dropped == 300


class ChoosesItself(OneSensorTracker):
    """Tracker that has chosen itself."""

    choice = Choice("body", notes=("the compass is missing",))


def test_what_does_not_fit_a_tracker_that_chooses_itself_is_reported_once():
    identity = UnitIdentity("1.0", "test", "auto", (FittedSensor(SENSOR),))
    header_factory = HeaderFactory("u1", 7, ManualClock())
    pipe = TrackerPipeline(identity, ChoosesItself(StraightAhead()), header_factory, 5.0)
    messages = steps(pipe, walk(300), [100, 100])
    faults = [one for one in of(messages, UnitEvent) if one.kind is EventKind.SENSOR_FAULT]
    assert [one.detail for one in faults] == ["the compass is missing"]


def test_position_rate_can_be_changed_during_the_run():
    pipe = pipeline()
    pipe.set_position_rate(20.0)
    assert len(of(steps(pipe, walk(1000), [5] * 199), Position)) == 200


def test_messages_carry_time_on_the_units_clock():
    timeline = Timeline(source_origin_ns=0, mono_origin_ns=50 * NS_PER_S, speed=2.0)
    messages = pipeline().step(SensorBatch(walk(1000)), timeline)
    last = of(messages, Position)[-1]
    assert last.header.t_mono_ns == 50 * NS_PER_S + round(last.north_m * NS_PER_S / 2)


def test_sequence_numbers_have_no_gap_and_rise():
    messages = steps(pipeline(), walk(3000), [5] * 599)
    assert [message.header.seq for message in messages] == list(range(1, len(messages) + 1))


def test_walking_shows_steps_and_cadence():
    status = of(steps(pipeline(), walk(1000), [50] * 19), Status)[-1]
    assert status.activity is Activity.WALKING
    assert status.steps == 2 * 9
    assert status.cadence_hz == pytest.approx(2.0)


def test_sensor_without_usable_samples_is_a_fault_reported_once():
    imu = walk(400)
    spoiled = replace(imu, accel_mps2=np.full((400, 3), np.nan))
    events = of(steps(pipeline(), spoiled, [5] * 79), UnitEvent)
    assert [event.kind for event in events] == [EventKind.SENSOR_FAULT]


def test_gap_and_clock_that_goes_back_are_reported():
    pipe = pipeline()
    steps(pipe, walk(100), [])
    (gap,) = of(steps(pipe, walk(100, 5.0), []), UnitEvent)
    assert "no inertial sample for 4.0 s" in gap.detail
    (back,) = of(steps(pipe, walk(100, 1.0), []), UnitEvent)
    assert "went back" in back.detail


def test_clock_that_jumps_a_day_in_either_direction_stops_nothing():
    pipe = pipeline()
    steps(pipe, walk(500), [5] * 99)
    for start_s in (86_400.0, 0.0):
        messages = steps(pipe, walk(500, start_s), [5] * 99)
        assert len(of(messages, Position)) == 25
        assert len(of(messages, Status)) == 5


def test_trunk_that_lies_down_is_in_the_status_with_its_confidence():
    acts = [
        PostureStay(BodyPosture.STANDING, 15.0, walks=True),
        PostureStay(BodyPosture.PRONE, 10.0),
    ]
    chest = posed_body(acts, np.random.default_rng(1)).samples["chest"]
    sensor = FittedSensor(SensorDescription("fake", 100.0))
    pipe = TrackerPipeline(
        UnitIdentity("1.0", "test", "straight", (sensor,)),
        OneSensorTracker(StraightAhead()),
        HeaderFactory("u1", 7, ManualClock()),
        5.0,
        worn_on="waist",
    )
    reported = [
        message
        for first in range(0, len(chest), 10)
        for message in pipe.step(SensorBatch(chest.part(slice(first, first + 10))))
    ]
    statuses = of(reported, Status)
    assert statuses[0].posture is BodyPosture.UNKNOWN
    assert statuses[14].posture is BodyPosture.UPRIGHT
    assert statuses[14].mobility is Mobility.FORWARD
    assert statuses[-1].posture is BodyPosture.PRONE
    assert statuses[-1].posture_confidence > 0.8
    assert statuses[-1].mobility is Mobility.STILL
    read = Status.from_wire(statuses[-1].to_wire())
    assert (read.posture, read.mobility) == (BodyPosture.PRONE, Mobility.STILL)
    assert read.posture_confidence == pytest.approx(statuses[-1].posture_confidence, abs=1e-3)
