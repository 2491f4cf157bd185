"""``muster bench bus``: a small run through a station loses nothing."""

from __future__ import annotations

from rich.progress import Progress

from tests.bench.bus.command import Load, measure
from tests.rig.latency import latencies_ms

MS = 1_000_000


def test_a_small_run_accounts_for_every_message() -> None:
    with Progress(disable=True) as progress:
        report = measure(Load(units=3, rate_hz=10.0, seconds=2.0, consoles=2), progress)
    assert report.sent == 3 * (10 * 2 + 1)
    assert (report.lost, report.repeated) == (0, 0)
    assert report.recorded == report.stepped == report.sent
    assert report.track_points == report.track_points_due > 0
    assert report.positions_sent == 3 * 14
    assert 0 < report.positions_shown == report.latency.count <= report.positions_sent
    assert 0.0 < report.latency.p50_ms <= report.latency.p99_ms <= report.latency.max_ms
    assert report.cpu_share > 0.0
    assert report.bare_lost == 0


def test_a_shown_position_is_that_of_the_nearest_sensor_time() -> None:
    sent = {"anna": [100 * MS, 200 * MS, 300 * MS], "ben": [100 * MS]}
    shown = {"anna": {102: 150 * MS, 199: 250 * MS, 201: 260 * MS}}
    assert latencies_ms(sent, shown) == [50.0, 50.0]


def test_many_and_slow_consoles_lose_no_message() -> None:
    with Progress(disable=True) as progress:
        report = measure(Load(3, 7.0, 3.0, consoles=1, onlookers=200, slow=5), progress)
    assert (report.lost, report.stepped) == (0, report.sent)
    assert report.console_gaps == 0
    assert (report.onlookers.onlookers, report.slow.onlookers) == (200, 5)
    assert report.onlookers.cut_off == 0
    assert report.onlookers.snapshots == 200  # nobody who reads was set back to a new one
    assert report.onlookers.least_messages > report.slow.least_messages
