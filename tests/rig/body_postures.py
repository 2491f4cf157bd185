"""A body that takes postures one after the other: samples of trunk, thigh and shank.

Angles are drawn from what people do, wider than a pattern of the estimator; each segment is an
inverted pendulum with its own mounting, noise and gyroscope bias.  It begins with a walk.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from edge.samples import Floats, ImuBatch, Nanoseconds
from shared.clock import NS_PER_S
from shared.messages import BodyPosture

RATE_HZ = 100.0
GRAVITY_MPS2 = 9.80665
_CHANGES_S = 1.5
_STRIDE_S = 1.1
_SWING_SHARE = 0.4
_PLACES = ("chest", "thigh", "shank")

Range = tuple[float, float]
# Degrees by which the front of trunk, thigh and shank is tipped up; and the body to its right.
_ANGLES: Mapping[BodyPosture, Sequence[tuple[Range, Range, Range, float]]] = {
    BodyPosture.STANDING: [((-20, 10), (-8, 12), (-8, 5), 0.0)],
    BodyPosture.SITTING: [
        ((-20, 25), (72, 98), (-20, 45), 0.0),
        ((-15, 15), (75, 100), (70, 95), 0.0),
    ],
    BodyPosture.KNEELING: [
        ((-40, 10), (-10, 25), (-105, -75), 0.0),
        ((-25, 10), (50, 75), (-105, -80), 0.0),
    ],
    BodyPosture.CRAWLING: [((-100, -62), (-12, 12), (-105, -75), 0.0)],
    BodyPosture.PRONE: [((-105, -75), (-105, -78), (-105, -70), 0.0)],
    BodyPosture.SUPINE: [
        ((75, 105), (75, 110), (70, 100), 0.0),
        ((75, 105), (115, 145), (25, 60), 0.0),
    ],
    BodyPosture.LEFT_SIDE: [((-12, 12), (-10, 30), (-35, 10), -90.0)],
    BodyPosture.RIGHT_SIDE: [((-12, 12), (-10, 30), (-35, 10), 90.0)],
    BodyPosture.BENT: [((-75, -48), (-10, 15), (-10, 8), 0.0)],
}


POSTURES = tuple(_ANGLES)


@dataclass(frozen=True, slots=True)
class PostureStay:
    """One stay in a posture, or a walk where ``walks`` says so."""

    posture: BodyPosture
    duration_s: float
    walks: bool = False


@dataclass(frozen=True, slots=True, eq=False)
class PosedBody:
    """Samples by place, and the posture at each of their times; UNKNOWN while it changes."""

    samples: Mapping[str, ImuBatch]
    t_ns: Nanoseconds
    truth: Sequence[BodyPosture]


def posed_body(
    acts: Sequence[PostureStay],
    rng: np.random.Generator,
    mounts: Mapping[str, Rotation] | None = None,
    noise: float = 1.0,
) -> PosedBody:
    """``mounts``: from sensor axes to forward, right, down of the segment; left out: any one.
    ``noise``: times that of a common sensor.
    """
    count = round(sum(act.duration_s for act in acts) * RATE_HZ)
    t_s = np.arange(count) / RATE_HZ
    tips = {place: np.zeros(count) for place in _PLACES}
    rolls = np.zeros(count)
    bounces = np.zeros((count, 3))  # forward, right, down acceleration of the trunk, m/s^2
    truth: list[BodyPosture] = []
    begin = 0
    for act in acts:
        rows = slice(begin, begin + round(act.duration_s * RATE_HZ))
        begin = rows.stop
        ranges = _ANGLES[act.posture]
        *segments, roll_deg = ranges[int(rng.integers(len(ranges)))]
        for place, (least, most) in zip(_PLACES, segments, strict=True):
            tips[place][rows] = 0.0 if act.walks else rng.uniform(least, most)
        rolls[rows] = roll_deg + (0.0 if act.walks else rng.uniform(-12.0, 12.0))
        if act.walks or act.posture is BodyPosture.CRAWLING:
            _move(act, t_s, rows, tips, bounces)
        changing = round(2.0 * _CHANGES_S * RATE_HZ)
        length = rows.stop - rows.start
        truth += [BodyPosture.UNKNOWN] * min(changing, length)
        truth += [act.posture] * max(length - changing, 0)
    samples = {
        place: _sensed(
            t_s,
            _smoothed(tips[place]),
            _smoothed(rolls),
            bounces if place == "chest" else bounces * 0.3,
            (mounts or {}).get(place) or Rotation.random(random_state=rng),
            rng,
            noise,
        )
        for place in _PLACES
    }
    return PosedBody(samples, np.rint(t_s * NS_PER_S).astype(np.int64), truth)


def _move(
    act: PostureStay, t_s: Floats, rows: slice, tips: dict[str, Floats], bounces: Floats
) -> None:
    """Add the motion of a walk, or of hands and knees."""
    period_s = _STRIDE_S if act.walks else 1.6
    phase = (t_s[rows] / period_s) % 1.0
    swing = np.where(
        phase < _SWING_SHARE,
        -np.cos(np.pi * phase / _SWING_SHARE),
        np.cos(np.pi * (phase - _SWING_SHARE) / (1.0 - _SWING_SHARE)),
    )
    for place, swing_deg in (("thigh", 22.0), ("shank", 30.0 if act.walks else 6.0)):
        tips[place][rows] += swing_deg * swing
    step = 4.0 * np.pi * t_s[rows] / period_s
    up_mps2 = 2.2 if act.walks else 0.6
    bounces[rows, 2] += up_mps2 * np.sin(step)  # down
    bounces[rows, 0] -= 0.8 * up_mps2 * np.cos(step)  # in phase with the velocity downward
    bounces[rows, 1] += 0.5 * np.sin(step / 2.0)


def _smoothed(angle_deg: Floats) -> Floats:
    """A change of posture takes its time; a stride is too quick for it to matter."""
    width = round(0.3 * RATE_HZ)
    window = np.hanning(2 * width + 1)
    padded = np.pad(angle_deg, width, mode="edge")
    return np.convolve(padded, window / window.sum(), mode="valid")


def _sensed(
    t_s: Floats,
    tip_deg: Floats,
    roll_deg: Floats,
    acceleration_mps2: Floats,
    mount: Rotation,
    rng: np.random.Generator,
    noise: float,
) -> ImuBatch:
    attitude = Rotation.from_euler("YX", np.column_stack((tip_deg, roll_deg)), degrees=True)
    turned = (attitude[:-1].inv() * attitude[1:]).as_rotvec() * RATE_HZ
    gyro_radps = np.vstack((turned, turned[-1:]))
    force_mps2 = attitude.inv().apply(acceleration_mps2 - np.array([0.0, 0.0, GRAVITY_MPS2]))
    inverse = mount.inv()
    shape = (len(t_s), 3)
    return ImuBatch(
        np.rint(t_s * NS_PER_S).astype(np.int64),
        inverse.apply(force_mps2) + noise * rng.normal(0.0, 0.08, shape),
        inverse.apply(gyro_radps)
        + noise * (rng.normal(0.0, 0.01, shape) + rng.normal(0.0, 0.01, 3)),
    )
