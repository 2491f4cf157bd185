"""Quality of a path: the doubt that a long way has added up does not count against its present
steps.
"""

from __future__ import annotations

import pytest

from base_station.fusion import FUSERS
from base_station.fusion.interface import Start
from shared.messages import Header
from shared.messages.station import SetStart
from shared.quality import Quality, Reason, in_words
from tests.rig import message_factory
from tests.rig.station_script import Script

U = "FF-01"
FAR = Quality.LOST, Reason.UNCERTAIN  # as reported after twenty minutes of walking


@pytest.mark.parametrize(
    ("quality", "reasons", "path_quality"),
    [
        (Quality.GOOD, Reason.NONE, Quality.GOOD),
        (Quality.GOOD, Reason.BAD_SAMPLES, Quality.GOOD),
        (Quality.DEGRADED, Reason.UNCERTAIN, Quality.GOOD),
        (Quality.LOST, Reason.UNCERTAIN, Quality.GOOD),
        (Quality.LOST, Reason.NONE, Quality.LOST),
        (Quality.DEGRADED, Reason.SAMPLE_GAP, Quality.DEGRADED),
        (Quality.LOST, Reason.NO_STANCE, Quality.LOST),
        (Quality.LOST, Reason.UNCERTAIN | Reason.SAMPLE_GAP, Quality.DEGRADED),
        (Quality.LOST, Reason.UNCERTAIN | Reason.NO_STANCE, Quality.LOST),
        (Quality.LOST, Reason.UNCERTAIN | Reason.UNSETTLED, Quality.GOOD),
        (Quality.LOST, Reason.INCONSISTENT, Quality.LOST),
        (Quality.LOST, Reason.INCONSISTENT | Reason.UNCERTAIN, Quality.LOST),
        (Quality.DEGRADED, Reason.INCONSISTENT | Reason.ACCEL_SATURATED, Quality.DEGRADED),
        (Quality.DEGRADED, Reason.UNSETTLED | Reason.SAMPLE_GAP, Quality.DEGRADED),
    ],
)
def test_only_poor_steps_lower_the_quality_of_a_path(quality, reasons, path_quality):
    position = message_factory.position(Header(U, 1, 1, 0), quality=quality, reasons=reasons)
    assert position.path_quality is path_quality


def test_quality_after_a_long_walk_follows_the_deviation_of_the_fuser():
    def estimate(quality, reasons):
        fuser = FUSERS[0].new()
        fuser.start(Start(0.0, 0.0, 0.0, 0.0, 0.3, 0.05))
        for second in range(60):
            fuser.predict(
                message_factory.position(
                    Header(U, 1, second + 1, second * 1_000_000_000),
                    north_m=abs(second % 40.0 - 20.0),
                    distance_m=float(second),
                    std_north_m=20.0 + second,
                    std_east_m=20.0 + second,
                    quality=quality,
                    reasons=reasons,
                )
            )
        return fuser.estimate()

    assert estimate(*FAR) == estimate(Quality.GOOD, Reason.NONE)
    doubted = estimate(Quality.DEGRADED, Reason.BAD_SAMPLES)
    assert doubted.std_north_m > 3.0 * estimate(*FAR).std_north_m


def test_long_walk_raises_no_alarm():
    quality, far = FAR
    script = Script()
    script.register(U)
    script.act(SetStart(U, 0.0, 0.0, 0.0, 0.0, 0.5, 0.1))

    def walk(reasons):
        north_m = abs(script.now_s % 40.0 - 20.0)
        reported = {"quality": quality, "reasons": reasons, "distance_m": script.now_s}
        script.position(U, north_m, 0.0, **reported)

    script.wait(60, lambda: walk(far))
    assert script.alarms == []
    shown_before = script.fused[-1].quality
    script.wait(60, lambda: walk(far | Reason.NO_STANCE))
    assert (shown_before, script.fused[-1].quality) == (Quality.GOOD, Quality.LOST)
    (raised, *_) = [one for one in script.alarms if one.rule == "tracker-degraded"]
    assert raised.text.endswith("is lost (no footfall felt)")
    assert script.fused[-1].quality_reason == "the unit's tracker is lost: no footfall felt"


def test_lost_height_is_an_alarm_and_stands_with_the_position():
    words = "footfalls contradict the motion between them: height not known"
    script = Script()
    script.register(U)
    script.act(SetStart(U, 0.0, 0.0, 0.0, 0.0, 0.5, 0.1))
    lost = {"quality": Quality.LOST, "reasons": Reason.INCONSISTENT}
    script.wait(30, lambda: script.position(U, 0.1 * script.now_s, 0.0, **lost))
    assert script.fused[-1].quality is Quality.LOST
    assert script.fused[-1].quality_reason == f"the unit's tracker is lost: {words}"
    (raised, *_) = [one for one in script.alarms if one.rule == "tracker-degraded"]
    assert raised.text.endswith(f"is lost ({words})")


@pytest.mark.parametrize(
    ("quality", "reasons", "words"),
    [
        (Quality.GOOD, Reason.UNSETTLED, "heading not settled: stand still for five seconds"),
        (
            Quality.DEGRADED,
            Reason.SAMPLE_GAP | Reason.UNSETTLED,
            "the unit's tracker is unsure: samples missing",
        ),
        (Quality.DEGRADED, Reason.NONE, "the unit's tracker is unsure"),
    ],
)
def test_quality_reason_names_cause_and_remedy(quality, reasons, words):
    fuser = FUSERS[0].new()
    fuser.start(Start(0.0, 0.0, 0.0, 0.0, 0.3, 0.05))
    fuser.predict(message_factory.position(Header(U, 1, 1, 0), quality=quality, reasons=reasons))
    estimate = fuser.estimate()
    assert estimate is not None
    assert (estimate.quality, estimate.quality_reason) == (Quality.DEGRADED, words)


def test_every_reason_has_a_text():
    for reason in Reason:
        if reason:
            assert len(in_words(reason)) > 5
