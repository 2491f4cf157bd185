"""Sensors of one person: clocks laid on each other, and which of them are gone."""

from __future__ import annotations

import numpy as np
import pytest

from edge.agent.sensor_presence import SensorPresence
from edge.clocks.timeline import Timeline
from edge.samples import ImuBatch, SensorBatch
from shared.clock import NS_PER_S

PERIOD_S = 0.05  # of a batch


def batch(sensor: str, t_s: float) -> SensorBatch:
    t_ns = np.rint((t_s + np.arange(5) * PERIOD_S / 5) * NS_PER_S).astype(np.int64)
    return SensorBatch(ImuBatch(t_ns, np.zeros((5, 3)), np.zeros((5, 3))), sensor=sensor)


class TwoSensors:
    """Two sensors, and what their presence says of them."""

    def __init__(self) -> None:
        self.presence = SensorPresence(("foot", "back"))
        self.news: list[str] = []
        self.times_s: dict[str, list[float]] = {"foot": [], "back": []}

    def wear(
        self, from_s: float, to_s: float, *, only: str = "", back_ahead_s: float = 0.0
    ) -> None:
        for t_s in np.arange(from_s, to_s, PERIOD_S):
            for sensor, ahead_s in (("foot", 0.0), ("back", back_ahead_s)):
                if only in ("", sensor):
                    self.take(batch(sensor, t_s + ahead_s))

    def take(self, batch: SensorBatch) -> Timeline:
        taken, timeline, news = self.presence.take(batch, Timeline())
        self.times_s[batch.sensor] += (taken.imu.t_ns / NS_PER_S).tolist()
        self.news += news
        return timeline


def test_two_sensors_on_one_clock_are_left_as_they_are() -> None:
    wearing = TwoSensors()
    wearing.wear(0.0, 5.0)
    assert wearing.news == []
    assert (
        wearing.times_s["foot"]
        == wearing.times_s["back"]
        == pytest.approx(np.arange(0.0, 5.0, PERIOD_S / 5).tolist())
    )


def test_a_sensor_that_falls_silent_is_gone_and_comes_back() -> None:
    wearing = TwoSensors()
    wearing.wear(0.0, 3.0)
    assert wearing.presence.leading == "foot"
    wearing.wear(3.0, 6.0, only="back")
    assert wearing.news == ["foot has given no samples for 2 s; back goes on"]
    assert wearing.presence.leading == "back"
    wearing.wear(6.0, 8.0)
    assert wearing.news[1:] == ["foot is back"]
    assert wearing.presence.present == ("foot", "back")


def test_a_sensor_that_never_came_is_gone() -> None:
    wearing = TwoSensors()
    wearing.wear(0.0, 3.0, only="back")
    assert wearing.news == ["foot has given no samples for 2 s; back goes on"]


@pytest.mark.parametrize("ahead_s", [30.0, -30.0, 1.5])
def test_a_clock_apart_is_laid_on_the_others(ahead_s: float) -> None:
    wearing = TwoSensors()
    wearing.wear(0.0, 5.0, back_ahead_s=ahead_s)
    (reported,) = wearing.news
    word = "ahead" if ahead_s > 0.0 else "behind"
    assert reported.startswith(f"the clock of back is {abs(ahead_s):.1f} s {word} of foot")
    first_s, last_s = wearing.times_s["back"][0], wearing.times_s["back"][-1]
    assert (first_s, last_s) == pytest.approx((0.45, 5.0), abs=PERIOD_S + 0.02)
    timeline = wearing.take(batch("back", 5.0 + ahead_s))
    assert timeline.to_mono_ns(5 * NS_PER_S) == pytest.approx(
        round((5.0 + ahead_s) * NS_PER_S), abs=0.06 * NS_PER_S
    ), "the sensor's own timeline still places its samples"


def test_a_backlog_that_is_caught_up_moves_no_clock() -> None:
    """The radio of one held its samples up for 5 s; they come faster than the other's then."""
    wearing = TwoSensors()
    wearing.wear(0.0, 3.0)
    wearing.wear(3.0, 8.0, only="back")
    late = np.arange(3.0, 8.0, PERIOD_S)
    for number, t_s in enumerate(late):
        wearing.take(batch("foot", t_s))
        if number % 10 == 0:
            wearing.take(batch("back", 8.0 + PERIOD_S * number / 10))
    wearing.wear(8.0 + PERIOD_S * len(late) / 10, 12.0)
    assert not [one for one in wearing.news if "clock" in one]
    assert wearing.times_s["foot"][-1] == pytest.approx(12.0, abs=PERIOD_S)
