"""The black box returns the tracker's samples, complete or torn, within its share of the disk."""

from __future__ import annotations

import itertools
from dataclasses import replace
from functools import partial
from pathlib import Path
from threading import Event
from typing import Any

import numpy as np
import pytest

from edge.agent.fitted_sensor import FittedSensor
from edge.agent.pipeline import TrackerPipeline, UnitIdentity
from edge.sample_codec.codec import SampleEncoder, batch_of
from edge.sample_codec.descriptions import sensors_of, unit_sensor
from edge.samples import ButtonPress, ImuBatch, SensorBatch
from edge.sources.black_box import BlackBoxSource
from edge.sources.interface import Source
from edge.sources.registry import open_source
from edge.storage.black_box.black_box import BlackBox
from edge.storage.black_box.station_time import read_clock_offset
from edge.tracker.choice.one_sensor import OneSensorTracker
from edge.tracker.registry import make_tracker
from shared.clock import NS_PER_S, ManualClock
from shared.errors import RecordingError
from shared.header_factory import HeaderFactory
from shared.mcap_log import SegmentWriter
from shared.messages import Message, Position, Status, UnitEvent
from tests.rig.waiting import PATIENCE_S, until

SCENARIO = "simulated:climbs-stairs?seed=3"
BATCHES = 800


NO_IMU = ImuBatch(np.empty(0, np.int64), np.empty((0, 3)), np.empty((0, 3)))


class Ticking(ManualClock):
    """So that what is recorded is flushed now and then, and nothing at the same time as another."""

    def monotonic_ns(self) -> int:
        self.advance(0.01)
        return super().monotonic_ns()


def spoiled(source: Source) -> list[SensorBatch]:
    """Batches with what real sensors do: missed samples, repeated times, a pressed button."""
    batches = [batch for _, batch in zip(range(BATCHES), source.batches(), strict=False)]
    for number in range(20, BATCHES, 50):
        imu, others = batches[number].imu, batches[number].others
        accel = imu.accel_mps2.copy()
        accel[1] = np.nan
        t_ns = imu.t_ns.copy()
        t_ns[2] = t_ns[1]
        press = ButtonPress(int(t_ns[0]), "mayday" if number % 100 == 20 else "cancel")
        batches[number] = SensorBatch(replace(imu, accel_mps2=accel, t_ns=t_ns), (*others, press))
    return batches


def messages_of(source: Source, raw: SampleEncoder, batches: list[SensorBatch]) -> list[Message]:
    """Messages of a unit for these batches."""
    description = raw.description(
        0, (unit_sensor("", source.description),), source="", tracker="eskf"
    )
    sensor = sensors_of(description)[""]
    pipeline = TrackerPipeline(
        UnitIdentity("", "", "eskf", (FittedSensor(sensor),)),
        OneSensorTracker(make_tracker("eskf", sensor)),
        HeaderFactory("u1", 1, ManualClock()),
        5.0,
    )
    messages: list[Message] = []
    for batch in batches:
        presses = [one for one in batch.others if isinstance(one, ButtonPress)]
        messages += [*pipeline.take_presses(presses), *pipeline.step(batch)]
    return [*messages, *pipeline.finish()]


def record(folder: Path, clock: ManualClock | None = None) -> tuple[list[Message], Path]:
    """Record a walk; what the unit said of it, and the folder of its boot."""
    source = open_source(SCENARIO)
    raw = SampleEncoder("u1", 7)
    description = raw.description(0, (unit_sensor("", source.description),), source="", tracker="")
    box = BlackBox(folder, description, 10**9, clock or ManualClock())
    quantised = []
    for batch in spoiled(source):
        stream = raw.messages(batch)
        box.write(stream)
        quantised.append(batch_of(stream))
    box.close()
    assert box.fault == "the black box has stopped"
    (boot,) = folder.iterdir()
    return messages_of(source, raw, quantised), boot


@pytest.mark.slow
def test_a_replay_says_the_same_to_the_last_bit(tmp_path):
    reported, boot = record(tmp_path)
    source = BlackBoxSource(boot)
    replayed = messages_of(source, SampleEncoder("u1", 7), list(source.batches()))
    assert replayed == reported
    assert source.description.gain_std == open_source(SCENARIO).description.gain_std == 0.002
    kinds = {type(message) for message in reported}
    assert {Position, Status, UnitEvent} <= kinds
    positions = [message for message in reported if isinstance(message, Position)]
    assert positions[-1].distance_m > 3.0


