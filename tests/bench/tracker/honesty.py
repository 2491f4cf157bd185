"""``muster bench track --honesty``: is what the tracker states of simulated walks true?

Walks from half a minute to twenty minutes, many wearers each, by sensors that were calibrated and
by sensors as a data sheet has them, held at the true start and heading.  No magnetometer, no
barometer: nothing but the tracker.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import chain
from math import sqrt
from statistics import NormalDist

import msgspec
import numpy as np
from rich.console import Console
from rich.progress import track as progress_bar
from rich.table import Table

from edge.samples import Floats
from edge.simulation.factory import find_scenario
from edge.simulation.simulation import CONSUMER_SENSORS, UNCALIBRATED_SENSORS, Simulation
from tests.bench.tracker.scoring import CHI2_95_2DOF, horizontal_nees
from tests.bench.tracker.walk_errors import rms, track, true_way_m
from tests.rig.inertial_walk import inertial_samples

SEARCH = "search-ground-floor"
WALKS: tuple[tuple[str, str, float], ...] = (  # as it is called, the scenario, how long if looped
    ("straight", "straight", 0.0),
    ("square of 60 m", "square-60m", 0.0),
    ("J-shape", "j-shape", 0.0),
    ("stairs", "stairs", 0.0),
    ("gaits", "gaits", 0.0),
    ("track of 400 m", "track-400m", 0.0),
    ("3 min of search", SEARCH, 180.0),
    ("10 min of search", SEARCH, 600.0),
    ("20 min of search", SEARCH, 1200.0),
)
SEEDS = 24
_EVERY_S = 0.5


@dataclass(frozen=True, slots=True)
class Ending:
    """One simulated walk."""

    heading_rad: float  # error at the end
    heading_std_rad: float
    error_m: float  # horizontal, at the end
    nees: float  # of it; 2 is honest
    inside: float  # share of the walk in the stated 95 % ellipse


@dataclass(frozen=True, slots=True)
class Honesty:
    """Walks of one kind by sensors of one kind."""

    walk: str
    calibrated: bool
    walks: int
    heading_deg: float
    heading_stated_deg: float
    error_m: float
    mean_nees: float
    inside: float


def measure_honesty(seeds: int = SEEDS) -> list[Honesty]:
    """Walk them all; the last entries are all walks together, by either kind of sensors."""
    jobs = [(walk, calibrated) for calibrated in (True, False) for walk, _, _ in WALKS]
    bar = progress_bar(jobs, description="Walking", console=Console(stderr=True), transient=True)
    walked = {
        (walk, calibrated): [ending(walk, seed, calibrated=calibrated) for seed in range(seeds)]
        for walk, calibrated in bar
    }
    results = [_honesty(walk, calibrated, found) for (walk, calibrated), found in walked.items()]
    for calibrated in (True, False):
        found = [walked[walk, calibrated] for walk, _, _ in WALKS]
        results.append(_honesty("all of them", calibrated, list(chain.from_iterable(found))))
    return results


def nees_bounds(walks: int) -> tuple[float, float]:
    """Within which the mean of ``walks`` honest errors lies with 95 % probability.

    That is chi-square with two degrees of freedom a walk, by the approximation of Wilson and
    Hilferty (1931), good to a hundredth from a dozen walks on.
    """
    width = NormalDist().inv_cdf(0.975) * sqrt(1.0 / (9.0 * walks))
    middle = 1.0 - 1.0 / (9.0 * walks)
    return 2.0 * (middle - width) ** 3, 2.0 * (middle + width) ** 3


def _honesty(walk: str, calibrated: bool, endings: list[Ending]) -> Honesty:
    return Honesty(
        walk=walk,
        calibrated=calibrated,
        walks=len(endings),
        heading_deg=float(np.degrees(rms(_all(endings, "heading_rad")))),
        heading_stated_deg=float(np.degrees(rms(_all(endings, "heading_std_rad")))),
        error_m=rms(_all(endings, "error_m")),
        mean_nees=float(np.mean(_all(endings, "nees"))),
        inside=float(np.mean(_all(endings, "inside"))),
    )


def _all(endings: list[Ending], name: str) -> Floats:
    return np.array([getattr(ending, name) for ending in endings])


def ending(walk: str, seed: int, *, calibrated: bool) -> Ending:
    """Walk one of ``WALKS``, track and compare."""
    _, name, duration_s = next(entry for entry in WALKS if entry[0] == walk)
    scenario = find_scenario(name)
    if duration_s:
        scenario = msgspec.structs.replace(scenario, building=False, duration_s=duration_s)
    sensors = CONSUMER_SENSORS if calibrated else UNCALIBRATED_SENSORS
    return ending_of(Simulation(scenario, seed, sensors))


def ending_of(simulation: Simulation) -> Ending:
    """Track a walk by its inertial sensors and compare."""
    imu = inertial_samples(simulation)
    rows = track(simulation.description, imu, "eskf")
    at = np.arange(0, len(rows), round(_EVERY_S * simulation.description.rate_hz))
    truth = simulation.truth(np.asarray(rows.t_ns[at] * 1e-9, np.float64))
    way_m, drift_rad = true_way_m(rows.quaternion_nb[at], truth)
    nees = horizontal_nees(rows.position_n_m[at], way_m, rows.position_cov_m2[at])
    error_m = rows.position_n_m[at[-1], :2] - way_m[-1, :2]
    return Ending(
        heading_rad=float(drift_rad[-1]),
        heading_std_rad=float(rows.heading_std_rad[at[-1]]),
        error_m=float(np.hypot(*error_m)),
        nees=float(nees[-1]),
        inside=float(np.mean(nees[1:] <= CHI2_95_2DOF)),
    )


def honesty_table(results: list[Honesty]) -> Table:
    table = Table(title="Simulated: stated beside true, at the end of the walk")
    for title in ("walk", "sensors"):
        table.add_column(title)
    titles = ("heading, deg", "stated", "error, m", "mean NEES", "of honest ones", "inside 95 %")
    for title in titles:
        table.add_column(title, justify="right")
    for entry in results:
        least, most = nees_bounds(entry.walks)
        table.add_row(
            entry.walk,
            "calibrated" if entry.calibrated else "data sheet",
            f"{entry.heading_deg:.1f}",
            f"{entry.heading_stated_deg:.1f}",
            f"{entry.error_m:.2f}",
            f"{entry.mean_nees:.2f}",
            f"{least:.2f}-{most:.2f}",
            f"{100.0 * entry.inside:.0f}",
        )
    return table
