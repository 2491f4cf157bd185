"""Figures in the terms of ISO/IEC 18305, and the trust light."""

from __future__ import annotations

import numpy as np
import pytest

from base_station.core.state import StationState, UnitState
from base_station.core.state.pin import Pin, PinKind, PinVerdict
from base_station.core.state.unit_place import UnitPlace
from base_station.core.trust.trust import conflicts_of, trust_of
from base_station.replay.assessment.figures import (
    errors_against,
    figures_of,
    floor_probability,
    stated_figures,
    stated_m,
)
from base_station.storage.db.records import TrackSample
from shared.messages import FusedPosition, Header
from shared.quality import Quality
from tests.rig import message_factory


def sample(
    t_s: float, north_m: float = 0.0, std_m: float = 1.0, down_m: float = 0.0
) -> TrackSample:
    return TrackSample(round(t_s * 1e9), north_m, 0.0, down_m, std_m, std_m, std_m, 0.0, 0, "good")


def test_figures_of_a_normal_distribution_are_its_own() -> None:
    """CE50 is 1.177 and CE95 2.448 standard deviations, VE50 0.674, SE50 1.538."""
    figures = stated_figures(stated_m([sample(float(second), std_m=2.0) for second in range(200)]))
    assert figures is not None
    assert figures.ce50_m == pytest.approx(2.0 * 1.177, rel=0.15)
    assert figures.ce95_m == pytest.approx(2.0 * 2.448, rel=0.15)
    assert figures.ve50_m == pytest.approx(2.0 * 0.674, rel=0.25)
    assert figures.se50_m == pytest.approx(2.0 * 1.538, rel=0.15)
    many = figures_of(np.random.default_rng(1).standard_normal((200_000, 3)))
    assert many is not None
    assert many.ce95_m == pytest.approx(2.448, rel=0.01)
    assert many.ve95_m == pytest.approx(1.960, rel=0.01)


def test_long_trail_is_assessed_from_beginning_to_end() -> None:
    sure = [sample(float(second), std_m=1.0) for second in range(600)]
    unsure = [sample(float(second), std_m=10.0) for second in range(600, 1200)]
    for trail in (sure + unsure, unsure + sure):
        figures = stated_figures(stated_m(trail))
        assert figures is not None
        assert figures.ce95_m == pytest.approx(21.5, rel=0.1)  # 90 % of the worse half


def test_empty_trail_has_no_figures() -> None:
    assert stated_figures(stated_m([])) is None
    assert figures_of(np.zeros((0, 3))) is None
    assert floor_probability([], 3.0) is None
    assert len(errors_against([sample(1.0)], [])) == 0


def test_errors_are_taken_within_the_other_trail_by_interpolation() -> None:
    truth = [sample(0.0, 0.0), sample(10.0, 10.0)]
    live = [sample(5.0, 6.0), sample(20.0, 99.0)]
    errors = errors_against(live, truth)
    assert errors.shape == (1, 3)
    assert errors[0].tolist() == pytest.approx([1.0, 0.0, 0.0])


def test_probability_of_the_floor_follows_the_height_and_the_storey() -> None:
    assert floor_probability([sample(0.0, std_m=0.5)], 3.0) == pytest.approx(0.9973, abs=1e-3)
    assert floor_probability([sample(0.0, std_m=3.0)], 3.0) == pytest.approx(0.383, abs=1e-2)


def fused(**changes: object) -> FusedPosition:
    usual = {"std_north_m": 1.0, "std_east_m": 1.0, "std_down_m": 0.3, "floor": 0}
    header = Header("station", 1, 1, 0)
    return message_factory.fused(header, "FF-01", **{**usual, "since_gps_s": 1.0, **changes})


def known(**changes: object) -> UnitState:
    return UnitState("FF-01", registered=True, link="live", place=UnitPlace(fused(**changes)))


