"""``muster bench floors`` counts correct floors; targets are not asserted."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.bench import floors
from tests.bench.floors import LEARNT, WAYS, bench_floors
from tests.rig.incident.run import draw_incident


@pytest.mark.slow
def test_bench_writes_the_figures(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Two people; a guess among four floors would be right a quarter of the time."""
    monkeypatch.setattr(floors, "draw_incident", lambda random: draw_incident(random)[:2])
    bench_floors(incidents=1, seed=2, json_file=tmp_path / "figures.json")
    figures = json.loads((tmp_path / "figures.json").read_text())
    assert set(figures["right"]) == set(WAYS)
    assert figures["right"][LEARNT] > 0.5
    assert figures["known"][LEARNT] > 0.9
