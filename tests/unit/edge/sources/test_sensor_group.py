"""Several sources as those of one person's sensors."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import closing
from threading import Event

import numpy as np
import pytest

from edge.samples import BatterySample, ImuBatch, SensorBatch, SensorDescription
from edge.sources.interface import OfflineSource, sensors_in
from edge.sources.registry import open_sensors
from edge.sources.sensor_group import SensorGroup
from edge.sources.simulated import SimulatedSource
from shared.clock import NS_PER_S
from shared.errors import ConfigError, RecordingError

Script = Callable[[], Iterator[SensorBatch]]


def batch(t_s: float) -> SensorBatch:
    t_ns = np.array([round(t_s * NS_PER_S)])
    battery = BatterySample(int(t_ns[0]), 0.5)
    return SensorBatch(ImuBatch(t_ns, np.zeros((1, 3)), np.zeros((1, 3))), (battery,))


def every_s(from_s: float, count: int) -> Script:
    return lambda: (batch(from_s + number) for number in range(count))


class Scripted(OfflineSource):
    def __init__(self, script: Script, *, live: bool = False) -> None:
        self._script, self._live = script, live
        self.is_closed = False

    @property
    def description(self) -> SensorDescription:
        return SensorDescription("scripted", 100.0)

    @property
    def is_live(self) -> bool:
        return self._live

    def batches(self) -> Iterator[SensorBatch]:
        return self._script()

    def close(self) -> None:
        self.is_closed = True


def failing() -> Iterator[SensorBatch]:
    yield batch(0.0)
    raise RecordingError("the cable is cut")


def played(group: SensorGroup) -> list[tuple[str, float]]:
    return [(one.sensor, float(one.imu.t_ns[0]) / NS_PER_S) for one in group.batches()]


def test_recordings_are_merged_by_time() -> None:
    group = SensorGroup({"left": Scripted(every_s(0.5, 2)), "right": Scripted(every_s(0.0, 3))})
    assert played(group) == [
        ("right", 0.0), ("left", 0.5), ("right", 1.0), ("left", 1.5), ("right", 2.0)
    ]  # fmt: skip
    assert list(sensors_in(group)) == ["left", "right"]


def test_recordings_of_different_clocks_begin_together() -> None:
    group = SensorGroup({"left": Scripted(every_s(900.0, 2)), "right": Scripted(every_s(0.0, 2))})
    assert played(group) == [("left", 900.0), ("right", 0.0), ("left", 901.0), ("right", 1.0)]


def test_a_battery_of_a_sensor_has_its_name() -> None:
    group = SensorGroup({"left": Scripted(every_s(0.0, 1))})
    (one,) = group.batches()
    assert one.others == (BatterySample(0, 0.5, battery="left"),)


@pytest.mark.parametrize("live", [False, True])
def test_failing_sensor_stops_no_other(live: bool) -> None:
    members = {"left": Scripted(failing, live=live), "right": Scripted(every_s(0.0, 5), live=live)}
    group = SensorGroup(members)
    assert sorted(played(group)) == [("left", 0.0), *(("right", float(n)) for n in range(5))]
    assert set(group.take_faults()) == {
        "left: it has failed: the cable is cut",
        "right: its source has no more",
    }
    assert group.take_faults() == ()


@pytest.mark.parametrize("live", [False, True])
def test_the_last_one_left_fails_the_source(live: bool) -> None:
    with pytest.raises(RecordingError, match="left: it has failed: the cable is cut"):
        list(SensorGroup({"left": Scripted(failing, live=live)}).batches())


def test_hardware_that_hangs_holds_nothing_up() -> None:
    is_over = Event()

    def hanging() -> Iterator[SensorBatch]:
        is_over.wait()
        yield from ()

    members = {"left": Scripted(hanging, live=True), "right": Scripted(every_s(0.0, 5), live=True)}
    with closing(SensorGroup(members)) as group:
        batches = group.batches()
        assert [next(batches).sensor for _ in range(5)] == ["right"] * 5
    is_over.set()
    assert all(member.is_closed for member in members.values())


def test_hardware_beside_a_recording_is_refused() -> None:
    with pytest.raises(ConfigError, match="of both kinds"):
        SensorGroup({"a": Scripted(every_s(0.0, 1)), "b": Scripted(every_s(0.0, 1), live=True)})


def test_simulated_sensors_are_worn_by_one_person() -> None:
    group = open_sensors(
        {"left_foot": "simulated:straight?seed=3", "back": "simulated:straight?seed=3"},
        {"left_foot": "left_foot", "back": "lower_back"},
    )
    batches = list(group.batches())
    foot = [one for one in batches if one.sensor == "left_foot"]
    back = [one for one in batches if one.sensor == "back"]
    alone = list(SimulatedSource("straight?seed=3&worn_on=waist&number=1").batches())
    assert [one.imu.gyro_radps.tobytes() for one in back] == [
        one.imu.gyro_radps.tobytes() for one in alone
    ]
    assert any(one.others for one in foot), "the slow sensors are the unit's"
    assert not any(one.others for one in back), "and it has each once"
