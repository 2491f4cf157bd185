"""``muster bench past`` measures what looking back takes; targets are not asserted."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.bench.past.command import bench_past


@pytest.mark.slow
def test_it_writes_the_figures(tmp_path: Path) -> None:
    bench_past(units=3, minutes=1.0, json_file=tmp_path / "figures.json")
    figures = json.loads((tmp_path / "figures.json").read_text())
    assert figures["points"] > 3 * 30
    assert figures["peak_mb"] > 50.0
