"""A person who follows only the guide's instructions obtains a calibration."""

from __future__ import annotations

import re
import time
from collections.abc import Iterator
from contextlib import closing
from datetime import UTC, datetime
from threading import Event, Thread

import numpy as np
import pytest

from edge.agent.fitted_sensor import FittedSensor
from edge.agent.pipeline import TrackerPipeline, UnitIdentity
from edge.app.calibration_session import calibrate_guided
from edge.calibration.file import read_calibration
from edge.calibration.procedure import run_step, solve
from edge.calibration.steps import AXES, PosesStep, Step, StillStep, TurningStep
from edge.sample_codec.codec import SampleEncoder, batch_of
from edge.sample_codec.listener import RawStreamListener
from edge.sample_codec.uplink import RawUplink
from edge.samples import ImuBatch, SensorBatch
from edge.simulation.handled_unit import HandledUnit, cut
from edge.sources.bus import BusSource
from edge.sources.registry import open_source
from edge.tracker.choice.one_sensor import OneSensorTracker
from edge.tracker.registry import NoTracker
from shared.bus_memory import MemoryRouter
from shared.channels import NO_TRACKER, channel_of
from shared.clock import ManualClock
from shared.codec import encode
from shared.header_factory import HeaderFactory

LIMIT_S = 600.0
UP = dict(zip(AXES, np.vstack([(a, -a) for a in np.eye(3)]), strict=True))


class Person:
    """Handles a unit as the last words of the guide ask; fidgets before anybody says a word."""

    def __init__(self, seed: int) -> None:
        self._unit = HandledUnit(seed)
        self._hand = np.random.default_rng(seed)
        self._received = "moved"
        self.handled_s = 0.0

    def receive(self, words: str) -> None:
        self._received = words

    def batches(self) -> Iterator[SensorBatch]:
        yield from cut(self._unit.turning(2))
        while True:
            for movement in self._movement(self._received):
                self.handled_s += len(movement) / 200.0
                yield from cut(iter((movement,)))

    def _movement(self, words: str) -> Iterator[ImuBatch]:
        if "half way between" in words:
            one, other = re.findall(r"([xyz]) and ([xyz])", words)[0]
            sign = self._hand.choice([-1.0, 1.0])
            yield from self._unit.poses(np.array([UP[f"+{one}"] + sign * UP[f"+{other}"]]))
        elif wanted := [axis for axis in AXES if f"{axis}" in words.partition("until")[2]]:
            yield from self._unit.poses(np.array([UP[wanted[0]]]))
        elif "leaning differently" in words:
            yield from self._unit.poses(self._hand.normal(0.0, 1.0, (1, 3)))
        elif "turn" in words:
            yield from self._unit.turning(1)
        else:
            yield self._unit.rest(2.0)


@pytest.mark.parametrize("seed", range(4))
def test_guided_calibration_is_complete_in_five_minutes(seed):
    person = Person(seed)
    batches = person.batches()
    steps: list[Step] = [StillStep(), PosesStep(), TurningStep()]
    for step in steps:
        person.receive(step.instruction)
        run_step(step, batches, LIMIT_S, person.receive)
        assert step.wanted() is None
    assert person.handled_s < 300.0
    calibration = solve(steps, "u1", "s", datetime.now(UTC))
    assert calibration.faults() == ()
    assert None not in (calibration.accelerometer, calibration.gyroscope, calibration.magnetometer)


def test_unit_is_calibrated_over_the_bus_from_its_raw_samples(tmp_path):
    """The live source of a station: whatever driver the unit has."""
    router = MemoryRouter()
    unit = router.attach_unit()
    listener = RawStreamListener("FF-01", router.attach_station)
    assert listener.open(Event())
    source = BusSource("FF-01")
    handled = open_source("bench:3")
    header_factory = HeaderFactory("FF-01", 7, ManualClock())
    pipeline = TrackerPipeline(
        UnitIdentity("1", "bench:3", NO_TRACKER, (FittedSensor(handled.description),)),
        OneSensorTracker(NoTracker()),
        header_factory,
        5.0,
        raw_uplink=RawUplink(header_factory),
    )
    raw, done = SampleEncoder("FF-01", 7), Event()

    def wear() -> None:
        messages = list(pipeline.start())
        for batch in handled.batches():
            if done.is_set():
                return
            messages += pipeline.step(batch_of(raw.messages(batch)))
            for message in messages:
                channel = channel_of(message)
                unit.publish(channel.key("FF-01"), encode(message), channel.qos)
            messages.clear()
            time.sleep(0.0002)  # no faster than they are taken

    thread = Thread(target=wear)
    thread.start()
    try:
        with closing(source):
            assert source.follow(listener, Event())
            calibrate_guided(source, tmp_path / "u.toml", "FF-01", None, with_warm_up=False)
    finally:
        done.set()
        thread.join()
    itself = tmp_path / "itself.toml"
    with closing(open_source("bench:3")) as bench:
        calibrate_guided(bench, itself, "FF-01", None, with_warm_up=False)
    found, expected = read_calibration(tmp_path / "u.toml"), read_calibration(itself)
    assert found.sensor == "simulated on a table"
    assert found.accelerometer is not None
    assert expected.accelerometer is not None
    np.testing.assert_allclose(
        found.accelerometer.bias_mps2, expected.accelerometer.bias_mps2, atol=2e-3
    )
