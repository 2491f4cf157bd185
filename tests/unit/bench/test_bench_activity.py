"""The activity benchmark prints and writes its tables."""

from __future__ import annotations

import json

import pytest

from shared.messages import Activity
from tests.bench.tracker.activity import bench_activity
from tests.bench.tracker.activity_scoring import Confusion


def test_confusion_matrix_has_counts_and_shares():
    confusion = Confusion()
    for reported in (Activity.STILL, Activity.STILL, Activity.WALKING):
        confusion.add(Activity.STILL, reported)
    confusion.add(Activity.WALKING, Activity.WALKING)
    assert confusion.accuracy == pytest.approx(0.75)
    assert confusion.recall(Activity.STILL) == pytest.approx(2 / 3)
    assert confusion.of(Activity.WALKING) == 1


@pytest.mark.slow
def test_one_wearer_has_all_activities(tmp_path, capsys):
    file = tmp_path / "activity.json"
    bench_activity(None, file, first_seed=90, seeds=1)
    figures = json.loads(file.read_text())["simulated"]
    kinds = {"still", "walking", "running", "stairs up", "stairs down", "crawling", "lying"}
    assert kinds <= set(figures["settled"]["recall"])
    assert min(figures["settled"]["recall"][kind] for kind in kinds) > 0.85
    assert figures["falls_reported"] == figures["falls_labelled"] == 1
    reported = capsys.readouterr().out
    assert "stairs down" in reported
    assert "1 falls reported, 1 labelled" in reported
