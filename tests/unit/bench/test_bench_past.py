"""``muster bench past`` measures the cost of post-processing, and its effect on live positions.

Of its targets only memory is asserted, by the need of a minute of a unit.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from tests.bench.past.command import bench_past

TO_REACH_MB, UNITS, MINUTES = 500.0, 100, 60.0
ALLOWED = 4.0  # times the share of a unit and minute: of a short way everything is kept


def figures(folder: Path, units: int, minutes: float) -> dict[str, Any]:
    file = folder / "figures.json"
    bench_past(units=units, minutes=minutes, live_units=3, alone_s=2.0, json_file=file)
    found: dict[str, Any] = json.loads(file.read_text())
    return found


@pytest.mark.slow
def test_bench_writes_the_figures_and_memory_stays_below_the_limit(
    tmp_path: Path,
) -> None:
    few, many = figures(tmp_path, 3, 1.0), figures(tmp_path, 20, 10.0)
    assert few["points"] > 3 * 30
    assert few["peak_mb"] > 50.0
    for when in ("alone", "meanwhile"):
        assert many[when]["count"] > 0
        assert 0.0 < many[when]["p50_ms"] <= many[when]["p99_ms"] <= many[when]["max_ms"]
    share_mb = (TO_REACH_MB - few["peak_mb"]) / (UNITS * MINUTES)  # of a unit and minute
    assert many["peak_mb"] - few["peak_mb"] < ALLOWED * share_mb * (20 * 10.0 - 3 * 1.0)
