"""Recovery of saturated readings: a parabola between the slopes of both flanks, and its
uncertainty.

A swinging foot turns past the full scale of many gyroscopes for some tens of milliseconds.  The
hidden part of a run of duration T between slopes s1 and s2 is the parabola ``4 u (1 - u) p`` with
``u`` from 0 to 1 and peak ``p = T (s1 + s2) / 8``, times a scale that the landings of this wearer
show (see bridge_scale).  What is left of its error becomes noise about the saturated axis only
(``hidden_noise``, rad^2/s).

A saturated force is recovered likewise, along its axis (``hidden_force_noise``, m^2/s^3): what is
cut off a sprinter's swing would make the distance too short by a sixth, and the next stance shows,
by the velocity that is missing, how much of it was there.  A strike changes the force faster than a
swing and is soon over: a slope is evidence of what is hidden only as far as it lasts, so it is
taken over a quarter as long.  Where both flanks are steep right beside the hidden part, the gentler
one counts.
"""

from __future__ import annotations

from numba import njit

from edge.tracker.foot.config import EskfConfig
from edge.tracker.foot.state import Bridge
from edge.tracker.preprocessing.sample_ring import Ring

SLOPE_SAMPLES = 3
SLOPE_PART = 4  # a slope of the force is taken over this part of what is hidden
RUN_MAX_SHARE = 0.75  # of the look-ahead, so that it holds the slope that follows too


@njit()
def bridge_index(axis: int, rate_radps: float) -> int:
    """Return the number of the scale that bridged rates about an axis of the sensor have."""
    return 2 * axis if rate_radps > 0.0 else 2 * axis + 1


@njit()
def recover_rates(ring: Ring, bridge: Bridge, k: int, stop: int, config: EskfConfig) -> None:
    """At the first clipped sample ``k`` of an axis put the whole run right, in the ring.

    Looks at samples before ``stop`` and within the look-ahead.  ``bridge_radps`` of the run becomes
    what is put in before it is scaled, ``hidden_noise`` the density (rad^2/s) of what may still be
    wrong.  The scale in ``bridge`` is less certain with every run.
    """
    mask = len(ring) - 1
    slot = k & mask
    for axis in range(3):
        if not ring[slot].rate_saturated[axis] or ring[slot].hidden_noise[axis] > 0.0:
            continue
        end = k
        while (
            end < stop
            and ring[end & mask].rate_saturated[axis]
            and ring[end & mask].t_s - ring[slot].t_s <= RUN_MAX_SHARE * config.timing.lookahead_s
        ):
            end += 1
        _recover_rate_run(ring, bridge, k, end, stop, axis, config)


@njit()
def _recover_rate_run(
    ring: Ring, bridge: Bridge, first: int, end: int, stop: int, axis: int, config: EskfConfig
) -> None:
    mask = len(ring) - 1
    begin_s = ring[first & mask].t_s
    duration_s = ring[(end - 1) & mask].t_s - begin_s + ring[first & mask].period_s
    side = 1.0 if ring[first & mask].gyro_radps[axis] > 0.0 else -1.0
    rise = 0.0
    fall = 0.0
    if first >= SLOPE_SAMPLES:
        rise = side * _slope(ring, first - SLOPE_SAMPLES, first, axis)
    if end + SLOPE_SAMPLES <= stop:
        fall = -side * _slope(ring, end - 1, end - 1 + SLOPE_SAMPLES, axis)
    slope_radps2 = 0.5 * (max(rise, 0.0) + max(fall, 0.0))
    peak_radps = min(0.25 * slope_radps2 * duration_s, config.clipping.hidden_rate_limit_radps)
    index = bridge_index(axis, side)
    scale = max(bridge.scale[index], config.clipping.bridge_scale_min)
    bridge.covariance[index, index] += config.clipping.bridge_scale_walk**2
    std_radps = (
        config.clipping.hidden_rate_floor_radps
        + config.clipping.hidden_rate_std_ratio * scale * peak_radps
    )
    for k in range(first, end):
        u = (ring[k & mask].t_s - begin_s + 0.5 * ring[first & mask].period_s) / duration_s
        ring[k & mask].bridge_radps[axis] = side * 4.0 * u * (1.0 - u) * peak_radps
        ring[k & mask].gyro_radps[axis] += scale * ring[k & mask].bridge_radps[axis]
        ring[k & mask].hidden_noise[axis] = std_radps**2 * duration_s


