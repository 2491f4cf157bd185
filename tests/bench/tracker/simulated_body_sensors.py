"""Simulated walks of every scenario with sensors elsewhere than on a foot, for ``muster bench track
--simulated-elsewhere``.

One wearer a scenario, the first half minute, consumer-class sensors, compass not calibrated.  At
each place every tracker is run that is made for it; a shank has one only together with a chest.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from rich import box
from rich.console import Console
from rich.progress import track as progress_bar
from rich.table import Table

from edge.simulation.legs import Segment
from edge.simulation.scenario import Scenario
from edge.simulation.scenarios import SCENARIOS
from edge.sources.recording import RecordedTruth
from edge.tracker.interface import BodyDimensions, TrackBatch
from edge.tracker.registry import TRACKERS, make_multi_sensor_tracker, make_tracker
from edge.tracker.track_rows import join_rows
from tests.bench.tracker.scoring import Score, score_track
from tests.rig.inertial_walk import InertialWalk, inertial_walk
from tests.rig.sensors_of_person import track_person, worn

PLACES: tuple[Segment, ...] = ("waist", "hip", "chest", "pocket", "shank")
LASTS_S = 30.0
LEAST_WALKED_M = 10.0  # a share of less says nothing
_WITH_SHANK: tuple[str, tuple[Segment, ...]] = ("torso_shank", ("chest", "shank"))
_TRUTH_STEP_S = 0.5
_SEED = 7


@dataclass(frozen=True, slots=True)
class SimulatedElsewhere:
    """One simulated walk by one tracker."""

    scenario: str
    places: tuple[str, ...]
    tracker: str
    walked_m: float  # in truth
    score: Score


def measure_simulated_elsewhere(
    scenarios: Sequence[Scenario] = SCENARIOS, lasts_s: float = LASTS_S
) -> list[SimulatedElsewhere]:
    """Track the walk of each scenario by what is worn at each place."""
    bar = progress_bar(
        scenarios, description="Walking", console=Console(stderr=True), transient=True
    )
    return [one for scenario in bar for one in _of_scenario(scenario, lasts_s)]


def _of_scenario(scenario: Scenario, lasts_s: float) -> Iterator[SimulatedElsewhere]:
    walks = {
        place: inertial_walk(scenario, _SEED, place, number=number, lasts_s=lasts_s)
        for number, place in enumerate(PLACES)
    }
    for place, walk in walks.items():
        for entry in TRACKERS:
            if place in entry.worn_on:
                tracker = make_tracker(entry.name, walk.description)
                rows = join_rows([tracker.push(walk.imu), tracker.finish()])
                yield _scored(scenario, (place,), entry.name, walk, rows)
    name, places = _WITH_SHANK
    pair: dict[str, InertialWalk] = {place: walks[place] for place in places}
    body = BodyDimensions(leg_length_m=pair["chest"].leg_length_m)
    together = make_multi_sensor_tracker(name, worn(pair), body)
    rows = track_person(together, {place: walk.imu for place, walk in pair.items()})
    yield _scored(scenario, places, name, pair["chest"], rows)


def _scored(
    scenario: Scenario, places: tuple[str, ...], tracker: str, walk: InertialWalk, rows: TrackBatch
) -> SimulatedElsewhere:
    every = max(1, round(_TRUTH_STEP_S * walk.description.rate_hz))
    truth = RecordedTruth(walk.truth.t_s[::every], walk.truth.position_n_m[::every])
    steps_m = np.diff(truth.position_n_m[:, :2], axis=0)
    return SimulatedElsewhere(
        scenario=scenario.name,
        places=places,
        tracker=tracker,
        walked_m=float(np.hypot(*steps_m.T).sum()),
        score=score_track(rows, truth, closed_loop=False),
    )


def simulated_elsewhere_table(results: Sequence[SimulatedElsewhere]) -> Table:
    """One row a place and tracker: errors over the scenarios, and how honest they are."""
    table = Table(title=f"Simulated, {LASTS_S:.0f} s of every scenario", box=box.SIMPLE_HEAD)
    for title in ("worn", "tracker"):
        table.add_column(title)
    for title in ("walks", "ATE, %", "worst", "in", "in 95 %", "worst", "silent, %"):
        table.add_column(title, justify="left" if title == "in" else "right")
    for places, tracker in dict.fromkeys((one.places, one.tracker) for one in results):
        members = [one for one in results if (one.places, one.tracker) == (places, tracker)]
        walked = [one for one in members if one.walked_m >= LEAST_WALKED_M]
        shares = [ate_share(one) for one in walked]
        covered = [one.score.coverage_95_from_start or 0.0 for one in members]
        table.add_row(
            ", ".join(places),
            tracker,
            str(len(members)),
            f"{100.0 * float(np.median(shares)):.1f}",
            f"{100.0 * max(shares):.1f}",
            walked[int(np.argmax(shares))].scenario,
            f"{100.0 * float(np.mean(covered)):.0f}",
            f"{100.0 * min(covered):.0f}",
            f"{100.0 * float(np.mean([one.score.silently_wrong or 0.0 for one in members])):.1f}",
        )
    return table


def scenarios_table(results: Sequence[SimulatedElsewhere]) -> Table:
    """One row a scenario: ATE in metres, and the share in the stated 95 % region."""
    table = Table(title="ATE in metres (in 95 %)", box=box.SIMPLE_HEAD)
    table.add_column("scenario")
    table.add_column("walked, m", justify="right")
    ways = list(dict.fromkeys((one.places, one.tracker) for one in results))
    for places, tracker in ways:
        table.add_column(f"{', '.join(places)}: {tracker}", justify="right")
    for name in dict.fromkeys(one.scenario for one in results):
        members = {(one.places, one.tracker): one for one in results if one.scenario == name}
        first = next(iter(members.values()))
        cells = (_cell(members[way].score) for way in ways)
        table.add_row(name, f"{first.walked_m:.0f}", *cells)
    return table


def ate_share(one: SimulatedElsewhere) -> float:
    """ATE by the way that was truly walked."""
    return (one.score.ate_m or 0.0) / one.walked_m


def _cell(score: Score) -> str:
    return f"{score.ate_m or 0.0:.2f} ({100.0 * (score.coverage_95_from_start or 0.0):.0f} %)"
