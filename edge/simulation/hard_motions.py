"""Scenarios of the motions that are hard for a foot tracker, each as recorded people do them.

Feet that pause in mid-air, slide along the floor or hardly stop on it; sensors that clip or are
slow.  Each ends at the height at which it began, and on most the way is not closed: what a
tracker makes too short is seen at the end.
"""

from __future__ import annotations

from edge.simulation.legs import Leg, RaiseFoot, StairsLeg, StairsPace, Stand, Turn, Walk
from edge.simulation.scenario import Scenario

_RISERS, _RISER_M, _TREAD_M = 9, 0.17, 0.28
_FLIGHT_M = _RISERS * _TREAD_M
_SPRINT = (Stand(5.0), Walk(((88.0, 0.0),), "race"), Walk(((94.0, 0.0),)), Stand(5.0))


def _flights(count: int, pace: StairsPace = "walk") -> tuple[Leg, ...]:
    """Up so many flights with half landings, and down again."""
    legs: list[Leg] = []
    for rise_m in count * [_RISERS * _RISER_M] + count * [-_RISERS * _RISER_M]:
        away = len(legs) % 4 == 0
        there = (6.0 + _FLIGHT_M, 0.0) if away else (6.0, 0.0)
        legs += [StairsLeg(there, rise_m, _RISERS, pace=pace), Turn(180.0 if away else 0.0)]
    return tuple(legs)


HARD_MOTIONS: tuple[Scenario, ...] = (
    Scenario(
        "raised-feet",
        "raises the foot on the spot and puts it down slowly, walks in between",
        (
            Stand(5.0),
            RaiseFoot(8, 0.5),
            Walk(((6.0, 0.0),)),
            RaiseFoot(8, 0.7),
            Walk(((0.0, 0.0),)),
            Stand(5.0),
        ),
    ),
    Scenario(
        "careful-steps",
        "feels its way ahead, each foot slowly raised, held and put down; down stairs likewise",
        (
            Stand(5.0),
            Walk(((6.0, 0.0),), "careful"),
            *_flights(2, "careful"),
            Walk(((0.0, 0.0),), "careful"),
            Stand(5.0),
        ),
    ),
    Scenario(
        "dragged-foot",
        "drags a foot in a brace along the floor, stride after stride",
        (
            Stand(5.0),
            Walk(((20.0, 0.0), (20.0, 20.0)), "drag"),
            Stand(5.0),
        ),
    ),
    Scenario(
        "changing-gaits",
        "walks and runs in turn, from one stride to the next, and stops dead",
        (
            Stand(5.0),
            Walk(((8.0, 0.0),)),
            Walk(((20.0, 0.0),), "jog"),
            Walk(((26.0, 0.0),)),
            Walk(((48.0, 0.0),), "race"),
            Walk(((54.0, 0.0),)),
            Stand(2.0),
            Walk(((40.0, 0.0),), "jog"),
            Walk(((36.0, 0.0),), "careful"),
            Walk(((10.0, 0.0),), "race"),
            Walk(((0.0, 0.0),)),
            Stand(5.0),
        ),
        conversions=8,
    ),
    Scenario(
        "sprint-800hz",
        "sprints 88 m on the flat, sampled at 800 Hz; the accelerometer clips at 16 g",
        _SPRINT,
        rate_hz=800.0,
        conversions=2,
    ),
    Scenario(
        "sprint-500dps",
        "sprints 88 m on the flat; the gyroscope clips at 500 deg/s, the accelerometer at 16 g",
        _SPRINT,
        rate_hz=800.0,
        conversions=2,
        gyro_full_scale_degps=500.0,
    ),
    Scenario(
        "run-100hz",
        "runs two rounds of 90 m on the flat, sampled at 100 Hz",
        (
            Stand(5.0),
            Walk(2 * ((30.0, 0.0), (30.0, 15.0), (0.0, 15.0), (0.0, 0.0)), "jog"),
            Stand(5.0),
        ),
        rate_hz=100.0,
        conversions=16,
    ),
    Scenario(
        "stairs-500hz",
        "up eight flights of stairs and down again, sampled at 500 Hz",
        (Stand(5.0), Walk(((6.0, 0.0),)), *_flights(8), Walk(((0.0, 0.0),)), Stand(5.0)),
        rate_hz=500.0,
        conversions=4,
    ),
)
