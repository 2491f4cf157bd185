"""Walls of the plan hold a smoothed trail; also with a plan that is shifted or shows another
building.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from base_station.fusion.interface import Estimate, Start
from base_station.fusion.odometry.path_history import PathHistory
from base_station.fusion.smoothing import SMOOTHERS
from base_station.fusion.smoothing.chain import Chain, WalkNoise
from base_station.fusion.smoothing.common_errors import START_PART
from base_station.fusion.smoothing.interface import (
    PositionConstraint,
    SmoothedPath,
    Smoother,
    UnitEvidence,
)
from base_station.fusion.smoothing.wall_constraints import WallSegments
from base_station.site.floor_grid import FloorGrid
from base_station.site.wall_crossing import BESIDE, FREE, WALL
from shared.clock import NS_PER_S
from shared.messages import Header
from shared.path_noise import PathNoise
from shared.quality import Quality
from tests.rig.message_factory import position
from tests.rig.walled_plan import walled_grid

Floats = NDArray[np.float64]
Line = list[tuple[float, float]]

RADIUS_M, WIDE_M = 8.0, 1.6  # of a round corridor: it has no right angles
START = Start(0.0, RADIUS_M, 0.0, 0.0, 0.5, 0.05)


@pytest.fixture(params=SMOOTHERS, ids=lambda smoother: smoother.name)
def smoother(request: pytest.FixtureRequest) -> Smoother:
    found: Smoother = request.param
    return found


def ring(radius_m: float) -> Line:
    angles_rad = np.linspace(0.0, math.tau, 33)
    return list(
        zip(
            (radius_m * np.sin(angles_rad)).tolist(),
            (radius_m * np.cos(angles_rad)).tolist(),
            strict=True,
        )
    )


def grid_of(lines: list[Line], off_m: tuple[float, float] = (0.0, 0.0)) -> FloorGrid:
    """Lines as (north, east), drawn so far north and east of their places."""
    moved = [[[east + off_m[1], north + off_m[0]] for north, east in line] for line in lines]
    return walled_grid(moved[0], moved)


def corridor(off_m: tuple[float, float] = (0.0, 0.0)) -> FloorGrid:
    return grid_of([ring(RADIUS_M + WIDE_M / 2.0), ring(RADIUS_M - WIDE_M / 2.0)], off_m)


def rounds(
    drift_radps: float, lasts_s: int = 240, live_std_m: float | None = None
) -> tuple[PathHistory, Floats]:
    """Along the corridor's middle at 1 m/s, round after round; and the truth by the second.
    ``live_std_m``: of live estimates at the truth; without it there are none.
    """
    angles_rad = np.arange(lasts_s) / RADIUS_M
    truth = RADIUS_M * np.column_stack((np.sin(angles_rad), np.cos(angles_rad)))
    history, own = PathHistory(), 0j
    steps = np.diff(truth[:, 0] + 1j * truth[:, 1], prepend=complex(*truth[0]))
    for second, step in enumerate(steps.tolist()):
        own += step * np.exp(1j * drift_radps * second)
        t_ns = second * NS_PER_S
        header = Header("FF-01", 1, second + 1, t_ns)
        history.append(position(header, north_m=own.real, east_m=own.imag), t_ns, jumped=False)
        if live_std_m is not None:
            history.set_live_estimate(estimate_at(t_ns, truth[second], live_std_m), None)
    return history, truth


def estimate_at(t_ns: int, place_m: Floats, std_m: float) -> Estimate:
    north_m, east_m = place_m.tolist()
    spread = std_m, std_m, 0.1, 0.0, 0.0, 0.05
    return Estimate(t_ns, north_m, east_m, 0.0, *spread, Quality.GOOD, "", None)


def solved(smoother: Smoother, history: PathHistory, **more: Any) -> SmoothedPath:
    evidence = UnitEvidence(history.arrays(), START, **more)
    return smoother.solve({"FF-01": evidence}).paths["FF-01"]


def errors_of(path: SmoothedPath, truth: Floats) -> Floats:
    seconds = np.arange(len(truth))
    t_ns = seconds * NS_PER_S
    north, east = (np.interp(t_ns, path.t_ns, one) for one in (path.north_m, path.east_m))
    errors: Floats = np.hypot(north - truth[seconds, 0], east - truth[seconds, 1])
    return errors


def test_walls_correct_a_heading_that_drifts(smoother: Smoother) -> None:
    """Across the corridor only: along it there is no evidence."""
    history, _ = rounds(1.5e-3)
    alone, held = solved(smoother, history), solved(smoother, history, grid=corridor())
    aside_m = {
        name: float(np.abs(np.hypot(path.north_m, path.east_m) - RADIUS_M).mean())
        for name, path in (("alone", alone), ("held", held))
    }
    assert aside_m["held"] < 0.35
    assert aside_m["held"] < 0.5 * aside_m["alone"]


def test_plan_of_another_building_is_not_used(smoother: Smoother) -> None:
    """Its walls run across the way; the trail is the same without it."""
    history, _ = rounds(0.0)
    across: list[Line] = [[(north, -10.0), (north, 10.0)] for north in range(-10, 11)]
    other = grid_of([ring(12.0), *across])
    alone, beside = solved(smoother, history), solved(smoother, history, grid=other)
    assert np.allclose(alone.north_m, beside.north_m, atol=0.2)
    assert np.allclose(alone.east_m, beside.east_m, atol=0.2)


def test_live_estimates_stay_where_a_path_is_known_no_better_than_a_room(
    smoother: Smoother,
) -> None:
    """Walls leave several places of such a path; a fuser may have found which. The start lies 3 m
    along the corridor from where it was stated.
    """
    start = Start(3.0, RADIUS_M, 0.0, 0.0, 3.0, 0.05)
    hand = PathNoise(0.08, 0.28, 0.014)
    (history, truth), (live, _) = rounds(0.0), rounds(0.0, live_std_m=1.0)
    walled, held = (
        smoother.solve(
            {"FF-01": UnitEvidence(one.arrays(), start, grid=corridor(), path_noise=hand)}
        ).paths["FF-01"]
        for one in (history, live)
    )
    assert errors_of(walled, truth).mean() > 1.5
    assert errors_of(held, truth).mean() < 1.0
    assert np.hypot(held.std_north_m, held.std_east_m).min() > 0.5


def test_room_beside_walls_counts_less_on_a_noisy_path() -> None:
    history, _ = rounds(0.0, lasts_s=60)
    likelihood = {}
    for worn, noise in (("foot", None), ("hand", PathNoise(0.08, 0.28, 0.014))):
        evidence = UnitEvidence(history.arrays(), START, path_noise=noise)
        chain = Chain.of(evidence, WalkNoise(), knot_m=4.0, knot_s=30.0)
        likelihood[worn] = np.exp(WallSegments.of(chain, corridor()).log_beside)
    assert len(likelihood["foot"]) == len(likelihood["hand"]) >= 20
    assert likelihood["foot"].max() < 0.6
    assert likelihood["hand"].min() > 0.8


def test_pins_show_the_offset_of_a_plan(smoother: Smoother) -> None:
    history, truth = rounds(0.0)
    plan = corridor(off_m=(0.5, -0.4))
    pins = [
        PositionConstraint(
            str(t_s), t_s * NS_PER_S, float(truth[t_s, 0]), float(truth[t_s, 1]), 0.15
        )
        for t_s in (40, 100, 160, 220)
    ]
    path = solved(smoother, history, grid=plan, places=pins)
    assert errors_of(path, truth).mean() < 0.25
    north_m, east_m = path.posterior.mean[:2]
    assert north_m - path.north_m[-1] == pytest.approx(0.5, abs=0.25)  # it continues on the plan
    assert east_m - path.east_m[-1] == pytest.approx(-0.4, abs=0.25)


def test_units_that_begin_at_one_engine_have_a_common_error(smoother: Smoother) -> None:
    """Ten are no surer of its place than the one that was told."""
    evidence = {
        f"FF-{number:02}": UnitEvidence(rounds(0.0, 60)[0].arrays(), START) for number in range(10)
    }
    paths = smoother.smooth(evidence).paths.values()
    surest_m = min(float(path.std_north_m.min()) for path in paths)
    assert 0.95 * math.sqrt(START_PART) * START.std_m < surest_m < 1.1 * START.std_m


def test_moved_paths_cross_the_same_walls() -> None:
    rng, grid = np.random.default_rng(3), corridor()
    from_m = rng.uniform(-12.0, 12.0, (60, 2))
    to_m, moves_m = from_m + rng.normal(size=(60, 2)), rng.normal(size=(60, 7, 2))
    met = grid.crossings_shifted(0, from_m, to_m, moves_m)
    assert set(np.unique(met).tolist()) == {FREE, BESIDE, WALL}
    for move in range(7):
        moved = grid.crossings(0, from_m + moves_m[:, move], to_m + moves_m[:, move])
        # a longest path is checked more often
        assert np.mean((met[:, move] == WALL) == (moved == WALL)) > 0.95
        assert np.mean(met[:, move] == moved) > 0.9
