"""Learning of the length of a person's steps, over walks.

A tracker by steps takes the steps of everybody for as long as people's are in the mean.  What one
walk shows of a person is not all of that person: the same walks a little longer or shorter another
time.  The figures are those of nine people (``tests/bench/tracker/body_recordings.py``): 3.7 %
between them, and as much between the walks of one; 8 % are stated of people who are not known.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

from edge.tracker.interface import StepScale
from shared.path_noise import PathNoise

UNKNOWN = StepScale(1.0, 0.071)  # with WALK_STD the 8 % of the tracker
WALK_STD = 0.037  # of one walk of a person from the mean of all of them
_PLACE_STD = 0.2  # m a root metre, of a path that does not state it
_TAPE_STD = 0.01  # of a length that a person has measured
_LEAST, _MOST = 0.5, 2.0  # beyond these it is no walk


def is_of_a_walk(factor: float) -> bool:
    """Return True for the scale of steps that somebody may have made."""
    return _LEAST <= factor <= _MOST


def scale_by_length(length_m: float, tracked_m: float, noise: PathNoise | None) -> StepScale:
    """Return what a walk of known length shows; ``noise``: of the path that was tracked."""
    stated = None if noise is None else noise.place_std_m_per_sqrt_m
    path_std = (_PLACE_STD if stated is None else stated) / math.sqrt(tracked_m)
    factor = length_m / tracked_m
    return StepScale(factor, factor * math.hypot(path_std, _TAPE_STD))


def start_scale(learnt: StepScale) -> StepScale:
    """Return what a walk that begins has to be taken for."""
    return StepScale(learnt.factor, math.hypot(learnt.std, WALK_STD))


def start_scales(learnt: Mapping[str, StepScale]) -> dict[str, StepScale]:
    """Return the same for each place."""
    return {place: start_scale(one) for place, one in learnt.items()}


def learn(learnt: StepScale | None, walk: StepScale) -> StepScale:
    """Return what is known of a person after one more walk, with the scale that it has shown."""
    before = learnt or UNKNOWN
    of_walk = walk.std**2 + WALK_STD**2
    share = before.std**2 / (before.std**2 + of_walk)
    return StepScale(
        before.factor + share * (walk.factor - before.factor),
        math.sqrt((1.0 - share) * before.std**2),
    )
