"""Figures of the trackers in the documents equal those of a run."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path

import pytest

from edge.tracker.interface import FOOT
from edge.tracker.registry import TRACKERS
from tests.bench.tracker.documented_routes import ROUTES
from tests.bench.tracker.simulated_walks import CALIBRATED, simulated_walks
from tests.bench.tracker.track import find_trials, score_simulation, score_trial, summarise
from tests.golden.documented_figures import figures, read_table

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "benchmarks.md"
NAMES = [entry.name for entry in TRACKERS if FOOT in entry.worn_on]
ELSEWHERE = [entry.name for entry in TRACKERS if FOOT not in entry.worn_on]
BESIDE = ("walks", "figure")  # the table of all trackers of a foot
ROUTE = ("route", "document")  # that of all others
RECORDED = {  # how a row of it begins, and the dataset
    "motion capture": "vicon",
    "footprints": "footprints",
    "loops of 78.5 m": "loops",
    "25 and 60 m and back": "xio",
}
SIMULATED = {
    "square of 60 m": "square-60m",
    "rectangle": "rectangle",
    "J-shape": "j-shape",
    "square of 60 m, calibrated": f"square-60m{CALIBRATED}",
    "rectangle, calibrated": f"rectangle{CALIBRATED}",
    "J-shape, calibrated": f"j-shape{CALIBRATED}",
}
# These take as much time as all others: muster bench track --simulated.
TOO_LONG = {"track of 400 m", "track of 400 m, calibrated"}
FIGURES = {
    "2D ARMSE": "armse_2d_m",
    "ATE": "ate_m",
    "closure": "closure_horizontal_m",
    "vertical RMS": "vertical_rms_m",
}

_LABEL = re.compile(r"(.+?)(?:, (\d+))?")  # ... and how many trials there are


@cache
def recorded(folder, name):
    return [score_trial(path, name) for path in find_trials(folder)]


@cache
def simulated(name, walk):
    """Scores of a walk with every seed; the suffix says which sensors."""
    route, calibrated, _ = walk.partition(CALIBRATED)
    return [
        score_simulation(one, name)
        for one in simulated_walks(name)
        if one.startswith(f"{route}?") and one.endswith(CALIBRATED) == bool(calibrated)
    ]


def statistic_of(figure):
    """Return the field of a score and the statistic that ``2D ARMSE, mean`` stands for."""
    title, statistic, *of = (part.strip() for part in figure.split(","))
    return "per_cent_of_distance" if of == ["of distance"] else FIGURES[title], statistic


def beside(labels):
    """Return label, count, figure and row of the rows of all trackers that begin like that."""
    for row in read_table(PAGE, *BESIDE):
        found = _LABEL.fullmatch(row["walks"])
        assert found, row["walks"]
        label, count = found.groups()
        if label in labels:
            yield label, count, row


def test_every_registered_tracker_has_a_column_and_every_row_is_known():
    rows = read_table(PAGE, *BESIDE)
    assert [title.strip("`") for title in rows[0]][len(BESIDE) :] == NAMES
    labels = {label for label, _, _ in beside({*RECORDED, *SIMULATED, *TOO_LONG})}
    assert labels == {*RECORDED, *SIMULATED, *TOO_LONG}
    assert len(rows) == len(labels)


@pytest.mark.parametrize("name", NAMES)
def test_figures_of_recorded_walks_are_reproduced(walks, name):
    scores = recorded(walks, name)
    summary = summarise(scores)
    for label, count, row in beside(RECORDED):
        dataset = RECORDED[label]
        assert sum(score.dataset == dataset for score in scores) == int(count), label
        field, statistic = statistic_of(row["figure"])
        (stated,) = figures(row[f"`{name}`"])
        measured = summary[dataset][field][statistic]
        assert stated.holds(measured), f"{label}, {row['figure']}: {stated.value}, {measured:.4f}"


@pytest.mark.parametrize("name", NAMES)
def test_figures_of_simulated_walks_are_reproduced(name):
    for label, _, row in beside(SIMULATED):
        field, statistic = statistic_of(row["figure"])
        scores = simulated(name, SIMULATED[label])
        (stated,) = figures(row[f"`{name}`"])
        measured = summarise(scores)["simulated"][field][statistic]
        assert stated.holds(measured), f"{label}: {stated.value}, {measured:.3f}"


def test_every_tracker_worn_elsewhere_has_a_column_and_every_route_a_row():
    rows = read_table(PAGE, *ROUTE)
    assert [title.strip("`") for title in rows[0]][len(ROUTE) :] == ELSEWHERE
    assert [row["route"].strip("`") for row in rows] == [*ROUTES]


@pytest.mark.parametrize("name", ELSEWHERE)
def test_figures_of_documented_routes_are_reproduced(name):
    for row in read_table(PAGE, *ROUTE):
        scores = simulated(name, row["route"].strip("`"))
        (stated,) = figures(row[f"`{name}`"])
        measured = summarise(scores)["simulated"]["per_cent_of_distance"]["mean"]
        assert stated.holds(measured), f"{row['route']}: {stated.value}, {measured:.3f}"


def test_figures_of_hard_walks_are_reproduced(hard_walks):
    scores = {(one.dataset, one.trial): one.score for one in recorded(hard_walks, NAMES[0])}
    rows = read_table(PAGE, "hard trial")
    assert len(rows) == len(scores)
    for row in rows:
        dataset, _, trial = row["hard trial"].strip("`").partition("/")
        score = scores[dataset, trial]
        (error,), (height,), (lost,) = (
            figures(row[title]) for title in ("error, m", "height at the end, m", "lost, %")
        )
        error_m = score.closure_horizontal_m if score.ate_m is None else score.ate_m
        assert error.holds(error_m), f"{trial}: {error_m:.3f}"
        assert height.holds(score.closure_vertical_m), f"{trial}: {score.closure_vertical_m:.3f}"
        assert lost.holds(100.0 * score.lost), f"{trial}: {100.0 * score.lost:.1f}"


def test_other_tables_state_the_same(walks):
    """README, the first table of benchmarks, and the row that worse sensors are compared with."""
    summary = summarise(recorded(walks, NAMES[0]))

    def of(dataset, field, *statistics):
        return [summary[dataset][field][statistic] for statistic in statistics]

    stated = {
        (PAGE, ("data", "Muster"), "Muster"): {
            "motion capture, 23 trials: 2D ARMSE, mean": of("vicon", "armse_2d_m", "mean"),
            "the same, vertical RMS, mean": of("vicon", "vertical_rms_m", "mean"),
            "footprints, slow walk to sprint, 15 trials: ATE, median / worst": of(
                "footprints", "ate_m", "median", "worst"
            ),
            "closed loops of 78.5 m, 6 trials: closure, mean, horizontal / vertical": [
                *of("loops", "closure_horizontal_m", "mean"),
                *of("loops", "closure_vertical_m", "mean"),
            ],
        },
        (ROOT / "README.md", ("", "Muster"), "Muster"): {
            "motion capture, 23 walks: 2D error (ARMSE), mean": of("vicon", "armse_2d_m", "mean"),
            "footprints, slow walk to sprint, 15: error (ATE), median": of(
                "footprints", "ate_m", "median"
            ),
            "closed loops of 78.5 m, 6: final error, mean": of(
                "loops", "closure_horizontal_m", "mean"
            ),
        },
    }
    for (page, titles, column), expected in stated.items():
        rows = {row[titles[0]]: row[column] for row in read_table(page, *titles)}
        for label, measured in expected.items():
            documented = figures(rows[label])
            assert len(documented) == len(measured), label
            held = [one.holds(value) for one, value in zip(documented, measured, strict=True)]
            assert all(held), f"{page.name}, {label}: {measured}"
    (recorded_row, *_) = read_table(PAGE, "perturbation")
    worse = {"footprints": "ate_m", "loops": "closure_horizontal_m", "xio": "closure_horizontal_m"}
    for title, field in worse.items():
        (figure,) = figures(recorded_row[title])
        assert figure.holds(*of(title, field, "mean")), title
