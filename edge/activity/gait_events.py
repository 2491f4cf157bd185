"""Gait events of a foot: toe-off and initial contact of each stride, by the pitch rate of the foot.

At push-off the foot turns toe down, fastest just before toe-off; in the swing it turns toe up until
the heel strikes, and toe down again while the sole comes to the ground.  Toe-off is taken halfway
between the fastest turn toe down and where the turn changes its sign, initial contact halfway
between the next change and the fastest turn that follows it: each pair lies around the event
(Aminian et al. 2002; Mariani et al. 2013).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.signal import butter, find_peaks, sosfiltfilt
from scipy.spatial.transform import Rotation

from edge.activity.strides import StrideCutter
from edge.samples import Floats
from edge.tracker.interface import TrackBatch

_RATE_HZ = 200.0  # of the pitch rate in which events are looked for
_KEPT_HZ = 20.0  # of its vibrations: a strike rings faster
_SWING_HZ = 3.0  # slower than the lobes of push-off and strike, as fast as a swing
_SLOWEST_SWING_RADPS = 1.0
_BETWEEN_SWINGS_S = 0.3
_PUSH_OFF_S = 0.6  # before the middle of a swing, at most
_CONTACT_S = 0.5  # after it, at most
_FOOT_AXIS_STRIDE_M = 0.5  # shorter strides do not show where the foot faces
_GAP_S = 0.1  # in the rows: an event in a longer one cannot be seen


@dataclass(frozen=True, slots=True, eq=False)
class GaitEvents:
    """Events of consecutive swings of one foot; (n,) each, seconds of the samples' clock."""

    toe_off_s: Floats
    initial_contact_s: Floats

    def __len__(self) -> int:
        return len(self.toe_off_s)


def find_gait_events(track: TrackBatch) -> GaitEvents:
    """Return the events of every swing in the rows of a foot's tracker, (n,) of any rate.

    There are none where no stride is long enough to show which way the foot faces, nor of swings
    with a gap.  Who walks backward from beginning to end has toe-off and contact exchanged.
    """
    across_b = _axis_across(track)
    if across_b is None:
        return GaitEvents(np.empty(0), np.empty(0))
    t_s, pitch_radps = _pitch_rate(track, across_b)
    events = [_events_of(t_s, pitch_radps, middle) for middle in _swings(pitch_radps)]
    found_s = np.array(events).reshape(-1, 2)
    toe_off_s, contact_s = found_s[~_have_gaps(found_s, track)].T
    return GaitEvents(toe_off_s, contact_s)


def _have_gaps(found_s: Floats, track: TrackBatch) -> NDArray[np.bool_]:
    t_s = track.t_ns * 1e-9
    before = np.flatnonzero(np.diff(t_s) > _GAP_S)
    begun = np.searchsorted(t_s[before], found_s[:, 1])
    ended = np.searchsorted(t_s[before + 1], found_s[:, 0])
    return np.asarray(begun > ended)


def _axis_across(track: TrackBatch) -> Floats | None:
    """Return the unit vector to the right of the foot (3,), sensor axes."""
    strides = [one for one in StrideCutter().push(track) if one.length_m >= _FOOT_AXIS_STRIDE_M]
    across_b = np.sum([np.cross(one.step_b, one.up_b) for one in strides], axis=0)
    length = float(np.linalg.norm(across_b))
    return across_b / length if strides and length > 0.0 else None


def _pitch_rate(track: TrackBatch, across_b: Floats) -> tuple[Floats, Floats]:
    """Return times (m,) of a constant rate, and the turn about ``across_b`` (m,), toe up."""
    t_s = track.t_ns * 1e-9
    attitude = Rotation.from_quat(track.quaternion_nb, scalar_first=True)
    turns_rad = (attitude[:-1].inv() * attitude[1:]).as_rotvec() @ across_b
    angle_rad = np.concatenate(([0.0], np.cumsum(turns_rad)))
    even_s = np.arange(t_s[0], t_s[-1], 1.0 / _RATE_HZ)
    rate_radps = np.gradient(np.interp(even_s, t_s, angle_rad), 1.0 / _RATE_HZ)
    return even_s, _low_passed(rate_radps, _KEPT_HZ)


def _low_passed(signal: Floats, cut_off_hz: float) -> Floats:
    filtered: Floats = sosfiltfilt(butter(2, cut_off_hz, fs=_RATE_HZ, output="sos"), signal)
    return filtered


def _swings(pitch_radps: Floats) -> NDArray[np.intp]:
    """Return the middle of each swing, as indices."""
    middles, _ = find_peaks(
        _low_passed(pitch_radps, _SWING_HZ),
        height=_SLOWEST_SWING_RADPS,
        distance=_BETWEEN_SWINGS_S * _RATE_HZ,
    )
    return np.asarray(middles)


def _events_of(t_s: Floats, pitch_radps: Floats, middle: int) -> tuple[float, float]:
    """Return toe-off and initial contact of the swing around ``middle``."""
    before = pitch_radps[max(0, middle - round(_PUSH_OFF_S * _RATE_HZ)) : middle + 1][::-1]
    after = pitch_radps[middle : middle + round(_CONTACT_S * _RATE_HZ)]
    toe_off = middle - _around(before, int(np.argmin(before)))
    crossed = _sign_change(after)
    contact = middle + _around(after, crossed + _first_minimum(after[crossed:]))
    index = np.arange(len(t_s))
    return float(np.interp(toe_off, index, t_s)), float(np.interp(contact, index, t_s))


def _around(lobe: Floats, fastest: int) -> float:
    return 0.5 * (_sign_change(lobe) + fastest)


def _sign_change(values: Floats) -> int:
    """Return the first index at which ``values`` is not positive; the last where there is none."""
    below = np.flatnonzero(values <= 0.0)
    return int(below[0]) if len(below) else len(values) - 1


def _first_minimum(values: Floats) -> int:
    rising = np.flatnonzero(np.diff(values) >= 0.0)
    return int(rising[0]) if len(rising) else len(values) - 1