@pytest.mark.slow
def test_a_replay_of_a_replay_is_the_same_recording(tmp_path):
    _, boot = record(tmp_path)
    source = BlackBoxSource(boot)
    raw = SampleEncoder("u1", 7)
    batches = list(source.batches())
    assert any(batch.others for batch in batches)
    for batch in batches:
        again = batch_of(raw.messages(batch))
        assert again.imu.accel_mps2.tobytes() == batch.imu.accel_mps2.tobytes()
        assert again.imu.t_ns.tobytes() == batch.imu.t_ns.tobytes()
        assert repr(again.others) == repr(batch.others)


def test_records_during_the_absence_of_the_sensor_are_played_at_their_times(tmp_path):
    """Fixes of a receiver beside it, each by itself: not all at once with the last sample."""
    raw = SampleEncoder("u1", 7)
    source = open_source(SCENARIO)
    description = raw.description(0, (unit_sensor("", source.description),), source="", tracker="")
    box = BlackBox(tmp_path, description, 10**9, Ticking())
    first, *_, last = itertools.islice(source.batches(), 100)
    first_ns = int(first.imu.t_ns[-1])
    presses = [ButtonPress(first_ns + second * NS_PER_S, "mayday") for second in range(1, 4)]
    alone = [SensorBatch(NO_IMU, (press,)) for press in presses]
    with_one = SensorBatch(first.imu, (ButtonPress(first_ns, "cancel"),))
    given = [with_one, *alone, last]
    for batch in given:
        box.write(raw.messages(batch))
    box.close()
    (boot,) = tmp_path.iterdir()
    played = list(BlackBoxSource(boot).batches())
    assert [len(batch.imu) for batch in played] == [len(batch.imu) for batch in given]
    assert [batch.others for batch in played[:4]] == [batch.others for batch in given[:4]]


