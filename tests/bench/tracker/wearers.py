"""``muster bench track --wearers``: walks that nobody has recorded, by wearers of every kind.

Simulated without magnetometer and barometer, by sensors that were calibrated and by sensors of a
data sheet, held at the true start and heading.  What is asked: is the tracker ever wrong, and does
not say so?
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from rich.console import Console
from rich.progress import track as progress_bar
from rich.table import Table

from edge.samples import Floats
from edge.simulation.legs import (
    Crawl,
    Kneel,
    Leg,
    Pace,
    Sit,
    Spiral,
    StairsLeg,
    StairsPace,
    Stand,
    Turn,
    Wait,
    Walk,
)
from edge.simulation.scenario import Scenario
from edge.simulation.simulation import CONSUMER_SENSORS, UNCALIBRATED_SENSORS, Simulation
from edge.tracker.interface import Quality
from tests.bench.tracker.scoring import CHI2_95_2DOF, horizontal_nees
from tests.bench.tracker.walk_errors import rms, track, true_way_m
from tests.rig.inertial_walk import inertial_samples

WEARERS = 6
FIRST_SEED = 100  # with those below the tracker was made, on these its faults were found
ROUND = ((20.0, 0.0), (20.0, 12.0), (0.0, 12.0), (0.0, 0.0))
CRAWLED = ((8.0, 0.0), (8.0, 5.0), (0.0, 5.0), (-4.0, 5.0), (-4.0, 0.0), (4.0, 0.0))
RISERS, RISER_M, TREAD_M = 9, 0.17, 0.28
_EVERY_S = 0.5
_STOOD_M = 0.02  # a height is shown to no less, whatever the tracker states


@dataclass(frozen=True, slots=True)
class Wearer:
    """Activity of a wearer, sample rate, and start of the recording."""

    does: str
    legs: tuple[Leg, ...]
    rate_hz: float = 200.0
    cut_s: float = 0.0


@dataclass(frozen=True, slots=True)
class WearerErrors:
    """Errors of one wearer, with the stated uncertainty."""

    path: float  # largest horizontal error by the length of the walk
    error_m: float  # the same in metres
    heading_rad: float  # at the end
    heading_std_rad: float
    height_m: float  # error at the end
    height_std_m: float
    inside: float  # share of the walk in the stated 95 % ellipse
    silent: float  # share of the walk outside of thrice that ellipse, with quality good


@dataclass(frozen=True, slots=True)
class WearerKindErrors:
    """All wearers of one kind with sensors of one kind; root mean squares."""

    does: str
    calibrated: bool
    path: float
    error_m: float
    heading_deg: float
    heading_stated_deg: float
    height_m: float
    height_stated_m: float
    inside: float
    silent: float


def walks(pace: Pace) -> tuple[Leg, ...]:
    return (Stand(4.0), Walk(ROUND, pace), Stand(3.0))


def floors(
    count: int, at_once: int = 1, pace: StairsPace = "walk", between: tuple[Leg, ...] = ()
) -> tuple[Leg, ...]:
    """Up a stairwell of two flights a floor, along the top floor and back, and down."""
    far, near = (RISERS * TREAD_M, 0.0), (0.0, 0.0)
    up, down = (
        (
            StairsLeg(far, rise_m, RISERS, at_once, pace),
            Turn(180.0),
            *between,
            StairsLeg(near, rise_m, RISERS, at_once, pace),
            Turn(0.0),
        )
        for rise_m in (RISERS * RISER_M, -RISERS * RISER_M)
    )
    top = (Walk(((-8.0, 0.0), (0.0, 0.0))), Turn(0.0))
    return (Stand(5.0), *count * up, *top, *count * down, Stand(3.0))


def winding(count: int) -> tuple[Leg, ...]:
    up = Spiral((0.0, 0.9), 540.0, 3.06, 18)
    down = Spiral((0.0, 0.9), -540.0, -3.06, 18)
    return (Stand(5.0), *count * (up,), Stand(2.0), *count * (down,), Stand(3.0))


def corridors(count: int) -> tuple[Leg, ...]:
    """Each floor's corridor is walked to its end and back."""
    corridor = (Walk(((-14.0, 0.0), (-14.0, 6.0), (0.0, 6.0), (0.0, 0.0))), Turn(0.0))
    up, down = (
        (
            StairsLeg((2.52, 0.0), rise_m, RISERS),
            Turn(180.0),
            StairsLeg((0.0, 0.0), rise_m, RISERS),
            *corridor,
        )
        for rise_m in (1.53, -1.53)
    )
    return (Stand(5.0), Turn(0.0), *count * up, *count * down, Stand(3.0))


def between_rounds(leg: Leg) -> tuple[Leg, ...]:
    half = (Walk(ROUND[:2]), leg, Walk(ROUND[2:]), leg)
    return (Stand(4.0), *half, *half, Stand(2.0))


_BREATHER = (Stand(2.0), Wait(20.0))
_SEARCHER: tuple[Leg, ...] = (
    Stand(4.0), Walk(((6.0, 0.0),), "search"), Kneel(15.0), Crawl(((12.0, 0.0),)),
    Walk(((12.0, 5.0),), "rubble"), Wait(15.0), Walk(((4.0, 5.0), (0.0, 0.0)), "hose"),
    Sit(60.0), Walk(((8.0, 0.0), (0.0, 0.0)), "laden"), Stand(2.0),
)  # fmt: skip

