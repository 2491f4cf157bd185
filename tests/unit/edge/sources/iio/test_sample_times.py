"""Times of captured samples, and the monitor's reports of them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from edge.sources.iio.sample_times import MappedTimes, MonotonicTimes, choose_clock
from edge.sources.iio.stream_monitor import StreamMonitor
from shared.clock import NS_PER_S
from tests.rig.kernel_devices import SysfsTree

NOW_NS = 1000 * NS_PER_S


def ns(*seconds: float) -> np.ndarray:
    return np.array([round(each * NS_PER_S) for each in seconds], np.int64)


def test_stamps_of_the_monotonic_clock_are_times() -> None:
    times = MonotonicTimes()
    placed, which = times.to_monotonic(ns(999.98, 999.99), NOW_NS)
    assert placed.tolist() == ns(999.98, 999.99).tolist()
    assert which.all()


def test_a_stamp_that_repeats_another_one_or_cannot_be_has_no_place() -> None:
    times = MonotonicTimes()
    times.to_monotonic(ns(999.0), NOW_NS)
    stamps = ns(999.0, 999.1, 0.0, 999.1, 2e9, 999.05, 999.2)
    placed, which = times.to_monotonic(stamps, NOW_NS)
    assert placed.tolist() == ns(999.1, 999.2).tolist()
    assert which.tolist() == [False, True, False, False, False, False, True]
    assert times.implausible == 2


def test_no_stamps_are_no_times() -> None:
    for times in (MonotonicTimes(), MappedTimes()):
        placed, which = times.to_monotonic(ns(), NOW_NS)
        assert (len(placed), len(which)) == (0, 0)


def test_stamps_of_the_wall_clock_are_laid_onto_the_monotonic_one() -> None:
    times = MappedTimes()
    epoch_s = 1.8e9
    placed, which = times.to_monotonic(ns(*(epoch_s + k * 0.0025 for k in range(20))), NOW_NS)
    assert which.all()
    assert placed[-1] == pytest.approx(NOW_NS, abs=1000)
    assert np.diff(placed) == pytest.approx(2_500_000, abs=1000)


@pytest.mark.parametrize(
    ("attributes", "kind"),
    [({}, MappedTimes), ({"current_timestamp_clock": "realtime"}, MonotonicTimes)],
)
def test_the_monotonic_clock_is_chosen_where_there_is_a_choice(tmp_path, attributes, kind) -> None:
    device: Path = SysfsTree(tmp_path).iio(0, name="a", **attributes)
    assert isinstance(choose_clock(device), kind)


def fed(monitor: StreamMonitor, rate_hz: float, *, seconds: float = 11.0, unplaced: int = 0):
    times_ns = NOW_NS + np.arange(round(seconds * rate_hz)) * round(NS_PER_S / rate_hz)
    monitor.count(times_ns.astype(np.int64), unplaced)
    return monitor.take_events()


def test_a_device_that_does_as_it_was_set_is_not_spoken_of() -> None:
    assert fed(StreamMonitor(400.0), 400.0) == []
    assert fed(StreamMonitor(400.0), 380.0) == []


def test_another_rate_is_stated_once() -> None:
    monitor = StreamMonitor(400.0)
    (reported,) = fed(monitor, 200.0)
    assert "it gives 200 samples a second and is set to 400" in reported
    assert fed(monitor, 200.0) == []


def test_lost_samples_are_stated_once_until_none_are_lost() -> None:
    monitor = StreamMonitor(400.0)
    t_ns = NOW_NS + np.arange(11 * 400, dtype=np.int64) * 2_500_000
    for begun in range(3):
        times_ns = t_ns + begun * 11 * NS_PER_S
        if begun != 1:
            times_ns = times_ns[np.arange(len(times_ns)) % 20 != 7]
        monitor.count(times_ns, 0)
        events = monitor.take_events()
        assert [("were lost" in one) for one in events] == ([True] if begun != 1 else [])


def test_samples_without_a_place_are_stated() -> None:
    (reported,) = fed(StreamMonitor(400.0), 400.0, unplaced=100)
    assert "100 of" in reported
    assert "were left out" in reported