@pytest.mark.parametrize(
    ("changes", "level", "words"),
    [
        ({}, "green", ""),
        ({"std_north_m": 3.0}, "amber", "only known to 7 m"),
        ({"std_north_m": 30.0}, "red", "only known to 73 m"),
        ({"std_down_m": 4.0}, "amber", "height"),
        ({"quality": Quality.LOST, "quality_reason": "tracker is lost"}, "red", "tracker is lost"),
        ({"quality": Quality.DEGRADED, "quality_reason": "heading"}, "amber", "heading"),
    ],
)
def test_light_has_its_reason(changes: dict[str, object], level: str, words: str) -> None:
    trust = trust_of(known(**changes), 0)
    assert trust.level == level
    assert words in trust.reason
    assert (trust.reason == "") == (level == "green")


@pytest.mark.parametrize(
    ("below", "above", "level", "words"),
    [
        ({"std_north_m": 2.0}, {"std_north_m": 2.1}, "amber", "only known to 5 m"),
        ({"std_east_m": 8.1}, {"std_east_m": 8.3}, "red", "only known to 20 m"),
        ({"std_down_m": 1.5}, {"std_down_m": 1.6}, "amber", "height only known to 3 m"),
        ({"floor_probability": 0.7}, {"floor_probability": 0.69}, "amber", "uncertain (69%)"),
        (
            {"std_north_m": 1.9, "std_east_m": 1.9},
            {"std_north_m": 1.9, "std_east_m": 1.9, "correlation_ne": -0.9},
            "amber",
            "only known to 6 m",
        ),
    ],
)
def test_thresholds_of_the_light(
    below: dict[str, float], above: dict[str, float], level: str, words: str
) -> None:
    assert trust_of(known(**below), 0).level != level
    trust = trust_of(known(**above), 0)
    assert trust.level == level
    assert words in trust.reason


def test_reasons_that_differ_by_a_figure_alone_are_one_cause() -> None:
    for reason in ("within 113 m", "within 40 m"):
        trust = trust_of(known(quality=Quality.LOST, quality_reason=reason), 0)
        assert (trust.reason, trust.cause) == (reason, "place only roughly known")
    unsure = "the unit's tracker is unsure"
    trust = trust_of(
        known(quality=Quality.DEGRADED, quality_reason=f"{unsure}: samples missing"), 0
    )
    assert (trust.reason, trust.cause) == (f"{unsure}: samples missing", unsure)


def test_no_contact_no_position_and_no_registration_are_red() -> None:
    lost = known()
    lost.link = "lost"
    stranger = known()
    stranger.registered = False
    for unit in (lost, stranger, UnitState("FF-01", registered=True)):
        assert trust_of(unit, 0).level == "red"


def test_pin_that_contradicts_the_trail_is_amber() -> None:
    state = StationState()
    state.site.pins["p"] = Pin("p", "place", "FF-01", 1, 1.0, 1, "chief")
    state.site.pin_verdicts["p"] = PinVerdict("conflict", 30.0, 9.0, "30 m off")
    trust = trust_of(known(), conflicts_of(state)["FF-01"])
    assert (trust.level, trust.reason) == ("amber", "a pin contradicts the trail")
    state.site.pin_verdicts["p"] = PinVerdict("used", 0.1, 0.1)
    assert trust_of(known(), conflicts_of(state)["FF-01"]).level == "green"
    state.site.pin_verdicts["removed"] = PinVerdict("conflict", 30.0, 9.0, "30 m off")
    assert trust_of(known(), conflicts_of(state)["FF-01"]).level == "green"


@pytest.mark.parametrize(("kind", "both"), [("meeting", True), ("beacon", False)])
def test_pin_contradicts_the_trails_of_its_subjects(kind: PinKind, both: bool) -> None:
    """And not that of a unit that has the name of a beacon."""
    state = StationState()
    state.site.pins["p"] = Pin("p", kind, "FF-01", 1, 1.0, 1, "FF-01", other_id="FF-02")
    state.site.pin_verdicts["p"] = PinVerdict("conflict", 30.0, 9.0, "30 m off")
    conflicts = conflicts_of(state)
    assert (conflicts["FF-01"], conflicts["FF-02"]) == (1, int(both))
