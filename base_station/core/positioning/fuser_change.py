"""Change of the fuser during an incident: the new one continues from the last estimate."""

from __future__ import annotations

import math

import msgspec
import numpy as np

from base_station.fusion.interface import Fuser, Posterior, Start
from base_station.fusion.parameters import Parameters
from base_station.fusion.stated_noise import with_path_noise
from shared.messages import Position

OPEN_RAD = 0.5  # standard deviation from which a heading counts as unknown


def succeed(before: Fuser, after: Fuser, position: Position | None) -> None:
    """Bring a new fuser to the estimate of the one before, at the newest ``position`` of the own
    path.  Its other state is lost: errors of receivers, drift, and the age of the last fix.
    """
    if position is None:
        return
    after.predict(position)
    estimate = before.estimate()
    origin, beside = (
        before.estimate_at(msgspec.structs.replace(position, north_m=north_m, east_m=0.0))
        for north_m in (0.0, 1.0)
    )
    if estimate is None or origin is None or beside is None or estimate.assumed:
        return
    axis = np.array([beside.north_m - origin.north_m, beside.east_m - origin.east_m])
    heading_rad = math.atan2(axis[1], axis[0])
    is_open = estimate.heading_std_rad > OPEN_RAD
    std_m = max(origin.std_north_m, origin.std_east_m)
    heading_std_rad = math.pi if is_open else estimate.heading_std_rad
    place_m = origin.north_m, origin.east_m
    after.start(Start(*place_m, origin.down_m, heading_rad, std_m, heading_std_rad))
    if is_open:
        return
    across = np.array([-axis[1], axis[0]])
    covariance = np.zeros((5, 5))
    between_m2 = estimate.correlation_ne * estimate.std_north_m * estimate.std_east_m
    covariance[:2, :2] = [
        [estimate.std_north_m**2, between_m2],
        [between_m2, estimate.std_east_m**2],
    ]
    usual = with_path_noise(Parameters(), position.path_noise)
    covariance[2:4, 2:4] = heading_std_rad**2 * np.outer(across, across)
    covariance[2:4, 2:4] += usual.scale_std**2 * np.outer(axis, axis)
    covariance[4, 4] = usual.drift_radps**2
    mean = [estimate.north_m, estimate.east_m, *axis.tolist(), 0.0]
    reached = after.estimate()
    sunk_m = 0.0 if reached is None else estimate.down_m - reached.down_m
    after.set_posterior(Posterior(mean, covariance.tolist(), sunk_m, estimate.std_down_m))
