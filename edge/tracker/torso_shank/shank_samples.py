"""Samples of the shank, as far as the torso's have come.

No sample comes more than ``MOST_LAG_S`` behind one of the other sensor.  So where the torso's
newest is that much later than a moment, every sample of the shank up to that moment is there, and
a shank that has none is silent.  What a torso's sample meets does not depend on how samples come.
"""

from __future__ import annotations

from numba import njit

from edge.samples import Floats
from edge.tracker.preprocessing.sample_ring import Ring, span
from edge.tracker.torso_shank.leg_swing import follow_shank
from edge.tracker.torso_shank.state import ShankState, TorsoShankConfig
from edge.tracker.trunk.kernel_tracker import is_past, take_times
from edge.tracker.trunk.state import TrunkState

_NS_PER_S = 1_000_000_000
NEVER_NS = -(2**62)  # before all times


@njit()
def all_arrived_ns(ring: Ring, trunk: TrunkState, config: TorsoShankConfig, final: bool) -> int:
    """Return the time up to which all samples of the shank have come, by the torso's newest."""
    if final:
        return -NEVER_NS
    if trunk.received == 0:
        return NEVER_NS
    newest_ns = ring[(trunk.received - 1) & (len(ring) - 1)].t_ns
    return int(newest_ns - int(config.lag_s * _NS_PER_S))


@njit()
def take_shank_times(
    ring: Ring, shank: ShankState, arrived_ns: int, config: TorsoShankConfig, final: bool
) -> None:
    """Give the samples of the shank their times; none is waited for that would be there."""
    trunk = shank.trunk
    if trunk.received == 0:
        return
    newest_ns = ring[(trunk.received - 1) & (len(ring) - 1)].t_ns
    late_ns = int(config.trunk.late_delivery_s * _NS_PER_S)
    take_times(ring, trunk, config.trunk, final or arrived_ns > newest_ns + late_ns)


@njit()
def take_shank_until(
    ring: Ring,
    shank: ShankState,
    t_ns: int,
    arrived_ns: int,
    angle_b_rad: Floats,
    config: TorsoShankConfig,
) -> bool:
    """Take the samples up to a time; return True if they are all there and taken."""
    trunk = shank.trunk
    mask = len(ring) - 1
    area_ns = int(config.area_s * _NS_PER_S)
    while trunk.walked < trunk.timed:
        k = trunk.walked
        row_ns = ring[k & mask].t_ns
        if row_ns > t_ns:
            return True
        if not is_past(ring, trunk, k, config.area_s) and arrived_ns <= row_ns + area_ns:
            return False
        follow_shank(ring, shank, k, angle_b_rad, config)
        trunk.walked = k + 1
    return bool(trunk.walked == trunk.received and (arrived_ns >= t_ns or shank.walked_ns >= t_ns))


@njit()
def take_backlog(
    ring: Ring, shank: ShankState, angle_b_rad: Floats, config: TorsoShankConfig
) -> None:
    """Take what the ring cannot hold until a silent torso comes back."""
    trunk = shank.trunk
    while trunk.walked < trunk.timed and trunk.received - trunk.walked > 2 * span(ring):
        follow_shank(ring, shank, trunk.walked, angle_b_rad, config)
        trunk.walked += 1
