"""Parameters of ``gps-inertial``: errors of units, receivers and movement."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Parameters:
    walk_m_per_sqrt_m: float = 0.03  # the own path's error by distance, each axis
    turn_rad_per_sqrt_m: float = 0.004  # its heading's wander by distance
    turn_part: float = 0.004  # and by turning
    scale_std: float = 0.015
    drift_radps: float = 6e-4  # of its heading while moving, where the unit states none: 2 deg/min
    drift_least_radps: float = 6e-5
    drift_most_radps: float = 2e-3
    drift_inflation: float = 1.3  # units are too sure of their heading
    drift_wander_radps: float = 6e-5  # of that rate in a minute
    climb_m_per_sqrt_climb_m: float = 0.12  # height error by height climbed
    climb_m_per_sqrt_m: float = 0.01  # and by distance
    level_m: float = 0.5  # a wearer who climbs less than this does not change floor
    level_walk_m: float = 6.0  # walked like that: on a storey
    level_std_m: float = 0.25  # how level storeys are
    level_sure: float = 0.95
    air_std_m: float = 0.3  # a barometer's noise, gusts included
    air_m_per_sqrt_s: float = 0.02  # its shift's wander where the weather is known
    weather_m_per_sqrt_s: float = 0.2  # and where it is not: 350 Pa an hour
    slow_s: float = 30.0  # correlation time of a receiver's own slow error
    height_slow_part: float = 0.8  # of a satellite height's variance
    height_slow_s: float = 60.0
    wall_std_m: float = 4.0  # deviation that an outer wall adds to a fix beside it
    wall_reach_m: float = 5.0  # falling off by distance
    inside_std_m: float = 8.0  # and being inside
    correlated_fixes: float = 16.0  # in a row, of about the same error beyond the receiver's own
    gate: float = 13.8  # chi-square of 2 degrees of freedom, 99.9 %
    linear_rad: float = 0.2  # heading standard deviation from which one hypothesis will do
    aligned_rad: float = 0.35  # and from which the heading is called known
    unsure_m: float = 5.0  # standard deviation of a place that is called degraded
    lost_m: float = 30.0  # and lost
    height_std_floor_m: float = 5.0
    open_sky_m: float = 5.0  # standard deviation of a fix, which no receiver has far inside
    fastest_mps: float = 12.0
    unguided_mps: float = 1.5  # speed of a wearer while nothing is received of the path
    restart_m: float = 5.0  # and how far while the unit starts again
    climb_part: float = 0.1  # of the way that a wearer went unseen, up or down
    stuck_fixes: int = 5
    stuck_m: float = 8.0
    max_rejected_count: int = 20
