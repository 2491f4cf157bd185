"""What a unit sends, how often, and that the batching of its samples does not matter."""

from __future__ import annotations

import math
from dataclasses import replace
from datetime import UTC, datetime
from itertools import pairwise

import numpy as np
import pytest

from edge.calibration import Calibration, identity
from edge.calibration.model import Gyroscope
from edge.pipeline import TrackerPipeline, UnitIdentity
from edge.samples import (
    AmbientSample,
    BatterySample,
    ButtonPress,
    GpsSample,
    ImuBatch,
    SensorBatch,
    SensorDescription,
    SightingSample,
)
from edge.timeline import Timeline
from edge.tracker.port import Quality, Reason, TrackBatch
from shared.clock import NS_PER_S, ManualClock
from shared.earth_field import EarthField
from shared.envelope import Stamper
from shared.messages import (
    Activity,
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

RATE_HZ = 100
SENSOR = SensorDescription("fake", RATE_HZ)


class StraightAhead:
    """A tracker that has everyone walk north at 1 m/s with a stride a second."""

    def __init__(self, spoil: bool = False, north_std_rad: float = np.inf) -> None:
        self._spoil = spoil
        self.north_std_rad = north_std_rad
        self.learned: list[tuple[EarthField, int]] = []

    def push(self, batch: ImuBatch) -> TrackBatch:
        n = len(batch)
        t_s = batch.t_ns / NS_PER_S
        position = np.zeros((n, 3))
        position[:, 0] = np.nan if self._spoil else t_s
        return TrackBatch(
            t_ns=batch.t_ns,
            position_n_m=position,
            velocity_n_mps=np.tile([1.0, 0.0, 0.0], (n, 1)),
            quaternion_nb=np.tile([1.0, 0.0, 0.0, 0.0], (n, 1)),
            position_cov_m2=np.tile(np.diag([0.04, 0.01, 0.09]), (n, 1, 1)),
            heading_std_rad=np.full(n, 0.1),
            stationary=t_s % 1.0 < 0.4,
            distance_m=t_s,
            steps=np.floor(t_s).astype(np.int64),
            quality=np.full(n, Quality.DEGRADED, np.uint8),
            reasons=np.full(n, Reason.NO_STANCE, np.uint32),
            magnetic_north_rad=np.full(n, 0.3),
            magnetic_north_std_rad=np.full(n, self.north_std_rad),
        )

    def learn_field(self, field: EarthField, t_ns: int) -> None:
        self.learned.append((field, t_ns))

    def finish(self) -> TrackBatch:
        return self.push(walk(0))


def walk(n: int, start_s: float = 0.0, shake_mps2: float = 3.0) -> ImuBatch:
    t_ns = (np.arange(n) * NS_PER_S // RATE_HZ) + round(start_s * NS_PER_S)
    accel = np.tile([0.0, 0.0, 9.81], (n, 1))
    accel[:, 0] = shake_mps2 * np.sin(40.0 * t_ns / NS_PER_S)
    accel[:, 1] = 1e-4 * np.arange(n)  # never the same twice
    return ImuBatch(t_ns, accel, np.zeros((n, 3)), pressure_pa=np.linspace(0, n - 1, n) + 100_000.0)


def pipeline(tracker=None, rate_hz: float = 5.0) -> TrackerPipeline:
    identity = UnitIdentity("1.0", "test", "straight", SENSOR)
    stamper = Stamper("u1", 7, ManualClock())
    return TrackerPipeline(identity, tracker or StraightAhead(), stamper, rate_hz)


def steps(pipe, imu: ImuBatch, sizes: list[int], others=()):
    """All messages when ``imu`` comes in batches of these sizes."""
    messages = []
    cuts = [0, *np.cumsum(sizes).tolist(), len(imu)]
    for start, stop in pairwise(cuts):
        part = ImuBatch(
            imu.t_ns[start:stop],
            imu.accel_mps2[start:stop],
            imu.gyro_radps[start:stop],
            pressure_pa=None if imu.pressure_pa is None else imu.pressure_pa[start:stop],
        )
        messages += pipe.step(SensorBatch(part))
    return messages


def of(messages, kind):
    return [message for message in messages if isinstance(message, kind)]


def test_channels_have_the_rates_of_the_table():
    messages = steps(pipeline(), walk(120 * RATE_HZ), [5] * (120 * RATE_HZ // 5))
    assert len(of(messages, Position)) == 5 * 120
    assert len(of(messages, Status)) == 120
    assert len(of(messages, UnitDescription)) == 2


def test_it_begins_with_a_start_and_a_description():
    event, description = pipeline().start()
    assert isinstance(event, UnitEvent)
    assert event.kind is EventKind.STARTED
    assert isinstance(description, UnitDescription)
    assert (description.sensor_name, description.tracker) == ("fake", "straight")


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


def test_a_position_says_what_the_row_says():
    position = of(steps(pipeline(), walk(1000), []), Position)[-1]
    t_s = position.header.t_mono_ns / NS_PER_S
    assert position.north_m == pytest.approx(t_s)
    assert (position.std_north_m, position.std_east_m) == (pytest.approx(0.2), pytest.approx(0.1))
    assert position.heading_rad == 0.0
    assert position.distance_m == pytest.approx(t_s)
    assert position.pressure_pa == pytest.approx(100_000.0 + t_s * RATE_HZ)
    assert (position.quality, position.reasons) == (Quality.DEGRADED, Reason.NO_STANCE)


def test_rows_that_are_no_numbers_are_counted_and_not_sent():
    messages = steps(pipeline(StraightAhead(spoil=True)), walk(300), [])
    assert not of(messages, Position)
    assert of(messages, Status)[-1].tracker_rows_dropped == 300


def test_the_position_rate_can_be_changed_on_the_way():
    pipe = pipeline()
    pipe.set_position_rate(20.0)
    assert len(of(steps(pipe, walk(1000), [5] * 199), Position)) == 200


def test_messages_carry_time_on_the_units_clock():
    timeline = Timeline(source_origin_ns=0, mono_origin_ns=50 * NS_PER_S, speed=2.0)
    messages = pipeline().step(SensorBatch(walk(1000)), timeline)
    last = of(messages, Position)[-1]
    assert last.header.t_mono_ns == 50 * NS_PER_S + round(last.north_m * NS_PER_S / 2)


def test_sequence_numbers_have_no_hole_and_rise():
    messages = steps(pipeline(), walk(3000), [5] * 599)
    assert [message.header.seq for message in messages] == list(range(1, len(messages) + 1))


def others_only(*others):
    return SensorBatch(walk(0), others)


def test_gps_and_temperature_come_once_a_second_at_most():
    pipe = pipeline()
    messages: list[Message] = []
    for tenth in range(100):
        t_ns = tenth * NS_PER_S // 10
        fix = GpsSample(t_ns, 50.0, 8.0, math.nan, 3.0, math.nan, 3, 9, math.nan, math.nan)
        messages += pipe.step(others_only(AmbientSample(t_ns, 21.5), fix))
    assert len(of(messages, Temperature)) == 10
    assert len(of(messages, GpsFix)) == 10
    assert of(messages, Temperature)[0].ambient_degc == 21.5


def test_what_is_not_a_number_is_not_sent():
    pipe = pipeline()
    fix = GpsSample(0, math.nan, 8.0, 1.0, math.nan, math.nan, 3, 9, math.nan, math.nan)
    messages = pipe.step(others_only(AmbientSample(0, math.nan), fix))
    assert not of(messages, Temperature)
    (sent,) = of(messages, GpsFix)
    assert sent.fix_type == 1  # no fix
    sent.to_wire()


def test_mayday_latches_until_the_wearer_takes_it_back():
    pipe = pipeline()
    pressed = of(pipe.step(others_only(ButtonPress(1, "mayday"))), UnitEvent)
    assert [event.kind for event in pressed] == [EventKind.MAYDAY]
    assert not of(pipe.step(others_only(ButtonPress(2, "mayday"))), UnitEvent)
    assert of(steps(pipe, walk(300), []), Status)[-1].mayday
    assert not of(pipe.step(others_only(ButtonPress(3, "acknowledge"))), UnitEvent)
    cancelled = of(pipe.step(others_only(ButtonPress(4 * NS_PER_S, "cancel"))), UnitEvent)
    assert [event.kind for event in cancelled] == [EventKind.MAYDAY_CANCELLED]
    assert not of(steps(pipe, walk(300, 5.0), []), Status)[-1].mayday


def test_what_is_near_is_told_once_a_second_and_nothing_costs_no_number():
    pipe = pipeline()
    near = SightingSample(0, "beacon", "door-3", 2.5, math.nan)
    said = [
        message
        for sample in (
            near,
            replace(near, t_ns=NS_PER_S // 2),
            replace(near, t_ns=NS_PER_S),
            replace(near, seen_id="door-4"),
            replace(near, kind="ghost"),
            replace(near, seen_id=""),
            replace(near, kind="unit", seen_id="FF-02"),
        )
        for message in pipe.step(others_only(sample))
    ]
    seen = of(said, Sighting)
    assert [one.seen_id for one in seen] == ["door-3", "door-3", "door-4", "FF-02"]
    assert (seen[0].kind, seen[0].range_m, seen[0].range_std_m) == (SightingKind.BEACON, 2.5, None)
    seqs = [message.header.seq for message in said]
    assert seqs == list(range(seqs[0], seqs[0] + len(seqs)))


def test_status_tells_battery_and_journal():
    pipe = pipeline()
    pipe.step(others_only(BatterySample(0, 0.42)))
    pipe.note_journal(17)
    status = of(steps(pipe, walk(300, 2.0), []), Status)[-1]
    assert (status.battery, status.journal_pending) == (0.42, 17)


def test_walking_shows_steps_and_cadence():
    status = of(steps(pipeline(), walk(1000), [50] * 19), Status)[-1]
    assert status.activity is Activity.WALKING
    assert status.steps == 2 * 9
    assert status.cadence_hz == pytest.approx(2.0)


def test_a_sensor_that_delivers_nothing_usable_is_a_fault_told_once():
    imu = walk(400)
    spoiled = replace(imu, accel_mps2=np.full((400, 3), np.nan))
    events = of(steps(pipeline(), spoiled, [5] * 79), UnitEvent)
    assert [event.kind for event in events] == [EventKind.SENSOR_FAULT]


def test_a_gap_and_a_clock_that_goes_back_are_told():
    pipe = pipeline()
    steps(pipe, walk(100), [])
    (gap,) = of(steps(pipe, walk(100, 5.0), []), UnitEvent)
    assert "no inertial sample for 4.0 s" in gap.detail
    (back,) = of(steps(pipe, walk(100, 1.0), []), UnitEvent)
    assert "went back" in back.detail


def test_a_clock_that_jumps_a_day_in_either_direction_stops_nothing():
    pipe = pipeline()
    steps(pipe, walk(500), [5] * 99)
    for start_s in (86_400.0, 0.0):
        messages = steps(pipe, walk(500, start_s), [5] * 99)
        assert len(of(messages, Position)) == 25
        assert len(of(messages, Status)) == 5


def test_the_tracker_gets_calibrated_samples_and_the_description_says_by_which():
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
    identified = UnitIdentity("1.0", "test", "straight", SENSOR, calibration)
    pipe = TrackerPipeline(identified, Listening(), Stamper("u1", 7, ManualClock()), 5.0)
    (description,) = of(pipe.start(), UnitDescription)
    assert description.calibration == identity(calibration)
    assert description.calibrated_s == made.timestamp()
    assert description.calibration_faults == "gyroscope off by 0.573 deg/s"
    imu = walk(10)
    steps(pipe, imu, [10])
    assert seen[0].gyro_radps[0].tolist() == [-0.1, -0.2, -0.3]
    assert imu.gyro_radps[0].tolist() == [0.0, 0.0, 0.0]


def test_without_a_calibration_the_description_names_none():
    (description,) = of(pipeline().start(), UnitDescription)
    assert (description.calibration, description.calibrated_s) == ("", None)


def test_magnetic_north_is_said_where_the_tracker_knows_it():
    def norths(std_rad: float):
        messages = steps(pipeline(StraightAhead(north_std_rad=std_rad)), walk(100), [100])
        return {position.magnetic_north for position in of(messages, Position)}

    assert norths(0.1) == {MagneticNorth(0.3, 0.1)}
    assert norths(math.inf) == {None}
    assert norths(math.nan) == {None}
    assert norths(2.0) == {None}  # that would tell nothing
