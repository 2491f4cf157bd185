"""``muster bench fusion`` measures the fuser beside simpler ways; targets are not asserted."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from base_station.bench.fusion import bench_fusion, measure
from base_station.fusion import FUSERS


def test_it_prints_a_table_and_writes_the_figures(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "figures.json"
    bench_fusion(incidents=2, seed=3, json_file=file)
    shown = capsys.readouterr().out
    assert "switching" in shown
    assert "heading solved" in shown
    figures = json.loads(file.read_text())
    assert figures["incidents"] == 2
    assert figures["ce50_m"]["fused"]["outside"] < figures["ce95_m"]["fused"]["outside"]


def test_the_same_seed_gives_the_same_errors() -> None:
    one, other = measure(FUSERS[0], 1, 5), measure(FUSERS[0], 1, 5)
    assert (one.ce95_m, one.held_95) == (other.ce95_m, other.held_95)
    assert measure(FUSERS[0], 1, 6).ce95_m != one.ce95_m


def test_together_they_are_better_than_each_alone() -> None:
    """The recipe is worth something only where the simpler ways are worse at all stages."""
    ce95_m = measure(FUSERS[0], 12, 1).ce95_m
    for way in ("fixes alone", "path alone", "switching"):
        for stage, error_m in ce95_m[way].items():
            assert ce95_m["fused"][stage] < error_m, f"{way}, {stage}"