KINDS: tuple[Wearer, ...] = (
    Wearer("walks", walks("walk")),
    Wearer("limps", walks("limp")),
    Wearer("carries a load", walks("laden")),
    Wearer("walks backwards", walks("backwards")),
    Wearer("side steps", walks("sideways")),
    Wearer("pulls a hose, slips", walks("hose")),
    Wearer("short steps in rubble", walks("rubble")),
    Wearer("runs 100 m", (Stand(4.0), Walk(((50.0, 0.0), (0.0, 0.0)), "run"), Stand(3.0))),
    Wearer(
        "sprints 160 m, clips at 16 g",
        (Stand(4.0), Walk(((80.0, 0.0), (0.0, 0.0)), "sprint"), Stand(3.0)),
    ),
    Wearer("crawls 34 m", (Stand(4.0), Crawl(CRAWLED), Stand(3.0))),
    Wearer("stands about for 10 min, then walks", (Stand(4.0), Wait(600.0), *walks("walk")[1:])),
    Wearer("kneels between", between_rounds(Kneel(30.0))),
    Wearer("sits between, legs crossed", between_rounds(Sit(90.0))),
    Wearer("searches, kneels, crawls, pulls, sits", _SEARCHER),
    Wearer("two risers at once, five floors", floors(5, at_once=2)),
    Wearer("the same, running, one at once", floors(5, pace="run")),
    Wearer("winding stairs, 1.5 turns a floor", winding(5)),
    Wearer("four floors with corridors between", corridors(4)),
    Wearer("six floors with pauses", floors(6, between=_BREATHER)),
    Wearer("the same at 60 Hz", floors(6, between=_BREATHER), rate_hz=60.0),
    Wearer("the same at 820 Hz", floors(6, between=_BREATHER), rate_hz=820.0),
    Wearer("walks, recorded from mid-walk on", walks("walk"), cut_s=7.3),
    Wearer("crawls, recorded from mid-crawl on", (Stand(4.0), Crawl(CRAWLED)), cut_s=9.3),
)


def measure_wearers(wearers: int = WEARERS) -> list[WearerKindErrors]:
    """Let all of them walk."""
    jobs = [(kind, calibrated) for kind in KINDS for calibrated in (True, False)]
    bar = progress_bar(jobs, description="Walking", console=Console(stderr=True), transient=True)
    return [
        _together(
            kind, calibrated, [stray(kind, FIRST_SEED + k, calibrated) for k in range(wearers)]
        )
        for kind, calibrated in bar
    ]


def stray(kind: Wearer, seed: int, calibrated: bool) -> WearerErrors:
    """Let one of them walk, track and compare."""
    sensors = CONSUMER_SENSORS if calibrated else UNCALIBRATED_SENSORS
    scenario = Scenario(kind.does, kind.does, kind.legs, rate_hz=kind.rate_hz)
    simulation = Simulation(scenario, seed, sensors)
    imu = inertial_samples(simulation).part(slice(round(kind.cut_s * kind.rate_hz), None))
    description = replace(simulation.description, mag_present=False, barometer_present=False)
    rows = track(description, imu, "eskf")
    at = np.arange(0, len(rows), round(_EVERY_S * kind.rate_hz))
    way_m, drift_rad = true_way_m(
        rows.quaternion_nb[at], simulation.truth(np.asarray(rows.t_ns[at] * 1e-9, np.float64))
    )
    off_m = rows.position_n_m[at] - way_m
    nees = horizontal_nees(rows.position_n_m[at], way_m, rows.position_cov_m2[at])[1:]
    error_m = float(np.hypot(off_m[:, 0], off_m[:, 1]).max())
    far_off = (nees > 9.0 * CHI2_95_2DOF) & (rows.quality[at][1:] == Quality.GOOD)
    return WearerErrors(
        path=error_m / _length_m(way_m),
        error_m=error_m,
        heading_rad=float(drift_rad[-1]),
        heading_std_rad=float(rows.heading_std_rad[at[-1]]),
        height_m=float(off_m[-1, 2]),
        height_std_m=float(np.hypot(np.sqrt(rows.position_cov_m2[at[-1], 2, 2]), _STOOD_M)),
        inside=float(np.mean(nees <= CHI2_95_2DOF)),
        silent=float(np.mean(far_off)),
    )


def _length_m(way_m: Floats) -> float:
    """Length of the path, by about one position a stride, so that standing adds nothing."""
    steps_m = np.linalg.norm(np.diff(way_m[::2], axis=0), axis=1)
    return max(float(steps_m[steps_m > 0.15].sum()), 1.0)


def _together(kind: Wearer, calibrated: bool, strayed: list[WearerErrors]) -> WearerKindErrors:
    def of(name: str) -> Floats:
        return np.array([getattr(one, name) for one in strayed])

    return WearerKindErrors(
        does=kind.does,
        calibrated=calibrated,
        path=rms(of("path")),
        error_m=rms(of("error_m")),
        heading_deg=float(np.degrees(rms(of("heading_rad")))),
        heading_stated_deg=float(np.degrees(rms(of("heading_std_rad")))),
        height_m=rms(of("height_m")),
        height_stated_m=rms(of("height_std_m")),
        inside=float(np.mean(of("inside"))),
        silent=float(np.mean(of("silent"))),
    )


def wearers_table(results: list[WearerKindErrors]) -> Table:
    table = Table(title="Simulated wearers: error beside what is stated of it")
    for title in ("wearer", "sensors"):
        table.add_column(title)
    for title in ("path, %", "m", "heading, deg", "height, m", "inside 95 %", "silent %"):
        table.add_column(title, justify="right")
    for one in results:
        table.add_row(
            one.does,
            "calibrated" if one.calibrated else "data sheet",
            f"{100.0 * one.path:.1f}",
            f"{one.error_m:.2f}",
            f"{one.heading_deg:.1f} / {one.heading_stated_deg:.1f}",
            f"{one.height_m:.2f} / {one.height_stated_m:.2f}",
            f"{100.0 * one.inside:.0f}",
            f"{100.0 * one.silent:.0f}",
        )
    return table
