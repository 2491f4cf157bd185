"""Error state of the filter: order of its elements.

Errors are true minus estimated, in this order: position (m, NED), velocity (m/s, NED),
attitude (rad, small rotation in NED axes: ``R_true = (1 + [a x]) R``), turn (rad), gyroscope
bias (rad/s, sensor axes), accelerometer bias (m/s^2, sensor axes), lever (m, sensor axes)
from the point about which the foot rolls in stance to the sensor, and what a kelvin adds to the
gyroscope bias (rad/s/K, sensor axes).

The turn is the part of the heading's error that has turned the whole walk with it, by errors of
the gyroscope that are as systematic as the stride (see scale_misalignment, which keeps
its variance).  A walk turned as a whole looks the same to every stance, so it is tied to nothing
else here, and only a compass can observe it.
"""

from __future__ import annotations

POSITION = 0
VELOCITY = 3
ATTITUDE = 6
TURN = 9
GYRO_BIAS = 10
ACCEL_BIAS = 13
LEVER = 16
GYRO_BIAS_PER_K = 19
SIZE = 22
HEADING = SIZE  # stands for what a compass measures: the sum of ATTITUDE + 2 and TURN
