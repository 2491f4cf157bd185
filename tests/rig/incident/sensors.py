"""Sensors of an incident: units, receivers and barometers, with errors of models of their own.

Where the magnitudes come from:

- The own path: ``eskf`` on simulated wearers (``muster edge run --source sim:gets-hot`` and the
  other scenarios) keeps scale to 0.2 % and height on the flat to centimetres; what it loses is
  heading, at a rate that hardly changes over ten minutes and differs from wearer to wearer: -2.7,
  +2.5, -0.4 and -1.5 degrees a minute.  So the rate is drawn once a person and wanders a little;
  it acts while the wearer moves.  Half of the trackers say how uncertain their heading is; the
  other half are one and a half times too sure.
- The receiver: 1.27 m an axis under the open sky, as data sheets of single-frequency receivers
  have it (CEP 1.5 m), nearly all of it slow; the same as in ``edge.simulation.gps``.  Half of the
  slow part is everybody's at the site: orbits, clocks and the air.  By the error budgets it is far
  more (National Research Council 1995, The Global Positioning System, table C-1: 7.9 m of range
  against 1.3 m of multipath and noise), but corrections from satellites have taken off much of it,
  and receivers on bodies do not all see the same satellites.  The receiver of the engine stands on
  its roof; what its surroundings add lasts longer, because it does not move.  Walls add an error
  that the stated accuracy tells a third of.  Through the door the last fixes are rubbish.
- Pressure: a trend of up to 350 Pa an hour, the offset of each barometer, and steps when doors
  open or a fan is started.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.signal import lfilter

from base_station.fusion.gnss.screening import STD_FLOOR_M
from base_station.fusion.interface import PlaceFix
from shared.geo import pressure_pa_at
from shared.messages import Header, Position
from tests.rig import message_factory
from tests.rig.incident.building import SteelBuilding
from tests.rig.incident.people import RATE_HZ, Truth
from tests.rig.published_path import reckoned

Floats = NDArray[np.float64]

DRIFT_STD_RADPS = math.radians(2.0) / 60.0  # of the heading, while moving
DRIFT_WANDER_RADPS = math.radians(0.2) / 60.0  # of that rate in a minute
HEADING_RAD_PER_SQRT_M = 0.0026
TURN_PART = 0.003
SCALE_STD = 0.002
STEP_M_PER_SQRT_M = 0.02  # each axis
CLIMB_PART_STD = 0.02
FLIGHT_STD_M = 0.08
MISSED_FLIGHT = 0.015  # of flights: seen a metre too high or too low
TOO_SURE = 1.5
MOVING_MPS = 0.1

COMMON_M, COMMON_S = 0.85, 1200.0
OPEN_SLOW_M, OPEN_WHITE_M, OPEN_SLOW_S = 0.85, 0.4, 40.0
ROOF_SLOW_M, ROOF_WHITE_M, ROOF_SLOW_S = 0.6, 0.3, 300.0
OPEN_STD_M = math.hypot(COMMON_M, OPEN_SLOW_M, OPEN_WHITE_M)
WALL_M, WALL_REACH_M, WALL_SLOW_S = 6.0, 5.0, 15.0
RUBBISH_M, RUBBISH_INSIDE_S, FOUND_AGAIN_S = 8.0, 8.0, 4.0
ADMITTED = 1.0 / 3.0  # part of what walls do that the receiver's accuracy tells

SITE_M = 120.0  # above the sea
WEATHER_PA_PER_H = 350.0
OFFSET_STD_PA, NOISE_PA = 60.0, 1.5
STEPS_MOST, STEP_PA = 4, 30.0


@dataclass(frozen=True)
class OdometryRows:
    """Output of a unit's tracker, row by row, in the unit's own frame."""

    place_m: Floats  # (n, 3)
    turn_rad: float  # heading of the own north in the incident frame, at the start
    drift_rad: Floats  # (n,) how far the heading has drifted since
    heading_std_rad: Floats  # (n,) as stated
    distance_m: Floats  # (n,) truly walked


def walk_it(rng: np.random.Generator, truth: Truth) -> OdometryRows:
    steps_m = truth.steps_m
    lengths_m = np.linalg.norm(steps_m[:, :2], axis=1)
    moving_s = (lengths_m * RATE_HZ > MOVING_MPS) / RATE_HZ
    rates_radps = rng.normal(0.0, DRIFT_STD_RADPS) + DRIFT_WANDER_RADPS * np.cumsum(
        rng.normal(size=len(moving_s)) * np.sqrt(moving_s / 60.0)
    )
    wander_rad = rng.normal(size=len(moving_s)) * HEADING_RAD_PER_SQRT_M * np.sqrt(lengths_m)
    turned_rad = _turned(steps_m)
    wander_rad += rng.normal(0.0, TURN_PART) * turned_rad
    drift_rad = np.cumsum(rates_radps * moving_s + wander_rad)
    turn_rad = float(rng.uniform(-math.pi, math.pi))
    own_m = reckoned(steps_m, drift_rad - turn_rad) * (1.0 + rng.normal(0.0, SCALE_STD))
    noise_m = STEP_M_PER_SQRT_M * np.sqrt(lengths_m)
    own_m += (noise_m * rng.normal(size=(2, len(own_m)))).T
    stated = np.hypot(
        DRIFT_STD_RADPS * np.cumsum(moving_s),
        HEADING_RAD_PER_SQRT_M * np.sqrt(np.cumsum(lengths_m)),
    )
    stated /= TOO_SURE if rng.random() < 0.5 else 1.0
    place_m = np.column_stack([np.cumsum(own_m, axis=0), _heights(rng, steps_m)])
    return OdometryRows(place_m, turn_rad, drift_rad, stated, np.cumsum(lengths_m))


def _turned(steps_m: Floats) -> Floats:
    """By how much each step turns from the one before, while walking."""
    heading_rad = np.arctan2(steps_m[:, 1], steps_m[:, 0])
    walks = np.linalg.norm(steps_m[:, :2], axis=1) > 0.05
    last = np.maximum.accumulate(np.where(walks, np.arange(len(walks)), 0))
    heading_rad = heading_rad[last]
    turned = np.diff(heading_rad, prepend=heading_rad[:1])
    return np.asarray((turned + math.pi) % (2.0 * math.pi) - math.pi, dtype=np.float64)


def _heights(rng: np.random.Generator, steps_m: Floats) -> Floats:
    climbs_m = steps_m[:, 2] * (1.0 + rng.normal(0.0, CLIMB_PART_STD))
    climbing = np.abs(steps_m[:, 2]) > 1e-6
    flights = np.flatnonzero(np.diff(climbing.astype(int)) < 0)
    climbs_m[flights] += rng.normal(0.0, FLIGHT_STD_M, len(flights))
    missed = flights[rng.random(len(flights)) < MISSED_FLIGHT]
    climbs_m[missed] += rng.choice([-1.0, 1.0], len(missed))
    return np.asarray(np.cumsum(climbs_m), dtype=np.float64)


def draw_sky_m(rng: np.random.Generator, t_s: Floats) -> Floats:
    """The error that all receivers share (n, 2)."""
    return COMMON_M * _wandering(rng, len(t_s), COMMON_S)


def engine_fixes_of(
    rng: np.random.Generator, t_s: Floats, engine_m: tuple[float, float], sky_m: Floats
) -> dict[int, PlaceFix]:
    """Fixes of the receiver on the engine's roof, by row."""
    slow_m = ROOF_SLOW_M * _wandering(rng, len(t_s), ROOF_SLOW_S)
    places_m = np.array(engine_m) + sky_m + slow_m + ROOF_WHITE_M * rng.normal(size=sky_m.shape)
    return {
        row: PlaceFix(
            t_mono_ns=message_factory.mono_ns(float(t_s[row])),
            north_m=float(places_m[row, 0]),
            east_m=float(places_m[row, 1]),
            down_m=0.0,
            horizontal_std_m=STD_FLOOR_M,
            vertical_std_m=None,
        )
        for row in range(0, len(t_s), RATE_HZ)
    }


