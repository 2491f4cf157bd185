"""``muster bench station``: every message is stepped, and all parts are counted."""

from __future__ import annotations

from pathlib import Path

from rich.progress import Progress

from shared.channels import FUSED, POSITION, parse_key
from shared.mcap_log import read_log
from shared.messages import STATION_ID
from tests.bench.station.load import measure
from tests.rig.accelerated_station import compressed_station
from tests.rig.simulated_units import unit_names


def test_messages_in_compressed_time_are_in_the_log(tmp_path: Path) -> None:
    with compressed_station(tmp_path, unit_names(5), 7.0, consoles=1) as station:
        station.run(3.0)
        assert station.messages == 5 * 7 * 3
        assert station.console_messages > 0
    keys = [key for _, key, _ in read_log(tmp_path / "log")]
    reported = [key for key in keys if parse_key(key)[0] != STATION_ID]
    assert len(reported) == 5 * 7 * 3
    positions = sum(parse_key(key)[1] is POSITION for key in reported)
    assert keys.count(FUSED.key(STATION_ID)) == positions > 0


def test_short_run_reports_the_share_of_each_part() -> None:
    with Progress(disable=True) as progress:
        report = measure(units=5, rate_hz=7.0, minutes=0.05, consoles=1, progress=progress)
    assert report.messages == 5 * 7 * 3
    assert set(report.cpu_us) == {"decode, step, tell", "log", "database", "consoles"}
    assert report.cpu_us["decode, step, tell"] > 0.0
    assert report.per_core_hz > 0.0
    assert report.memory_slope_mb_per_minute is None  # which only a long one tells
