"""Toe-off and initial contact of a foot, on a walk in closed form and on recorded ones."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from edge.activity.gait_events import find_gait_events
from edge.samples import Floats
from edge.tracker.interface import TrackBatch
from edge.tracker.track_rows import empty_rows
from tests.rig.exact_strides import EASE, SWAY

STANCE_S, SWING_S = 0.5, 0.6
PERIOD_S = STANCE_S + SWING_S
STRIDES = 6
MOUNT = Rotation.from_rotvec([0.4, -1.9, 0.8])


def walked(rate_hz: float = 200.0, stride_m: float = 1.2, heading_rad: float = 0.5) -> TrackBatch:
    """Each stride a stance and a swing: toe down, then toe up, about the foot's own right."""
    t_s = np.arange(0.0, STRIDES * PERIOD_S + 1.0, 1.0 / rate_hz)
    stride = np.minimum(np.floor(t_s / PERIOD_S), STRIDES - 1)
    share = np.clip((t_s - stride * PERIOD_S - STANCE_S) / SWING_S, 0.0, 1.0)
    along_m = stride_m * (stride + EASE(share))
    facing = Rotation.from_euler("ZY", np.column_stack((0.0 * share + heading_rad, -SWAY(share))))
    return replace(
        empty_rows(),
        t_ns=np.rint(t_s * 1e9).astype(np.int64),
        position_n_m=np.outer(along_m, [np.cos(heading_rad), np.sin(heading_rad), 0.0]),
        quaternion_nb=(facing * MOUNT).as_quat(scalar_first=True),
        stationary=(share == 0.0) | (share == 1.0),
        steps=np.zeros(len(t_s), np.int64),
    )


def without(rows: TrackBatch, from_s: float, until_s: float) -> TrackBatch:
    kept = (rows.t_ns < from_s * 1e9) | (rows.t_ns > until_s * 1e9)
    return replace(
        rows,
        t_ns=rows.t_ns[kept],
        position_n_m=rows.position_n_m[kept],
        quaternion_nb=rows.quaternion_nb[kept],
        stationary=rows.stationary[kept],
        steps=rows.steps[kept],
    )


def true_events_s() -> Floats:
    """Toe-off and contact (n, 2): halfway between the fastest turn toe down and its end."""
    stops = sorted(u for u in SWAY.deriv().roots.real if 0.01 < u < 0.99)
    fastest = sorted(u for u in SWAY.deriv(2).roots.real if 0.01 < u < 0.99)
    shares = np.array([(stops[0] + fastest[0]) / 2.0, (stops[-1] + fastest[-1]) / 2.0])
    return STANCE_S + PERIOD_S * np.arange(STRIDES)[:, None] + SWING_S * shares


@pytest.mark.parametrize("rate_hz", [60.0, 100.0, 200.0, 820.0])
@pytest.mark.parametrize("heading_rad", [0.5, -2.5])
def test_events_lie_between_the_fastest_turn_and_its_end(rate_hz, heading_rad):
    events = find_gait_events(walked(rate_hz, heading_rad=heading_rad))
    toe_off_s, contact_s = true_events_s().T
    assert events.toe_off_s == pytest.approx(toe_off_s, abs=0.01)
    assert events.initial_contact_s == pytest.approx(contact_s, abs=0.01)


def test_a_foot_that_turns_without_a_stride_has_no_events():
    assert len(find_gait_events(walked(stride_m=0.1))) == 0


def test_no_rows_have_no_events():
    assert len(find_gait_events(empty_rows())) == 0


def test_a_swing_with_a_gap_has_no_events_and_the_others_keep_theirs():
    lost_s = STANCE_S + 2 * PERIOD_S + SWING_S / 2.0
    events = find_gait_events(without(walked(), lost_s - 0.08, lost_s + 0.08))
    kept = np.arange(STRIDES) != 2
    assert events.toe_off_s == pytest.approx(true_events_s()[kept, 0], abs=0.01)