def _wandering(rng: np.random.Generator, count: int, lasts_s: float) -> Floats:
    """First-order Gauss-Markov process of unit variance (n, 2)."""
    keep = math.exp(-1.0 / RATE_HZ / lasts_s)
    fresh = math.sqrt(1.0 - keep**2) * rng.normal(size=(count, 2))
    fresh[0] = rng.normal(size=2)
    return np.asarray(lfilter([1.0], [1.0, -keep], fresh, axis=0), dtype=np.float64)


def fixes_of(
    rng: np.random.Generator, truth: Truth, building: SteelBuilding, sky_m: Floats
) -> dict[int, PlaceFix]:
    """Satellite fixes, one a second where there is any, by row."""
    slow, wall_slow = rng.normal(size=2), rng.normal(size=2)
    keep, wall_keep = (math.exp(-1.0 / tau_s) for tau_s in (OPEN_SLOW_S, WALL_SLOW_S))
    fixes: dict[int, PlaceFix] = {}
    for row in range(0, len(truth.t_s), RATE_HZ):
        t_s = float(truth.t_s[row])
        north_m, east_m = truth.place_m[row, :2]
        slow = keep * slow + math.sqrt(1.0 - keep**2) * rng.normal(size=2)
        wall_slow = wall_keep * wall_slow + math.sqrt(1.0 - wall_keep**2) * rng.normal(size=2)
        white = OPEN_WHITE_M * rng.normal(size=2)
        if truth.goes_in_s + RUBBISH_INSIDE_S < t_s < truth.comes_out_s + FOUND_AGAIN_S:
            continue
        std_m = walls_m(building, north_m, east_m)
        error_m = sky_m[row] + OPEN_SLOW_M * slow + white + std_m * wall_slow
        fixes[row] = PlaceFix(
            t_mono_ns=message_factory.mono_ns(t_s),
            north_m=float(north_m + error_m[0]),
            east_m=float(east_m + error_m[1]),
            down_m=0.0,
            horizontal_std_m=max(STD_FLOOR_M, math.hypot(OPEN_STD_M, ADMITTED * std_m)),
            vertical_std_m=None,
        )
    return fixes


