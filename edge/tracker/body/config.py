"""Parameters of the body's tracker.

The constants of step length are fitted by ``tests/bench/tracker/body_constants.py``; the others are
those of walking people and of usual sensors.
"""

from __future__ import annotations

from typing import NamedTuple

from edge.tracker.trunk.unseen_motion import UnseenMotion
from edge.tracker.trunk.usual_steps import UsualSteps

UNKNOWN_PLACE, TRUNK, HAND, POCKET = range(4)  # where the sensor is


class BodyConfig(NamedTuple):
    """Times in seconds; deviations are of one sigma."""

    gravity_mps2: float = 9.80665

    # Attitude: gyroscope, and slowly gravity, as steps throw the force about.
    levelling_per_s: float = 0.3
    rest_rate_radps: float = 0.08  # off the known bias, for who stands
    rest_force_mps2: float = 0.5  # of the vertical force from its mean
    rest_s: float = 0.5
    first_bias_std_radps: float = 0.007  # about an axis, where the description has none
    sway_radps: float = 0.035  # of who stands, in one tick
    bias_walk_radps: float = 3e-5  # in a root second

    # Steps: one swing of the vertical velocity each.
    low_pass_s: float = 0.02  # three times in a row
    leak_s: float = 0.3  # of the vertical velocity
    least_rise_mps: float = 0.03  # that a step has at least
    rise_share: float = 0.2  # of the rise of the steps before
    rise_memory_s: float = 3.0
    shortest_step_s: float = 0.25
    longest_step_s: float = 1.6
    hold_s: float = 0.9  # a row waits so long for the step that it belongs to

    # Step length: an inverted pendulum, see step_length.
    trunk_scale_m: float = 0.91
    hand_scale_m: float = 0.82
    hand_swing_mps2: float = 2.1  # level motion of a hand; of as much, half the rise is the arm's
    leg_m: float = 0.9  # hip joint to sole, where the person's is unknown
    thigh_above_radps: float = 1.0  # turn about level axes while walking; trunks and hands: 0.7
    thigh_below_radps: float = 0.8
    pivot_radps: float = 1.2  # a turn as fast halves the way of its steps
    hand_below: float = 0.2  # motion to and fro by that up and down
    trunk_above: float = 0.45
    hand_tips: float = 0.07  # motion in phase with the upward acceleration, by the vertical one
    trunk_tips: float = 0.15  # ... by that in phase with the downward velocity
    least_motion: float = 0.12  # in phase, by the vertical motion, that has a direction
    recognised_steps: float = 4.0
    place: int = UNKNOWN_PLACE
    scale_std: float = 0.08  # of an uncalibrated person
    step_std: float = 0.35  # of a single step, by its length, in a hand or a pocket
    trunk_step_std: float = 0.2  # ... on a trunk that is known to be one
    usual: UsualSteps = UsualSteps()  # beyond them a step is doubted; see step_doubt
    usual_step_m: float = 0.65  # of adults who walk indoors; see path_noise
    usual_speed_mps: float = 1.2  # of the same

    # Walking direction, apart from the sensor's own.
    direction_steps: float = 12.0  # memory

    # Path: what it may be off by.
    gain_std: float = 0.01  # of a turn, where the description has none
    heading_walk_rad: float = 0.015  # in a root second
    iron_std_ut: float = 25.0  # an axis, of iron worn near a sensor that was not calibrated
    iron_least_ut: float = 2.0  # ... and after a calibration
    iron_walk_ut: float = 0.2  # in a root second
    bend_std_ut: float = 8.0  # an axis, of the level magnetic field in a building
    bend_m: float = 6.0  # along which a bend is the same
    bend_s: float = 60.0
    compass_s: float = 0.5
    compass_std_ut: float = 1.0
    outlier_sigmas: float = 3.0
    unseen: UnseenMotion = UnseenMotion()
    sway_m: float = 0.05  # an axis, of the sensor on a person whose feet stand

    late_delivery_s: float = 0.04
    gap_s: float = 0.1
    saturation_ratio: float = 0.985
    fault_s: float = 2.0
    degraded_m: float = 3.0
    lost_m: float = 15.0
    unsettled_rad: float = 0.1
