"""Scales of bridged rates: six errors beside the 22 of the filter, learned from swing to swing.

What a parabola puts in the place of a clipped rate (see saturation_recovery) is off by a factor of
0.3 to 1.5, which depends on the wearer and on the phase of the swing, and is alike in every swing.
A landing shows it: the angle that is missing about the clipped axis tilts the foot, and gravity
turns that into a velocity.  So each axis and side of the gyroscope has a scale, which the filter
estimates together with its own errors: what one swing shows corrects the bridges of those to come
and, through the covariance, the heading that the past ones have turned.

The covariance of the scales with the error state (6, 22) is in rows of the clone (see
correction_tracking), that among them in ``bridge.covariance``.  Nothing measures a scale itself, so
the gains of the 22 are right as they are.  Nothing is computed here before a rate clips.
"""

from __future__ import annotations

from numba import njit

from edge.tracker.foot.config import EskfConfig
from edge.tracker.foot.error_state import ATTITUDE, SIZE
from edge.tracker.foot.preprocessing.saturation_recovery import bridge_index
from edge.tracker.foot.state import BRIDGES, CLONES, FilterState


@njit()
def start_bridges(state: FilterState, config: EskfConfig) -> None:
    """Write what is known of the scales before any landing."""
    for i in range(BRIDGES):
        state.bridge.scale[i] = 1.0
        state.bridge.covariance[i, i] = config.clipping.bridge_scale_std**2


@njit()
def propagate_bridge(state: FilterState, axis: int, bridged_rad: float) -> None:
    """Add to the attitude's covariance what the scale leaves open of a bridged angle.

    ``bridged_rad`` is that of an interval about an axis of the sensor, before it is scaled.
    """
    if bridged_rad == 0.0:
        return
    state.clone.rows = CLONES + BRIDGES
    index = bridge_index(axis, bridged_rad)
    p, own, rows = state.covariance, state.bridge.covariance, state.clone.covariance
    for i in range(3):
        turned_rad = state.rotation_nb[i, axis] * bridged_rad
        for j in range(SIZE):
            p[ATTITUDE + i, j] += turned_rad * rows[CLONES + index, j]
            p[j, ATTITUDE + i] += turned_rad * rows[CLONES + index, j]
        for j in range(3):
            turned_too_rad = state.rotation_nb[j, axis] * bridged_rad
            p[ATTITUDE + i, ATTITUDE + j] += turned_rad * turned_too_rad * own[index, index]
    for i in range(3):
        turned_rad = state.rotation_nb[i, axis] * bridged_rad
        for b in range(BRIDGES):
            rows[CLONES + b, ATTITUDE + i] += turned_rad * own[b, index]


@njit()
def update_bridges(state: FilterState, weight: float) -> None:
    """Take into the covariance of the scales a measurement that the clone has just taken.

    ``weight`` is the inverse variance of its innovation.
    """
    if state.clone.rows == CLONES:
        return
    column, own = state.clone.column, state.bridge.covariance
    for i in range(BRIDGES):
        for j in range(BRIDGES):
            own[i, j] -= weight * column[CLONES + i] * column[CLONES + j]


@njit()
def correct_bridges(state: FilterState) -> None:
    """Add to the scales what the updates of one instant have gathered."""
    for i in range(BRIDGES):
        state.bridge.scale[i] += state.clone.error[CLONES + i]
        state.clone.error[CLONES + i] = 0.0
