"""``muster bench floors`` counts floors that are right; targets are not asserted."""

from __future__ import annotations

import json
from pathlib import Path

from base_station.bench.floors import LEARNT, WAYS, bench_floors


def test_it_writes_the_figures(tmp_path: Path) -> None:
    """One incident; guessing among four floors would be right a quarter of the time."""
    bench_floors(incidents=1, seed=2, json_file=tmp_path / "figures.json")
    figures = json.loads((tmp_path / "figures.json").read_text())
    assert set(figures["right"]) == set(WAYS)
    assert figures["right"][LEARNT] > 0.5
    assert figures["known"][LEARNT] > 0.9
