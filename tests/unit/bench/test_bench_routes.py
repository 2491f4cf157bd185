"""``muster bench routes`` writes its figures."""

from __future__ import annotations

import json
from pathlib import Path

from tests.bench.routes import bench_routes


def test_bench_writes_the_figures_with_a_plan_and_without(tmp_path: Path) -> None:
    file = tmp_path / "figures.json"
    bench_routes(people=4, minutes=1, json_file=file)
    with_plan, without = json.loads(file.read_text())
    assert (with_plan["with_plan"], without["with_plan"]) == (True, False)
    for figures in (with_plan, without):
        assert figures["known"] == 3
        assert min(figures["first_ms"], figures["fresh_ms"], figures["kept_ms"]) > 0.0
