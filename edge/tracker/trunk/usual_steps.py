"""Steps of a usual walk, and the doubt of any other (frequency range: Li et al. 2014).

Lengths by acceleration or frequency are fitted to people who walk on level floors.  Runs, dragged
feet and stairs are not what they know, and are off by up to three times.  The length by the
frequency of steps, carried on beyond its range, is a second opinion there: a deviation is what the
two are apart, and no less than a share of the length.
"""

from __future__ import annotations

from typing import NamedTuple

from numba import njit

SHORTEST_M = 0.05  # a share of less has no meaning


class UsualSteps(NamedTuple):
    """Range of a usual walk, and the length of its steps by their frequency as published."""

    slope_m_per_hz: float = 0.4504
    offset_m: float = -0.1656
    least_hz: float = 1.35
    most_hz: float = 2.45
    stairs_m: float = 0.06  # by which a step rises or falls on them
    least_force: float = 0.5  # by gravity, on the trunk of who walks; who runs is in the air
    unusual_std: float = 0.5  # of the length of any other step, at least


@njit()
def length_at(frequency_hz: float, usual: UsualSteps) -> float:
    """Return 0.4504 f - 0.1656, in m; within the range that the paper gives or beyond it."""
    return max(usual.slope_m_per_hz * frequency_hz + usual.offset_m, 0.0)


@njit()
def is_usual(steps: int, lasted_s: float, climbed_m: float, usual: UsualSteps) -> bool:
    """Return whether so many steps are those of a walk on a level floor.

    ``climbed_m`` is what they have risen (or fallen, negative) together.
    """
    frequency_hz = steps / lasted_s
    is_walk = usual.least_hz <= frequency_hz <= usual.most_hz
    return bool(is_walk and abs(climbed_m) < steps * usual.stairs_m)


@njit()
def length_doubt_m(steps: int, lasted_s: float, length_m: float, usual: UsualSteps) -> float:
    """Return the deviation of ``length_m``, the way of so many steps that are not usual."""
    apart_m = abs(length_m - steps * length_at(steps / lasted_s, usual))
    return max(apart_m, usual.unusual_std * length_m)


@njit()
def length_std(
    steps: int, lasted_s: float, length_m: float, usual_std: float, usual: UsualSteps
) -> float:
    """Return the deviation of steps that are not usual by their length."""
    doubt_m = length_doubt_m(steps, lasted_s, length_m, usual)
    return max(usual_std, doubt_m / max(length_m, SHORTEST_M))
