"""Walks with a telephone in the hand: tracked, published as a unit does, and fused by the station.

The first waypoint is the start, and the direction from it to the first waypoint that is some metres
away is the first heading, both as somebody states them.  Everything after is by the path and by the
walls of the plan.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from base_station.fusion import FUSERS
from base_station.fusion.building_model.building import LearntBuilding
from base_station.fusion.interface import Estimate, Start
from base_station.fusion.odometry.path_history import PathHistory
from base_station.fusion.smoothing import SMOOTHERS
from base_station.fusion.smoothing.interface import UnitEvidence
from base_station.site.floor_grid import FloorGrid
from edge.agent.position_publisher import PositionPublisher
from edge.clocks.timeline import Timeline
from edge.sources.recording import RecordingSource, read_truth
from edge.tracker.registry import make_tracker
from edge.tracker.track_rows import join_rows
from shared.clock import NS_PER_S, SystemClock
from shared.header_factory import HeaderFactory
from shared.messages import Position
from tests.bench.phones.floor_plans import floor_plan

Floats = NDArray[np.float64]

RATE_HZ = 5.0  # of positions, as units are set
WAYPOINT_STD_M = 0.5  # to which people stand where they say
HEADING_M = 8.0  # walked, which shows the first direction
HEADING_STD_RAD = 0.15  # to which somebody points along a way; a hand sways as much
# Of their gyroscopes, whose bias Android corrects: its compatibility definition (7.3.9) wants less
# than this of sensors of high fidelity.
GYRO_BIAS_STD_RADPS = 0.002
ORIGIN_NS = 1000 * NS_PER_S  # of the unit's clock when the recording begins
LIVE, AFTERWARDS = "live", "afterwards"


@dataclass(frozen=True, slots=True, eq=False)
class PublishedPhone:
    """Messages that a unit publishes of one walk, and the waypoints."""

    name: str  # floor/trial
    positions: list[Position]
    waypoint_s: Floats  # (w,)
    waypoint_m: Floats  # (w, 2) north and east of the floor
    start: Start


@dataclass(frozen=True, slots=True, eq=False)
class WaypointErrors:
    """Errors at the waypoints after the start."""

    error_m: Floats  # (w - 1,)
    normalised2: Floats  # (w - 1,) chi-square of two degrees of freedom, where what is stated holds
    stated_m: Floats  # (w - 1,) root of the stated variance of both axes


def publish_walk(trial: Path, tracker: str) -> PublishedPhone:
    """Track a recording by a unit that is described as a telephone in a hand, and publish it."""
    source = RecordingSource(trial)
    description = replace(source.description, place="hand", gyro_bias_std_radps=GYRO_BIAS_STD_RADPS)
    worn = make_tracker(tracker, description)
    rows = join_rows([worn.push(source.imu), worn.finish()])
    publisher = PositionPublisher(HeaderFactory("", 1, SystemClock()), RATE_HZ)
    publisher.set_path_noise(worn.path_noise)
    positions = publisher.push(rows, Timeline(mono_origin_ns=ORIGIN_NS))
    truth = read_truth(trial)
    assert truth is not None, trial
    # The truth's axes are right-handed with z up: x is east on the plan and y is north.
    waypoint_m = np.column_stack((-truth.position_n_m[:, 1], truth.position_n_m[:, 0]))
    start = _start(positions, truth.t_s, waypoint_m)
    return PublishedPhone(
        f"{trial.parent.name}/{trial.name}", positions, truth.t_s, waypoint_m, start
    )


def _start(positions: list[Position], waypoint_s: Floats, waypoint_m: Floats) -> Start:
    """Start at the first waypoint, in the direction of the first one some metres away."""
    own_m = np.array([(one.north_m, one.east_m) for one in positions])
    passed_m = _between(_times_s(positions), own_m, waypoint_s)
    way_m = waypoint_m - waypoint_m[0]
    away_m = np.hypot(way_m[:, 0], way_m[:, 1])
    first = int((away_m > HEADING_M).argmax())
    own_way_m = passed_m[first] - passed_m[0]
    turn_rad = math.atan2(way_m[first, 1], way_m[first, 0]) - math.atan2(own_way_m[1], own_way_m[0])
    return Start(
        north_m=float(waypoint_m[0, 0]),
        east_m=float(waypoint_m[0, 1]),
        down_m=0.0,
        heading_rad=math.remainder(turn_rad, math.tau),
        std_m=WAYPOINT_STD_M,
        heading_std_rad=HEADING_STD_RAD,
    )


@cache
def _grid_of(floor: Path) -> FloorGrid | None:
    return FloorGrid.of(floor_plan(floor))


def fuse_walk(walk: PublishedPhone, floor: Path | None) -> Mapping[str, WaypointErrors]:
    """Fuse a walk, with the plan of a floor if given: what the station shows live, and what its
    smoother makes of it afterwards.
    """
    grid = None if floor is None else _grid_of(floor)
    fuser, history, learnt = FUSERS[0].new(), PathHistory(), LearntBuilding()
    fuser.set_map(grid)
    fuser.start(walk.start)
    live = np.zeros((len(walk.positions), 5))
    for row, position in enumerate(walk.positions):
        reason = fuser.predict(position)
        learnt = fuser.match_building(learnt)
        history.append(position, position.header.t_mono_ns, bool(reason))
        if row == 0:
            history.set_start(walk.start)
        estimate = fuser.estimate()
        assert estimate is not None
        history.set_live_estimate(estimate, None)
        live[row] = _row(estimate)
    evidence = UnitEvidence(
        history.arrays(),
        history.start.position,
        history.start.begin_ns,
        grid=grid,
        path_noise=history.path_noise,
        noise_runs=history.noise_runs,
    )
    path = SMOOTHERS[0].smooth({"": evidence}).paths[""]
    product_m2 = path.correlation_ne * path.std_north_m * path.std_east_m
    smoothed = np.column_stack(
        (path.north_m, path.east_m, path.std_north_m**2, path.std_east_m**2, product_m2)
    )
    return {
        LIVE: _errors(walk, _times_s(walk.positions), live),
        AFTERWARDS: _errors(walk, (path.t_ns - ORIGIN_NS) / NS_PER_S, smoothed),
    }


def _row(estimate: Estimate) -> list[float]:
    """Return north, east and the three members of their covariance."""
    north_m, east_m = estimate.std_north_m, estimate.std_east_m
    product_m2 = estimate.correlation_ne * north_m * east_m
    return [estimate.north_m, estimate.east_m, north_m**2, east_m**2, product_m2]


def _errors(walk: PublishedPhone, t_s: Floats, rows: Floats) -> WaypointErrors:
    at = _between(t_s, rows, walk.waypoint_s[1:])
    off_m = at[:, :2] - walk.waypoint_m[1:]
    stated_m2 = np.empty((len(at), 2, 2))
    stated_m2[:, 0, 0], stated_m2[:, 1, 1] = at[:, 2], at[:, 3]
    stated_m2[:, 0, 1] = stated_m2[:, 1, 0] = at[:, 4]
    known_m2 = stated_m2 + WAYPOINT_STD_M**2 * np.eye(2)
    squares = np.einsum("wi,wi->w", off_m, np.linalg.solve(known_m2, off_m[:, :, None])[:, :, 0])
    return WaypointErrors(
        error_m=np.hypot(off_m[:, 0], off_m[:, 1]),
        normalised2=squares,
        stated_m=np.sqrt(np.trace(known_m2, axis1=1, axis2=2)),
    )


def _between(t_s: Floats, rows: Floats, at_s: Floats) -> Floats:
    return np.column_stack([np.interp(at_s, t_s, column) for column in rows.T])


def _times_s(positions: list[Position]) -> Floats:
    t_ns = np.array([one.header.t_mono_ns for one in positions])
    return np.asarray((t_ns - ORIGIN_NS) / NS_PER_S, np.float64)