@pytest.mark.slow
def test_a_torn_black_box_plays_up_to_the_tear(tmp_path):
    _, boot = record(tmp_path, Ticking())
    (segment,) = boot.iterdir()
    whole = sum(len(batch.imu) for batch in BlackBoxSource(segment).batches())
    segment.write_bytes(segment.read_bytes()[: segment.stat().st_size // 2])
    torn = sum(len(batch.imu) for batch in BlackBoxSource(segment).batches())
    assert 0.2 * whole < torn < 0.8 * whole


def boxed(folder: Path, clock: ManualClock, **more: Any) -> tuple[BlackBox, SampleEncoder]:
    raw = SampleEncoder("u1", 7)
    description = raw.description(
        0, (unit_sensor("", open_source(SCENARIO).description),), source="", tracker=""
    )
    return BlackBox(folder, description, 10**9, clock, **more), raw


def written(box: BlackBox) -> None:
    """All that was given has been taken from the queue, and the batch before it written."""
    until(box._waiting.empty)


@pytest.mark.slow
def test_any_segment_can_be_played_by_itself(tmp_path):
    """A station fetches those of its window."""
    clock = ManualClock()
    box, raw = boxed(tmp_path, clock)
    for batch in itertools.islice(open_source(SCENARIO).batches(), 100):
        box.write(raw.messages(batch))
        written(box)
        clock.advance(3.0)
    box.close()
    segments = list(tmp_path.glob("*/*.mcap"))
    assert len(segments) >= 3
    assert sum(1 for one in segments for _ in BlackBoxSource(one).batches()) == 100


def test_last_samples_are_saved_without_later_ones(tmp_path):
    """The sensor has failed, and then the unit is switched off."""
    clock = ManualClock()
    box, raw = boxed(tmp_path, clock)
    box.write(raw.messages(next(open_source(SCENARIO).batches())))

    def is_there() -> bool:
        clock.advance(1.0)
        try:
            return any(
                True for one in tmp_path.glob("*/*.mcap") for _ in BlackBoxSource(one).batches()
            )
        except RecordingError:  # a segment is being begun: nothing of it is on the disk yet
            return False

    until(is_there)
    box.close()


def is_noted(boot: Path, ahead_s: float) -> bool:
    return read_clock_offset(boot) == round(ahead_s * NS_PER_S)


def test_how_far_its_time_is_off_is_noted_again_where_the_station_s_was_set(tmp_path):
    class Set(ManualClock):
        def set_back(self, by_s: float) -> None:
            self._utc_offset_ns -= round(by_s * NS_PER_S)

    clock = Set()
    box, raw = boxed(tmp_path, clock, utc_std_s=lambda: 0.1)
    (boot,) = tmp_path.iterdir()
    batches = open_source(SCENARIO).batches()
    for set_back_s, ahead_s in ((0.0, 0), (0.5, 0), (3600.0, 3600.5)):
        clock.set_back(set_back_s)
        box.write(raw.messages(next(batches)))
        until(partial(is_noted, boot, ahead_s))
    box.close()


def test_a_disk_that_hangs_costs_samples_and_not_the_unit_s_memory(tmp_path, monkeypatch, caplog):
    start_request, answers = Event(), Event()

    class Hanging(SegmentWriter):
        def write(self, *what: Any, **how: Any) -> bool:
            start_request.set()
            answers.wait(PATIENCE_S)
            return super().write(*what, **how)

    monkeypatch.setattr("edge.storage.black_box.black_box.SegmentWriter", Hanging)
    monkeypatch.setattr("edge.storage.black_box.black_box._WAITING_MAX", 3)
    monkeypatch.setattr("edge.storage.disk_watchdog.HANGS_S", 0.0)
    box, raw = boxed(tmp_path, ManualClock())
    batches = [raw.messages(one) for one in itertools.islice(open_source(SCENARIO).batches(), 50)]
    box.write(batches[0])
    assert start_request.wait(PATIENCE_S)
    for batch in batches[1:]:
        box.write(batch)
    assert box._waiting.qsize() == 3
    assert "has not answered" in str(box.fault)
    monkeypatch.setattr("edge.storage.disk_watchdog.HANGS_S", PATIENCE_S)
    answers.set()
    box.close()
    assert "46 batches of samples are not kept" in caplog.text
    assert sum(1 for _ in BlackBoxSource(next(tmp_path.iterdir())).batches()) == 4


def fill(folder: Path, boot_id: int, clock: ManualClock) -> Path:
    """Record a walk where there is room for one or two; the folder of its boot."""
    source = open_source(SCENARIO)
    raw = SampleEncoder("u1", boot_id)
    description = raw.description(0, (unit_sensor("", source.description),), source="", tracker="")
    box = BlackBox(folder, description, 60_000, clock)
    for batch in spoiled(source):
        box.write(raw.messages(batch))
    box.close()
    (boot,) = folder.glob(f"*{boot_id:016x}")
    return boot


@pytest.mark.slow
def test_the_oldest_recordings_make_room(tmp_path):
    clock = ManualClock()
    boots = []
    for boot_id in range(3):
        boots.append(fill(tmp_path, boot_id, clock))
        clock.advance(100.0)
    assert not boots[0].exists()
    assert boots[2].exists()


@pytest.mark.slow
def test_a_clock_that_was_never_set_does_not_make_the_newest_the_oldest(tmp_path):
    before = fill(tmp_path, 1, ManualClock())
    new = fill(tmp_path, 2, ManualClock(utc_ns=0))
    assert new.name < before.name
    assert not before.exists()
    assert new.exists()


@pytest.mark.slow
def test_folder_that_is_no_black_box_is_refused_with_a_reason(tmp_path):
    with pytest.raises(RecordingError, match="there is no black box"):
        BlackBoxSource(tmp_path / "nothing")
    with pytest.raises(RecordingError, match="holds no segments"):
        BlackBoxSource(tmp_path)
    (tmp_path / "000001-20260301T100000Z.mcap").write_bytes(b"no mcap at all")
    with pytest.raises(RecordingError, match="is no black box"):
        BlackBoxSource(tmp_path)
    record(tmp_path / "box")
    with pytest.raises(RecordingError, match="choose one of"):
        BlackBoxSource(tmp_path / "box")
