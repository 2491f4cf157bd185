"""``muster bench wearer`` measures a button, an order and a pre-alert; targets are not asserted."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.bench.wearer import bench_wearer


@pytest.mark.slow
def test_bench_writes_the_figures(tmp_path: Path) -> None:
    bench_wearer(trials=2, outage=False, json_file=tmp_path / "figures.json")
    figures = json.loads((tmp_path / "figures.json").read_text())
    for name in ("mayday_s", "order_s", "pre_alert_s"):
        assert len(figures[name]) == 2
    assert all(-0.1 < value < 120.0 for value in figures["mayday_s"] + figures["order_s"])
