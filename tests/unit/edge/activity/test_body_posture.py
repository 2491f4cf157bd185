"""Posture from the inclinations of trunk, thigh and shank, on simulated bodies."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from edge.activity.body_posture import BodyPostureEstimator
from edge.samples import ImuBatch
from shared.clock import NS_PER_S
from shared.messages import BodyPosture, Mobility
from tests.rig.body_postures import POSTURES, PosedBody, PostureStay, posed_body
from tests.rig.posture_confusion import confusion, random_body, share

ALL = ("chest", "thigh", "shank")
UPRIGHT = {BodyPosture.STANDING, BodyPosture.SITTING, BodyPosture.KNEELING}
# Flipped: forward, right, down of the simulated body to forward, right, up.
UP = np.diag([1.0, 1.0, -1.0])


@pytest.fixture(scope="module")
def bodies() -> Sequence[PosedBody]:
    return [random_body(seed) for seed in range(100, 106)]


def pushed(body: PosedBody, places: Sequence[str] = ALL) -> BodyPostureEstimator:
    estimator = BodyPostureEstimator()
    push(estimator, body, places)
    return estimator


def push(
    estimator: BodyPostureEstimator, body: PosedBody, places: Sequence[str] = ALL, rows: int = 10
) -> None:
    for first in range(0, len(body.t_ns), rows):
        for place in places:
            estimator.push(place, body.samples[place].part(slice(first, first + rows)))


def test_three_sensors_distinguish_each_posture(bodies: Sequence[PosedBody]) -> None:
    table, reports = confusion(ALL, bodies)
    for posture in POSTURES:
        assert share(table, posture, posture) > 0.85, posture
    assert np.mean([right for _, right in reports]) > 0.95


def test_trunk_alone_gives_the_lying_side_and_not_the_upright_posture(
    bodies: Sequence[PosedBody],
) -> None:
    table, _ = confusion(("chest",), bodies)
    for posture in UPRIGHT:
        assert share(table, posture, BodyPosture.UPRIGHT) > 0.9, posture
    for posture in set(POSTURES) - UPRIGHT - {BodyPosture.BENT}:
        assert share(table, posture, posture) > 0.9, posture
    bent = share(table, BodyPosture.BENT, BodyPosture.BENT)
    assert bent > 0.5, "between upright and prone it is a matter of degrees"


def test_leg_alone_gives_kneeling_crawling_and_lying(bodies: Sequence[PosedBody]) -> None:
    table, _ = confusion(("thigh", "shank"), bodies)
    for posture in (
        BodyPosture.KNEELING,
        BodyPosture.CRAWLING,
        BodyPosture.PRONE,
        BodyPosture.LEFT_SIDE,
        BodyPosture.RIGHT_SIDE,
    ):
        assert share(table, posture, posture) > 0.85, posture


def test_noise_of_poor_sensors_changes_little() -> None:
    bodies = [random_body(seed, noise=4.0) for seed in range(200, 203)]
    _, reports = confusion(ALL, bodies)
    assert np.mean([right for _, right in reports]) > 0.95


def test_confident_posture_is_correct(bodies: Sequence[PosedBody]) -> None:
    for places in (("chest",), ("chest", "thigh"), ALL):
        _, reports = confusion(places, bodies)
        sure = [right for confidence, right in reports if confidence > 0.9]
        assert len(sure) > 0.5 * len(reports)
        assert np.mean(sure) > 0.9


def test_no_posture_is_stated_before_the_first_walk() -> None:
    body = posed_body([PostureStay(BodyPosture.SUPINE, 20.0)], np.random.default_rng(1))
    estimator = pushed(body)
    assert estimator.posture(int(body.t_ns[-1])) == (BodyPosture.UNKNOWN, 0.0)


def test_given_mounting_gives_a_posture_before_the_first_walk() -> None:
    rng = np.random.default_rng(2)
    turned = Rotation.random(random_state=rng)
    body = posed_body([PostureStay(BodyPosture.SUPINE, 20.0)], rng, mounts={"chest": turned})
    estimator = BodyPostureEstimator({"chest": UP @ turned.as_matrix()})
    push(estimator, body, ("chest",))
    posture, confidence = estimator.posture(int(body.t_ns[-1]))
    assert posture is BodyPosture.SUPINE
    assert confidence > 0.8


def test_wrong_mounting_is_corrected_by_walking() -> None:
    rng = np.random.default_rng(3)
    turned = Rotation.random(random_state=rng)
    walk = [
        PostureStay(BodyPosture.STANDING, 30.0, walks=True),
        PostureStay(BodyPosture.LEFT_SIDE, 15.0),
    ]
    body = posed_body(walk, rng, mounts={"chest": turned})
    wrong = Rotation.from_euler("Y", 90.0, degrees=True).as_matrix() @ UP @ turned.as_matrix()
    estimator = BodyPostureEstimator({"chest": wrong})
    push(estimator, body, ("chest",))
    assert estimator.posture(int(body.t_ns[-1]))[0] is BodyPosture.LEFT_SIDE


def test_change_is_reported_within_three_seconds() -> None:
    acts = [
        PostureStay(BodyPosture.STANDING, 15.0, walks=True),
        PostureStay(BodyPosture.STANDING, 10.0),
        PostureStay(BodyPosture.SUPINE, 3.5),
    ]
    body = posed_body(acts, np.random.default_rng(4))
    assert pushed(body).posture(int(body.t_ns[-1]))[0] is BodyPosture.SUPINE


def test_silent_sensor_is_left_out_and_no_sensor_gives_no_posture() -> None:
    acts = [
        PostureStay(BodyPosture.STANDING, 15.0, walks=True),
        PostureStay(BodyPosture.SITTING, 20.0),
    ]
    body = posed_body(acts, np.random.default_rng(5))
    estimator = BodyPostureEstimator()
    half = len(body.t_ns) // 2 + 500
    push(estimator, _part(body, 0, half))
    assert estimator.posture(int(body.t_ns[half - 1]))[0] is BodyPosture.SITTING
    push(estimator, _part(body, half, len(body.t_ns)), ("chest",))
    end_ns = int(body.t_ns[-1])
    assert estimator.posture(end_ns)[0] in (BodyPosture.SITTING, BodyPosture.UPRIGHT)
    assert estimator.posture(end_ns + 3 * NS_PER_S) == (BodyPosture.UNKNOWN, 0.0)
    assert estimator.mobility(end_ns + 3 * NS_PER_S) is Mobility.UNKNOWN


def test_any_batching_gives_the_same() -> None:
    body = random_body(300)
    one, other = BodyPostureEstimator(), BodyPostureEstimator()
    push(one, body, ("chest",), rows=1)
    push(other, body, ("chest",), rows=37)
    end_ns = int(body.t_ns[-1])
    assert one.posture(end_ns)[0] is other.posture(end_ns)[0]
    assert one.posture(end_ns)[1] == pytest.approx(other.posture(end_ns)[1])


def test_foot_and_missing_samples_give_no_posture() -> None:
    body = posed_body(
        [PostureStay(BodyPosture.STANDING, 12.0, walks=True)], np.random.default_rng(6)
    )
    estimator = BodyPostureEstimator()
    estimator.push("foot", body.samples["shank"])
    missed = ImuBatch(
        body.t_ns, np.full((len(body.t_ns), 3), np.nan), np.zeros((len(body.t_ns), 3))
    )
    estimator.push("chest", missed)
    assert estimator.posture(int(body.t_ns[-1])) == (BodyPosture.UNKNOWN, 0.0)
    assert estimator.mobility(int(body.t_ns[-1])) is Mobility.UNKNOWN


def test_trunk_distinguishes_walk_turn_and_rest() -> None:
    acts = [
        PostureStay(BodyPosture.STANDING, 20.0, walks=True),
        PostureStay(BodyPosture.STANDING, 8.0),
    ]
    body = posed_body(acts, np.random.default_rng(7))
    estimator = BodyPostureEstimator()
    push(estimator, _part(body, 0, 1950), ("chest",))
    assert estimator.mobility(int(body.t_ns[1949])) is Mobility.FORWARD
    push(estimator, _part(body, 1950, 2790), ("chest",))
    assert estimator.mobility(int(body.t_ns[2789])) is Mobility.STILL
    chest = body.samples["chest"]
    up_b = chest.accel_mps2[2500:2700].mean(axis=0)
    turning = np.outer(np.ones(200), 0.8 * up_b / np.linalg.norm(up_b))
    later_ns = body.t_ns[2500:2700] + 3 * NS_PER_S
    estimator.push("chest", ImuBatch(later_ns, chest.accel_mps2[2500:2700], turning))
    assert estimator.mobility(int(later_ns[-1])) is Mobility.TURNING


def _part(body: PosedBody, first: int, last: int) -> PosedBody:
    rows = slice(first, last)
    samples = {place: batch.part(rows) for place, batch in body.samples.items()}
    return PosedBody(samples, body.t_ns[rows], body.truth[rows])