@njit()
def recover_forces(ring: Ring, k: int, stop: int, config: EskfConfig) -> None:
    """At the first sample ``k`` of a run of clipped force put the whole run right, in the ring.

    Looks at samples before ``stop`` and within the look-ahead.  ``hidden_force_noise`` of the run
    becomes the density (m^2/s^3) of what may still be wrong.
    """
    mask = len(ring) - 1
    for axis in range(3):
        end = k
        positive = ring[k & mask].accel_mps2[axis] > 0.0
        while (
            end < stop
            and ring[end & mask].force_saturated[axis]
            and (ring[end & mask].accel_mps2[axis] > 0.0) == positive
            and ring[end & mask].t_s - ring[k & mask].t_s
            <= RUN_MAX_SHARE * config.timing.lookahead_s
        ):
            ring[end & mask].force_saturated[axis] = 0
            end += 1
        if end > k:
            _recover_force_run(ring, k, end, stop, axis, config)


@njit()
def _recover_force_run(
    ring: Ring, first: int, end: int, stop: int, axis: int, config: EskfConfig
) -> None:
    mask = len(ring) - 1
    period_s = ring[first & mask].period_s
    begin_s = ring[first & mask].t_s
    duration_s = ring[(end - 1) & mask].t_s - begin_s + period_s
    side = 1.0 if ring[first & mask].accel_mps2[axis] > 0.0 else -1.0
    span = max(1, (end - first + SLOPE_PART // 2) // SLOPE_PART)
    rise, fall = _flanks(ring, first, end, stop, axis, side, span)
    slope_mps3 = 0.5 * (rise + fall)
    rise, fall = _flanks(ring, first, end, stop, axis, side, 1)
    slope_mps3 = max(slope_mps3, min(rise, fall))
    peak_mps2 = min(0.25 * slope_mps3 * duration_s, config.clipping.hidden_force_limit_mps2)
    std_mps2 = (
        config.clipping.hidden_force_floor_mps2 + config.clipping.hidden_force_std_ratio * peak_mps2
    )
    for k in range(first, end):
        u = (ring[k & mask].t_s - begin_s + 0.5 * period_s) / duration_s
        ring[k & mask].accel_mps2[axis] += side * 4.0 * u * (1.0 - u) * peak_mps2
        ring[k & mask].hidden_force_noise[axis] = std_mps2**2 * duration_s


@njit()
def _flanks(
    ring: Ring, first: int, end: int, stop: int, axis: int, side: float, span: int
) -> tuple[float, float]:
    """Return how fast a force rises before the run and falls after it, over ``span`` samples."""
    mask = len(ring) - 1
    span_s = span * max(ring[first & mask].period_s, 1e-4)
    rise = 0.0
    fall = 0.0
    if first > span:
        before, onset = ring[(first - 1 - span) & mask], ring[(first - 1) & mask]
        rise = max(side * (onset.accel_mps2[axis] - before.accel_mps2[axis]), 0.0) / span_s
    if end + span < stop:
        over, after = ring[end & mask], ring[(end + span) & mask]
        fall = max(side * (over.accel_mps2[axis] - after.accel_mps2[axis]), 0.0) / span_s
    return rise, fall


@njit()
def _slope(ring: Ring, first: int, last: int, axis: int) -> float:
    mask = len(ring) - 1
    interval_s = ring[last & mask].t_s - ring[first & mask].t_s
    if interval_s <= 0.0:
        return 0.0
    change = ring[last & mask].gyro_radps[axis] - ring[first & mask].gyro_radps[axis]
    return float(change / interval_s)
