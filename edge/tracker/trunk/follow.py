"""One sample through what does not depend on how steps are found: attitude, height, a row."""

from __future__ import annotations

from numba import njit

from edge.samples import Floats
from edge.tracker.preprocessing.sample_ring import Ring
from edge.tracker.trunk.attitude import begin_attitude, follow_attitude
from edge.tracker.trunk.dead_reckoning import watch_motion, write_standing
from edge.tracker.trunk.pressure_height import follow_height
from edge.tracker.trunk.state import TrunkConfig, TrunkState


@njit()
def follow_sample(
    ring: Ring, trunk: TrunkState, k: int, angle_b_rad: Floats, config: TrunkConfig
) -> None:
    """Take sample ``k``, and write its row as if the wearer stood; ``angle_b_rad`` is scratch."""
    mask = len(ring) - 1
    if k == 0:
        begin_attitude(ring, trunk, k, config)
    else:
        dt_s = ring[k & mask].t_s - ring[(k - 1) & mask].t_s
        if 0.0 < dt_s <= config.gap_s:
            follow_attitude(ring, trunk, k, dt_s, angle_b_rad, config)
        watch_motion(trunk, max(dt_s, 0.0), config)
    follow_height(ring[k & mask], trunk, config)
    write_standing(ring, trunk, k, config)
