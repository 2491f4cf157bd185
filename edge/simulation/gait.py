"""Gait: motion of a foot in one stride, for every way of moving that is simulated.

The shape follows the sagittal gait cycle (Perry, "Gait Analysis", 1992): the heel
rises about the ball of the foot, the foot swings, strikes with the heel and
rolls about it until it is flat.  Backwards the toes come down first and the heel leaves last.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import pi, radians

from shared.messages.status import Activity


@dataclass(frozen=True, slots=True)
class Gait:
    """Measures of one stride; windows are fractions of the time the foot moves."""

    activity: Activity
    stride_m: float  # two steps
    stride_s: float
    flat: float  # fraction of the stride in which the foot stands
    toe_off_rad: float  # pitch when the toe leaves the ground, toe down negative
    strike_rad: float  # pitch when the foot touches down, toe up positive
    clearance_m: float  # extra height in mid-swing
    bounce_m: float = 0.018  # half of the trunk's rise and fall
    sway_m: float = 0.02  # of the trunk to either side
    forward: tuple[float, float] = (0.22, 0.95)  # when the foot goes forward
    upward: tuple[float, float] = (0.25, 0.90)  # when it goes to another height
    raised: tuple[float, float] = (0.30, 0.60)  # when it rises by its clearance
    lowered: tuple[float, float] = (0.60, 0.90)  # ... and is put down
    tipped: tuple[float, float] = (0.42, 0.84)  # when its toe is lowest, and when it has come back
    facing_rad: float = 0.0  # of the body, clockwise from where it goes
    lands_on_heel: bool = True  # ... or on the ball
    leaves_on_heel: bool = False
    sink_rad: float = 0.0  # by which the heel sinks while the ball stands, off the tread's edge
    uneven_m: float = 0.0  # of what lies on the floor, root mean square
    tilt_rad: float = 0.0  # deviation of its slopes
    slip_m: float = 0.0  # by which the shoe slips back when it pushes off
    flattens_s: float = 0.05  # after it has touched down it is flat
    leaves: float = 0.75  # fraction of the stance after which it rolls over the ball (or the heel)
    rolls_radps: float = radians(6.0)  # in mid-stance, mean
    creeps_mps: float = 0.0106  # along the floor and into it, in mid-stance
    strike_mps: float = 0.0  # down, at which the floor stops the foot
    strike_ahead_mps: float = 0.0  # likewise forward
    rings_rad: float = 0.0  # by which the struck shoe rocks
    scrapes_m: float = 0.0  # of the floor's roughness, for a foot that is dragged along it
    turns: float = 1.0  # how far it rolls and points outward in mid-swing, by a walker's


WALK = Gait(Activity.WALKING, 1.36, 1.06, 0.34, radians(-62), radians(20), 0.04)
SEARCH = Gait(Activity.WALKING, 0.95, 1.15, 0.42, radians(-45), radians(12), 0.05, 0.010)
HURRY = Gait(Activity.WALKING, 1.60, 0.96, 0.30, radians(-68), radians(24), 0.04, 0.022)
RUN = Gait(Activity.RUNNING, 2.10, 0.74, 0.20, radians(-75), radians(12), 0.10, 0.035, 0.01)
SPRINT = Gait(Activity.RUNNING, 3.10, 0.60, 0.15, radians(-85), radians(5), 0.16, 0.03, 0.01)
TURN = Gait(Activity.WALKING, 0.40, 0.95, 0.40, radians(-25), radians(4), 0.05, 0.006)
LADEN = Gait(Activity.WALKING, 0.80, 1.40, 0.48, radians(-30), radians(6), 0.02, 0.008)
LIMP = replace(  # this leg hurts: it stands briefly, hardly rolls and is pulled along
    LADEN, stride_m=0.90, stride_s=1.30, flat=0.22, toe_off_rad=radians(-18), strike_rad=radians(-4)
)
BACKWARDS = Gait(
    activity=Activity.WALKING,
    stride_m=0.90,
    stride_s=1.15,
    flat=0.36,
    toe_off_rad=radians(18),
    strike_rad=radians(-25),
    clearance_m=0.04,
    facing_rad=pi,
    lands_on_heel=False,
    leaves_on_heel=True,
)
SIDEWAYS = Gait(
    activity=Activity.WALKING,
    stride_m=0.55,
    stride_s=1.10,
    flat=0.40,
    toe_off_rad=radians(-16),
    strike_rad=radians(-6),
    clearance_m=0.04,
    facing_rad=-pi / 2.0,
    lands_on_heel=False,
)
HOSE = replace(LADEN, stride_m=0.60, toe_off_rad=radians(-40), strike_rad=radians(3), slip_m=0.015)
RUBBLE = replace(
    SEARCH,
    stride_m=0.50,
    stride_s=1.25,
    strike_rad=radians(2),
    clearance_m=0.12,
    uneven_m=0.07,
    tilt_rad=radians(8),
)
STAIRS_UP = Gait(
    activity=Activity.STAIRS_UP,
    stride_m=0.56,
    stride_s=1.30,
    flat=0.42,
    toe_off_rad=radians(-40),
    strike_rad=radians(3),
    clearance_m=0.05,
    forward=(0.35, 0.95),
    upward=(0.2, 0.7),
)
STAIRS_DOWN = Gait(
    activity=Activity.STAIRS_DOWN,
    stride_m=0.56,
    stride_s=1.20,
    flat=0.40,
    toe_off_rad=radians(-32),
    strike_rad=radians(3),
    clearance_m=0.04,
    forward=(0.2, 0.7),
    upward=(0.4, 0.96),
)


# As rough as recorded feet, by the statistics that tests/unit/edge/simulation compares.
JOG = Gait(
    activity=Activity.RUNNING,
    stride_m=1.95,
    stride_s=0.85,
    flat=0.27,
    toe_off_rad=radians(-75),
    strike_rad=radians(10),
    clearance_m=0.10,
    bounce_m=0.035,
    sway_m=0.01,
    forward=(0.0, 1.0),
    lowered=(0.60, 1.0),
    leaves=0.5,
    rolls_radps=1.8,
    creeps_mps=0.03,
    strike_mps=0.5,
    strike_ahead_mps=0.4,
    rings_rad=0.008,
)
RACE = Gait(
    activity=Activity.RUNNING,
    stride_m=3.3,
    stride_s=0.61,
    flat=0.18,
    toe_off_rad=radians(-105),
    strike_rad=radians(-12),
    clearance_m=0.18,
    bounce_m=0.03,
    sway_m=0.01,
    forward=(0.0, 1.0),
    lowered=(0.60, 1.0),
    lands_on_heel=False,
    flattens_s=0.035,
    leaves=0.40,
    rolls_radps=1.5,
    creeps_mps=0.06,
    strike_mps=1.5,
    strike_ahead_mps=1.0,
    rings_rad=0.018,
)
CAREFUL = Gait(  # each foot is raised, held ahead and slowly put down, flat
    activity=Activity.WALKING,
    stride_m=0.70,
    stride_s=3.0,
    flat=0.42,
    toe_off_rad=radians(-30),
    strike_rad=radians(2),
    clearance_m=0.22,
    bounce_m=0.008,
    forward=(0.20, 0.70),
    raised=(0.05, 0.45),
    lowered=(0.50, 1.00),
    tipped=(0.25, 0.55),
)
DRAG = Gait(  # in a brace: the knee is stiff, the shoe never leaves the floor
    activity=Activity.WALKING,
    stride_m=0.60,
    stride_s=1.80,
    flat=0.25,
    toe_off_rad=radians(-4),
    strike_rad=radians(1),
    clearance_m=0.004,
    bounce_m=0.03,
    sway_m=0.05,
    forward=(0.08, 0.98),
    scrapes_m=0.0001,
    turns=0.15,
)
STAIRS_DOWN_CAREFUL = replace(
    STAIRS_DOWN,
    stride_s=3.2,
    strike_rad=radians(2),
    clearance_m=0.08,
    forward=(0.10, 0.50),
    upward=(0.40, 0.99),
    raised=(0.10, 0.40),
    lowered=(0.60, 0.99),
    tipped=(0.25, 0.50),
)
STAIRS_UP_CAREFUL = replace(
    STAIRS_UP,
    stride_s=3.0,
    upward=(0.05, 0.50),
    lowered=(0.60, 1.00),
    tipped=(0.30, 0.65),
)

STAIRS_UP_RUN = replace(  # on the balls of the feet, the heels over the edge
    STAIRS_UP,
    stride_s=0.78,
    flat=0.30,
    toe_off_rad=radians(-48),
    strike_rad=radians(-8),
    lands_on_heel=False,
    sink_rad=radians(5),
)
STAIRS_DOWN_RUN = replace(
    STAIRS_DOWN,
    stride_s=0.72,
    flat=0.26,
    toe_off_rad=radians(-36),
    strike_rad=radians(-14),
    lands_on_heel=False,
    sink_rad=radians(4),
)

STAIRS_PACES = {  # down, up
    "walk": (STAIRS_DOWN, STAIRS_UP),
    "run": (STAIRS_DOWN_RUN, STAIRS_UP_RUN),
    "careful": (STAIRS_DOWN_CAREFUL, STAIRS_UP_CAREFUL),
}
PACES: dict[str, Gait] = {
    "search": SEARCH,
    "walk": WALK,
    "hurry": HURRY,
    "run": RUN,
    "sprint": SPRINT,
    "laden": LADEN,
    "limp": LIMP,
    "backwards": BACKWARDS,
    "sideways": SIDEWAYS,
    "hose": HOSE,
    "rubble": RUBBLE,
    "jog": JOG,
    "race": RACE,
    "careful": CAREFUL,
    "drag": DRAG,
}
