"""A source is read in the background: paced, bounded, and free to fail or hang."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator

import numpy as np
import pytest

from edge.agent.source_reader import SourceReader, TimedBatch
from edge.samples import BatterySample, ButtonPress, ImuBatch, SensorBatch, SensorDescription
from edge.sources.interface import Outage
from shared.clock import NS_PER_S, ManualClock, SystemClock
from shared.errors import RecordingError


class Scripted:
    """A source that does what a test wants, batch by batch."""

    def __init__(self, script: Callable[[], Iterator[SensorBatch]], *, live: bool = False) -> None:
        self._script = script
        self._live = live
        self.closed = False

    @property
    def description(self) -> SensorDescription:
        return SensorDescription("scripted", 100.0)

    @property
    def is_live(self) -> bool:
        return self._live

    @property
    def radio_outages(self) -> tuple[Outage, ...]:
        return ()

    def batches(self) -> Iterator[SensorBatch]:
        return self._script()

    def close(self) -> None:
        self.closed = True


class FinishedSource:
    """Something beside a source, that has said all it says."""

    def __init__(self, *samples: BatterySample) -> None:
        self._samples = samples
        self.closed = False

    def start(self) -> None:
        pass

    def take(self) -> tuple[BatterySample, ...]:
        samples, self._samples = self._samples, ()
        return samples

    def take_faults(self) -> tuple[str, ...]:
        return ("it is loose",)

    def close(self) -> None:
        self.closed = True


def batch(t_s: float) -> SensorBatch:
    t_ns = np.array([round(t_s * NS_PER_S)])
    return SensorBatch(ImuBatch(t_ns, np.zeros((1, 3)), np.zeros((1, 3))))


def everything(reader: SourceReader) -> list[TimedBatch]:
    reader.start()
    taken = []
    while not reader.ended:
        timed = reader.take(0.05)
        if timed is not None:
            taken.append(timed)
    reader.close()
    return taken


def test_a_recording_is_handed_out_when_it_is_due():
    source = Scripted(lambda: (batch(5.0 + tenth / 10) for tenth in range(5)))
    began_ns = time.monotonic_ns()
    reader = SourceReader(source, SystemClock(), 1.0)
    reader.start()
    for number in range(5):
        timed = reader.take(30.0)
        assert timed is not None
        t_ns = int(timed.batch.imu.t_ns[-1])
        assert time.monotonic_ns() >= timed.timeline.to_mono_ns(t_ns) >= began_ns
        assert timed.since_start_s == pytest.approx(number / 10)
    reader.close()
    assert source.closed


def test_without_pacing_nothing_waits_and_nothing_is_missed():
    source = Scripted(lambda: (batch(float(second)) for second in range(500)))
    taken = everything(SourceReader(source, SystemClock(), None))
    assert [timed.since_start_s for timed in taken] == [float(second) for second in range(500)]


def test_a_live_source_keeps_its_own_times():
    source = Scripted(lambda: iter([batch(1000.0), batch(2000.0)]), live=True)
    taken = everything(SourceReader(source, SystemClock(), 1.0))
    assert [timed.timeline.to_mono_ns(7) for timed in taken] == [7, 7]


@pytest.mark.parametrize("error", [RecordingError("it is torn"), OSError("no such device")])
def test_a_source_that_fails_ends_with_the_reason(error):
    def script() -> Iterator[SensorBatch]:
        yield batch(0.0)
        raise error

    reader = SourceReader(Scripted(script), SystemClock(), None)
    assert len(everything(reader)) == 1
    assert reader.failure is not None
    assert str(error) in reader.failure


def test_hanging_source_delays_no_other():
    release = threading.Event()

    def script() -> Iterator[SensorBatch]:
        release.wait()
        yield batch(0.0)

    reader = SourceReader(Scripted(script, live=True), SystemClock(), 1.0)
    reader.start()
    assert reader.take(0.01) is None
    assert not reader.ended
    reader.close()
    release.set()


def test_an_empty_batch_is_passed_over():
    empty = SensorBatch(ImuBatch(np.empty(0, np.int64), np.empty((0, 3)), np.empty((0, 3))))
    source = Scripted(lambda: iter([empty, batch(1.0), empty]))
    assert len(everything(SourceReader(source, SystemClock(), None))) == 1


LOW = BatterySample(1_000_000, 0.1)


@pytest.mark.parametrize(("live", "t_ns"), [(True, LOW.t_ns), (False, 5 * NS_PER_S)])
def test_auxiliary_readings_come_with_the_next_batch_of_the_source(live: bool, t_ns: int):
    source, beside = Scripted(lambda: iter([batch(5.0)]), live=live), FinishedSource(LOW)
    reader = SourceReader(source, SystemClock(), None, (beside,))
    (timed,) = everything(reader)
    assert timed.batch.others == (BatterySample(t_ns, LOW.level),)
    assert len(timed.batch.imu) == 1
    assert reader.take_faults() == ("it is loose",)
    assert beside.closed


def test_beside_a_recording_it_has_the_recordings_time_also_where_the_sensor_was_gone():
    press = ButtonPress(5 * NS_PER_S, "mayday")
    source = Scripted(lambda: iter([SensorBatch(batch(0.0).imu.part(slice(0)), (press,))]))
    (timed,) = everything(SourceReader(source, SystemClock(), None, (FinishedSource(LOW),)))
    assert timed.batch.others == (press, BatterySample(5 * NS_PER_S, LOW.level))


@pytest.mark.parametrize("live", [True, False])
def test_while_a_live_source_gives_nothing_what_is_beside_it_goes_alone(live: bool):
    release, clock = threading.Event(), ManualClock()

    def script() -> Iterator[SensorBatch]:
        release.wait()
        yield from ()

    reader = SourceReader(Scripted(script, live=live), clock, None, (FinishedSource(LOW),))
    reader.start()
    assert reader.take(0.01) is None, "the next batch may be about to come"
    clock.advance(2.0)
    timed = reader.take(0.01)
    if live:
        assert timed is not None
        assert timed.batch.others == (LOW,)
        assert len(timed.batch.imu) == 0
        assert timed.timeline.to_mono_ns(7) == 7
    else:
        assert timed is None, "a recording says what time it is"
    release.set()
    reader.close()
