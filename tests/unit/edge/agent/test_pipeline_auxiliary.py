"""Messages beside the path: fixes, temperatures, alerts, sightings, the calibration."""

from __future__ import annotations

import math
from dataclasses import replace
from datetime import UTC, datetime

import pytest

from edge.agent.fitted_sensor import FittedSensor
from edge.agent.pipeline import TrackerPipeline, UnitIdentity
from edge.calibration.file import identity
from edge.calibration.model import Calibration, Gyroscope
from edge.samples import (
    AmbientSample,
    BatterySample,
    ButtonPress,
    GpsSample,
    ImuBatch,
    SensorBatch,
    SightingSample,
)
from edge.tracker.choice.one_sensor import OneSensorTracker
from edge.tracker.interface import TrackBatch
from shared.clock import NS_PER_S, ManualClock
from shared.header_factory import HeaderFactory
from shared.messages import (
    EventKind,
    GpsFix,
    MagneticNorth,
    Message,
    Position,
    Sighting,
    SightingKind,
    Status,
    Temperature,
    UnitDescription,
    UnitEvent,
)
from tests.rig.straight_tracker import SENSOR, StraightAhead, of, pipeline, steps, walk


def others_only(*others):
    return SensorBatch(walk(0), others)


def test_gps_and_temperature_come_once_a_second():
    pipe = pipeline()
    messages: list[Message] = []
    for tenth in range(100):
        t_ns = tenth * NS_PER_S // 10
        fix = GpsSample(t_ns, 50.0, 8.0, math.nan, 3.0, math.nan, 3, 9, math.nan, math.nan)
        messages += pipe.step(others_only(AmbientSample(t_ns, 21.5), fix))
    assert len(of(messages, Temperature)) == 10
    assert len(of(messages, GpsFix)) == 11  # the first one in the middle of its second
    assert of(messages, Temperature)[0].ambient_degc == 21.5


def test_value_that_is_not_a_number_is_not_sent():
    pipe = pipeline()
    fix = GpsSample(0, math.nan, 8.0, 1.0, math.nan, math.nan, 3, 9, math.nan, math.nan)
    messages = pipe.step(others_only(AmbientSample(0, math.nan), fix))
    assert not of(messages, Temperature)
    (sent,) = of(messages, GpsFix)
    assert sent.fix_type == 1  # no fix
    sent.to_wire()


def test_mayday_is_latched_until_the_wearer_cancels_it():
    pipe = pipeline()
    pressed = of(pipe.take_presses((ButtonPress(1, "mayday"),)), UnitEvent)
    assert [event.kind for event in pressed] == [EventKind.MAYDAY]
    assert not of(pipe.take_presses((ButtonPress(2, "mayday"),)), UnitEvent)
    assert of(steps(pipe, walk(300), []), Status)[-1].mayday
    assert not of(pipe.take_presses((ButtonPress(3, "acknowledge"),)), UnitEvent)
    cancelled = of(pipe.take_presses((ButtonPress(4 * NS_PER_S, "cancel"),)), UnitEvent)
    assert [event.kind for event in cancelled] == [EventKind.MAYDAY_CANCELLED]
    assert not of(steps(pipe, walk(300, 5.0), []), Status)[-1].mayday


@pytest.mark.parametrize(("again_s", "says"), [(0.5, 0), (2.9, 0), (3.1, 1), (600.0, 1), (-5.0, 1)])
def test_second_press_is_sent_again(again_s: float, says: int):
    """The first mayday has been resolved, and its wearer is in need again."""
    pipe = pipeline()
    pipe.take_presses((ButtonPress(10 * NS_PER_S, "mayday"),))
    again_ns = round((10.0 + again_s) * NS_PER_S)
    events = of(pipe.take_presses((ButtonPress(again_ns, "mayday"),)), UnitEvent)
    assert [event.kind for event in events] == [EventKind.MAYDAY] * says


