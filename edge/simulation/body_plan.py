"""Body plan: a walking person's right leg and trunk at every time, as curves."""

from __future__ import annotations

from bisect import bisect_right

from edge.simulation.curve import Curve
from edge.simulation.lift_motion import LiftMotion
from shared.messages.status import Activity

SENSOR_HEIGHT_M = 0.08  # of the instep above the sole
STANDING_PELVIS_M = 0.87  # of the pelvis above the instep
LEG_LENGTH_M = STANDING_PELVIS_M  # of the pendulum that a leg is about the foot it stands on


class BodyPlan:
    """NED metres in the site frame, radians; every curve starts standing upright.

    ``north``, ``east`` and ``down`` are where the instep is when the foot is flat;
    ``pivot`` is 0 when the foot rolls about its ball and 1 when about its heel;
    ``rock`` is what it pitches besides, on the sole below the instep;
    ``tremor`` scales the small motion that a living body never quite stops.
    """

    def __init__(self, north_m: float, east_m: float, down_m: float, yaw_rad: float) -> None:
        self.north = Curve(north_m)
        self.east = Curve(east_m)
        self.down = Curve(down_m - SENSOR_HEIGHT_M)
        self.lift = Curve(0.0)
        self.floor = LiftMotion()  # down, of a lift
        self.yaw = Curve(yaw_rad)
        self.pitch = Curve(0.0)
        self.roll = Curve(0.0)
        self.pivot = Curve(0.0)
        self.rock = Curve(0.0)
        self.shank_pitch = Curve(0.0)  # besides the lean of the whole leg, as the knee bends
        self.thigh_pitch = Curve(0.0)  # likewise
        self.pelvis_height = Curve(STANDING_PELVIS_M)
        self.trunk_pitch = Curve(0.0)
        self.bounce = Curve(0.0)  # of the trunk, down positive, twice a stride
        self.sway = Curve(0.0)  # of the trunk to the right, once a stride
        self.tremor = Curve(1.0)
        self.duration_s = 0.0
        self.activity_start_s: list[float] = []
        self.activities: list[Activity] = []
        self.footfall_s: list[float] = []  # when each stride ended

    def begin(self, activity: Activity) -> None:
        """From now on the person does this."""
        if not self.activities or self.activities[-1] is not activity:
            self.activities.append(activity)
            self.activity_start_s.append(self.duration_s)

    def activity(self, t_s: float) -> Activity:
        return self.activities[max(0, bisect_right(self.activity_start_s, t_s) - 1)]