def walls_m(building: SteelBuilding, north_m: float, east_m: float) -> float:
    """Standard deviation of what walls add to a fix, each axis."""
    outside_m = -building.depth_inside_m(north_m, east_m)
    return RUBBISH_M if outside_m <= 0.0 else WALL_M * math.exp(-outside_m / WALL_REACH_M)


@dataclass(frozen=True)
class SharedPressure:
    """The pressure that all barometers of an incident share, as a height that it feigns."""

    weather_pa: Floats  # (n,)
    inside_pa: Floats  # (n,) what doors and fans add in the building


def draw_air(rng: np.random.Generator, t_s: Floats) -> SharedPressure:
    weather_pa = rng.uniform(-1.0, 1.0) * WEATHER_PA_PER_H * t_s / 3600.0
    inside_pa = np.zeros(len(t_s))
    for _ in range(int(rng.integers(1, STEPS_MOST + 1))):
        inside_pa[t_s > rng.uniform(60.0, t_s[-1])] += rng.normal(0.0, STEP_PA)
    return SharedPressure(weather_pa, inside_pa)


def pressures_pa(rng: np.random.Generator, air: SharedPressure, truth: Truth) -> Floats:
    """Readings of one person's barometer (n,)."""
    inside = (truth.t_s > truth.goes_in_s) & (truth.t_s < truth.comes_out_s)
    return _stated_pa(rng, -truth.place_m[:, 2], air.weather_pa + air.inside_pa * inside)


def reference_pa(rng: np.random.Generator, air: SharedPressure) -> Floats:
    """Readings of the station's own barometer (n,)."""
    return _stated_pa(rng, np.zeros(len(air.weather_pa)), air.weather_pa)


def _stated_pa(rng: np.random.Generator, height_m: Floats, added_pa: Floats) -> Floats:
    pa_per_m = pressure_pa_at(SITE_M + 1.0) - pressure_pa_at(SITE_M)
    true_pa = pressure_pa_at(SITE_M) + pa_per_m * height_m + added_pa
    noise_pa = rng.normal(0.0, OFFSET_STD_PA) + NOISE_PA * rng.normal(size=len(height_m))
    return np.asarray(true_pa + noise_pa, dtype=np.float64)


def positions_of(truth: Truth, own: OdometryRows) -> list[Position]:
    """Positions published for such a path by a unit without a name and a barometer."""
    return [_position_of(truth, own, row) for row in range(len(truth.t_s))]


def _position_of(truth: Truth, own: OdometryRows, row: int) -> Position:
    north_m, east_m, down_m = own.place_m[row].tolist()
    heading_std_rad = float(own.heading_std_rad[row])
    moved_m = truth.steps_m[row] if row else np.zeros(3)
    std_m = math.hypot(0.1, heading_std_rad * math.hypot(north_m, east_m))
    return message_factory.position(
        Header("", 1, row + 1, message_factory.mono_ns(float(truth.t_s[row]))),
        north_m=north_m,
        east_m=east_m,
        down_m=down_m,
        std_north_m=std_m,
        std_east_m=std_m,
        heading_std_rad=heading_std_rad,
        distance_m=float(own.distance_m[row]),
        stationary=bool(np.linalg.norm(moved_m) * RATE_HZ < MOVING_MPS),
    )