def test_press_after_a_cancellation_is_sent_at_once():
    pipe = pipeline()
    kinds = [
        event.kind
        for tenth, button in enumerate(("mayday", "cancel", "cancel", "mayday"))
        for event in of(pipe.take_presses((ButtonPress(tenth * 10**8, button),)), UnitEvent)
    ]
    assert kinds == [EventKind.MAYDAY, EventKind.MAYDAY_CANCELLED, EventKind.MAYDAY]


def test_sightings_are_reported_though_the_clock_went_back():
    pipe = pipeline()
    for t_s in (7200, 3600, 3601):
        near = SightingSample(t_s * NS_PER_S, "beacon", "door-3", 2.5, math.nan)
        assert len(of(pipe.step(others_only(near)), Sighting)) == 1


def test_sightings_are_reported_once_a_second_and_none_takes_no_number():
    pipe = pipeline()
    hour_ns = 3600 * NS_PER_S
    near = SightingSample(hour_ns, "beacon", "door-3", 2.5, math.nan)
    reported = [
        message
        for sample in (
            near,
            replace(near, t_ns=hour_ns + NS_PER_S // 2),
            replace(near, t_ns=hour_ns + NS_PER_S),
            replace(near, seen_id="door-4"),
            replace(near, kind="ghost"),
            replace(near, seen_id=""),
            replace(near, kind="unit", seen_id="FF-02"),
        )
        for message in pipe.step(others_only(sample))
    ]
    seen = of(reported, Sighting)
    assert [one.seen_id for one in seen] == ["door-3", "door-3", "door-4", "FF-02"]
    assert (seen[0].kind, seen[0].range_m, seen[0].range_std_m) == (SightingKind.BEACON, 2.5, None)
    seqs = [message.header.seq for message in reported]
    assert seqs == list(range(seqs[0], seqs[0] + len(seqs)))


def test_status_has_battery_and_journal():
    pipe = pipeline()
    pipe.step(others_only(BatterySample(0, 0.42)))
    pipe.set_journal_pending(17)
    status = of(steps(pipe, walk(300, 2.0), []), Status)[-1]
    assert (status.battery, status.journal_pending) == (0.42, 17)


def test_tracker_gets_calibrated_samples_and_the_description_names_the_calibration():
    seen: list[ImuBatch] = []

    class Listening(StraightAhead):
        def push(self, batch: ImuBatch) -> TrackBatch:
            seen.append(batch)
            return super().push(batch)

    made = datetime(2026, 3, 1, tzinfo=UTC)
    gyroscope = Gyroscope(
        bias_radps=(0.1, 0.2, 0.3), bias_std_radps=(0.0, 0.0, 0.0), residual_radps=0.01
    )
    calibration = Calibration("u1", "fake", made, gyroscope=gyroscope)
    identified = UnitIdentity("1.0", "test", "straight", (FittedSensor(SENSOR, calibration),))
    pipe = TrackerPipeline(
        identified, OneSensorTracker(Listening()), HeaderFactory("u1", 7, ManualClock()), 5.0
    )
    (description,) = of(pipe.start(), UnitDescription)
    assert description.calibration == identity(calibration)
    assert description.calibrated_s == made.timestamp()
    assert description.calibration_faults == "gyroscope off by 0.573 deg/s"
    imu = walk(10)
    steps(pipe, imu, [10])
    assert seen[0].gyro_radps[0].tolist() == [-0.1, -0.2, -0.3]
    assert imu.gyro_radps[0].tolist() == [0.0, 0.0, 0.0]


def test_description_without_a_calibration_names_none():
    (description,) = of(pipeline().start(), UnitDescription)
    assert (description.calibration, description.calibrated_s) == ("", None)


def test_magnetic_north_is_sent_where_the_tracker_knows_it():
    def norths(std_rad: float):
        messages = steps(pipeline(StraightAhead(north_std_rad=std_rad)), walk(100), [100])
        return {position.magnetic_north for position in of(messages, Position)}

    assert norths(0.1) == {MagneticNorth(0.3, 0.1)}
    assert norths(math.inf) == {None}
    assert norths(math.nan) == {None}
    assert norths(2.0) == {None}  # that would tell nothing
