"""Figures of sensors elsewhere than on a foot in the documents equal those of a run.

A part of them that takes half a minute of processor time: ``muster bench track --elsewhere`` and
``--simulated-elsewhere`` measure all.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path

import pytest

from edge.body_places import LEFT_FOOT
from edge.simulation.scenarios import SCENARIOS
from tests.bench.tracker.body_recordings import measure_tracker_elsewhere
from tests.bench.tracker.several_sensors import measure_gait_events, measure_returns_of
from tests.bench.tracker.simulated_body_sensors import measure_simulated_elsewhere
from tests.golden.documented_figures import figures, read_table

PAGE = Path(__file__).resolve().parents[2] / "docs" / "benchmarks.md"
RECORDED = {  # how a row begins, and the field of the bench's result
    "lower back, length, median error, nothing learnt": "length_error",
    "the same, scaled by another walk of the same person": "known_length_error",
    "the same, as `muster edge learn-steps` learns it from that walk": "learnt_length_error",
    "lower back, closure, median": "closure_median_m",
    "stated 95 % region holds where the walk began": "closure_coverage_95",
    "telephone, error at waypoints by the way, median (start and first heading known)": (
        "waypoint_error"
    ),
    "telephone, the worst tenth": "waypoint_error_90",
    "stated 95 % region holds, waypoints": "waypoint_coverage_95",
}
MORE_RECORDED = {"the same, 26 walks whose three sensors have as many samples"}
COMPARED = ("straight", "climbs-stairs", "dragged-foot", "stairs-500hz")


@cache
def simulated(scenario):
    """Results of every place and tracker, by how their column is titled."""
    return {
        f"{', '.join(one.places)}: `{one.tracker}`": one
        for one in measure_simulated_elsewhere([one for one in SCENARIOS if one.name == scenario])
    }


def assert_stated(cell, *measured):
    """``measured``: as the cell has it; a share is stated in per cent."""
    stated = figures(cell)
    assert len(stated) == len(measured), cell
    for figure, value in zip(stated, measured, strict=True):
        assert figure.holds(value), f"{cell}: {value:.4f}"


def test_every_row_of_recordings_is_known():
    rows = [row["recordings, figure"] for row in read_table(PAGE, "recordings, figure")]
    assert {*rows} == {*RECORDED, *MORE_RECORDED}
    assert len(rows) == len({*rows})


@pytest.mark.parametrize("name", ["waist", "body"])
def test_figures_of_recordings_elsewhere_are_reproduced(worn_elsewhere, name):
    body, _ = worn_elsewhere
    measured = measure_tracker_elsewhere(body.parent, name)
    for row in read_table(PAGE, "recordings, figure"):
        field = RECORDED.get(row["recordings, figure"])
        if field is not None and row[f"`{name}`"]:
            value = getattr(measured, field)
            assert_stated(row[f"`{name}`"], value if field.endswith("_m") else 100.0 * value)


def test_figures_of_one_foot_of_these_people_are_reproduced(worn_elsewhere):
    body, _ = worn_elsewhere
    row = next(iter(read_table(PAGE, "tracker", "sensors")))
    assert (row["tracker"], row["sensors"]) == ("`eskf`", "left foot")
    measured = measure_returns_of(body.parent, (LEFT_FOOT,), "eskf")
    assert_stated(row["closure, median"], measured.closure_median_m)
    assert_stated(row["in the stated 95 %"], 100.0 * measured.closure_coverage_95)


def test_figures_of_gait_events_are_reproduced(worn_elsewhere):
    body, _ = worn_elsewhere
    *documented, _target = read_table(PAGE, "gait events")
    for row, measured in zip(documented, measure_gait_events(body.parent), strict=True):
        assert_stated(row["walks"], measured.walks)
        assert_stated(row["swings"], measured.marked)
        assert_stated(row["missed"], measured.missed)
        assert_stated(row["median, ms"], 1e3 * measured.error_median_s)
        assert_stated(row["95 %, ms"], 1e3 * measured.error_95_s)


@pytest.mark.parametrize("scenario", COMPARED)
def test_figures_of_simulated_places_are_reproduced(scenario):
    rows = {row["scenario"]: row for row in read_table(PAGE, "scenario", "way", "waist: `waist`")}
    row = rows[f"`{scenario}`"]
    measured = simulated(scenario)
    assert_stated(row["way"], measured["waist: `waist`"].walked_m)
    for title in [title for title in row if title in measured]:
        score = measured[title].score
        assert_stated(row[title], score.ate_m, 100.0 * score.coverage_95_from_start)


def test_every_column_of_simulated_places_is_compared():
    titles = [*read_table(PAGE, "scenario", "way", "waist: `waist`")[0]]
    assert {*titles[2:]} <= {*simulated(COMPARED[0])}
