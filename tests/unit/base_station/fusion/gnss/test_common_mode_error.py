"""The common error of all receivers of a site is removed from every unit's fixes."""

from __future__ import annotations

import math

import numpy as np
import pytest

from base_station.core.pins.evidence import evidence_of_site, reference_receiver
from base_station.core.state import OWN_SITE_ID
from base_station.fusion.gnss.common_mode_error import (
    COMMON_MOST_M,
    OWN_PART,
    CommonModeError,
    common_m2,
)
from base_station.fusion.gnss.receiver_model import ReceiverModel
from base_station.fusion.interface import PlaceFix
from base_station.fusion.parameters import Parameters
from shared.clock import NS_PER_S
from shared.messages.pins import SetPin
from shared.messages.station import OpenIncident, SetAnchor, SetReference, SetStart
from tests.rig.station_script import Script

STD_M = 1.27
COMMON_M = math.sqrt(common_m2(STD_M))
OWN_M = math.sqrt(STD_M**2 - COMMON_M**2)


def after(seconds: float, off_m: tuple[float, float] = (3.0, -2.0)) -> CommonModeError:
    common_mode_error = CommonModeError()
    for second in range(int(seconds)):
        common_mode_error.update(second * NS_PER_S, off_m, STD_M, 0.3)
    return common_mode_error


def fix_at(north_m: float, east_m: float, std_m: float = STD_M) -> PlaceFix:
    return PlaceFix(0, north_m, east_m, 0.0, std_m, None)


def test_error_of_the_stations_receiver_is_mostly_common() -> None:
    fix = after(600.0).correct(fix_at(13.0, 8.0), 600 * NS_PER_S)
    assert 10.0 < fix.north_m < 11.6
    assert 9.0 < fix.east_m < 10.0
    assert 0.74 * STD_M < fix.horizontal_std_m < 0.95 * STD_M


def test_frozen_receiver_is_detected_beside_one_at_the_station() -> None:
    """The correction of its fixes changes; their position does not."""
    common_mode_error, trust, verdicts = CommonModeError(), ReceiverModel(), []
    for second in range(20):
        common_mode_error.update(second * NS_PER_S, (3.0 + 0.01 * second, -2.0), STD_M, 0.3)
        fix = common_mode_error.correct(fix_at(13.0, 8.0), second * NS_PER_S)
        verdicts.append(trust.is_stuck(Parameters(), fix, 1.0 * second))
    assert verdicts == [False] * 9 + [True] * 11


def test_common_error_is_part_of_a_good_receivers_error_and_little_of_a_bad_ones() -> None:
    assert common_m2(STD_M) < 0.5 * STD_M**2
    assert common_m2(20.0) == common_m2(50.0) == COMMON_MOST_M**2


@pytest.mark.slow
def test_common_mode_correction_has_its_stated_variance() -> None:
    """Against drawn errors: a fix is nearer, and as near as its variance."""
    rng, left2, stated2 = np.random.default_rng(2), [], []
    common2, common_stated2 = [], []
    for _ in range(200):
        common = rng.normal(0.0, COMMON_M, 2)
        own = rng.normal(0.0, math.sqrt(OWN_PART) * OWN_M, 2)
        place = rng.normal(0.0, 0.3, 2)
        common_mode_error = CommonModeError()
        for second in range(60):
            white = rng.normal(0.0, math.sqrt(1.0 - OWN_PART) * OWN_M, 2)
            north_m, east_m = (common + own + place + white).tolist()
            common_mode_error.update(second * NS_PER_S, (north_m, east_m), STD_M, 0.3)
        error = common + rng.normal(0.0, OWN_M, 2)
        fix = common_mode_error.correct(fix_at(float(error[0]), float(error[1])), 60 * NS_PER_S)
        left2 += [fix.north_m**2, fix.east_m**2]
        stated2.append(fix.horizontal_std_m**2)
        taken_m = error - [fix.north_m, fix.east_m]
        common2 += ((common - taken_m) ** 2).tolist()
        assert fix.common_m2 is not None
        common_stated2.append(fix.common_m2)
    assert np.mean(left2) == pytest.approx(np.mean(stated2), rel=0.15)
    assert np.mean(common2) == pytest.approx(np.mean(common_stated2), rel=0.15)
    assert np.mean(stated2) < 0.85 * STD_M**2


@pytest.mark.parametrize("t_s", [30, 59], ids=["out of a journal", "again"])
def test_earlier_evidence_is_not_counted_twice(t_s: int) -> None:
    common_mode_error = after(60.0)
    common_mode_error.update(t_s * NS_PER_S, (4.0, -1.0), STD_M, 0.3)
    assert (common_mode_error.mean_m, common_mode_error.covariance_m2) == (
        after(60.0).mean_m,
        after(60.0).covariance_m2,
    )


def test_fix_with_a_larger_deviation_weighs_less() -> None:
    moved_m = []
    for std_m in (STD_M, 2.0 * STD_M):
        common_mode_error = after(60.0)
        before_m = sum(row[0] for row in common_mode_error.mean_m)
        common_mode_error.update(60 * NS_PER_S, (4.0, -2.0), std_m, 0.3)
        moved_m.append(sum(row[0] for row in common_mode_error.mean_m) - before_m)
    assert moved_m[0] > 1.5 * moved_m[1] > 0.0


def test_unknown_receiver_changes_nothing() -> None:
    assert CommonModeError().correct(fix_at(1.0, 2.0), 0) == fix_at(1.0, 2.0)
    assert after(100.0).correct(fix_at(1.0, 2.0), 200 * NS_PER_S) == fix_at(1.0, 2.0)


def test_receiver_just_switched_on_weighs_the_same_once_it_is_warm() -> None:
    """It claims twenty metres at first; that is not its lasting error."""
    warm, cold = after(1200.0), CommonModeError()
    for second in range(1200):
        std_m = 20.0 if second < 5 else STD_M
        cold.update(second * NS_PER_S, (3.0, -2.0), std_m, 0.3)
    fixes = [
        common_mode_error.correct(fix_at(13.0, 8.0), 1200 * NS_PER_S)
        for common_mode_error in (warm, cold)
    ]
    assert fixes[1].north_m == pytest.approx(fixes[0].north_m, abs=0.2)
    assert fixes[1].horizontal_std_m == pytest.approx(fixes[0].horizontal_std_m, abs=0.05)


def test_accuracy_of_a_rejected_fix_makes_the_receiver_no_better() -> None:
    common_mode_error = CommonModeError()
    for second in range(300):
        common_mode_error.update(second * NS_PER_S, (3.0, -2.0), 5.0, 0.3)
    before = common_mode_error.std_m
    common_mode_error.update(300 * NS_PER_S, (90.0, 90.0), STD_M, 0.3)
    assert common_mode_error.std_m == before == 5.0


def test_correction_worse_than_the_receiver_makes_no_fix_worse() -> None:
    common_mode_error = CommonModeError()
    common_mode_error.update(0, (3.0, -2.0), 20.0, 0.3)
    assert common_mode_error.correct(fix_at(13.0, 8.0), 0) == fix_at(13.0, 8.0)


def test_one_outlying_fix_moves_no_member() -> None:
    common_mode_error = after(300.0)
    before = common_mode_error.correct(fix_at(0.0, 0.0), 301 * NS_PER_S)
    common_mode_error.update(301 * NS_PER_S, (60.0, 60.0), STD_M, 0.3)
    wild = common_mode_error.correct(fix_at(0.0, 0.0), 301 * NS_PER_S)
    assert (wild.north_m, wild.east_m) == pytest.approx((before.north_m, before.east_m), abs=0.01)


def test_bad_fix_never_becomes_a_good_one() -> None:
    fix = after(600.0).correct(fix_at(0.0, 0.0, 20.0), 600 * NS_PER_S)
    assert fix.horizontal_std_m > 19.0


def a_site(*, station_has_a_receiver: bool, walked_m: float = 0.0) -> Script:
    """FF-01 stands at the anchor and FF-09 50 m north of it; the error of all receivers is 3 m
    north and as much west.
    """
    script = Script()
    script.register("FF-01", "FF-09")
    script.act(SetAnchor(53.5, 10.0, 0.0, 0.0))
    if station_has_a_receiver:
        script.act(SetReference("FF-09", 0.0))
        script.act(SetStart("FF-09", 50.0, 0.0, 0.0, 0.0, 0.3, math.pi))
    for _ in range(120):
        script.now_s += 1.0
        for unit_id, north_m in (("FF-09", 50.0), ("FF-01", 0.0)):
            script.position(unit_id, 0.0, 0.0, distance_m=walked_m)
            script.gps(unit_id, 53.5 + (3.0 + north_m) / 111_275.0, 10.0 - 3.0 / 66_350.0)
    return script


def north_m(script: Script) -> float:
    return place_m(script)[0]


def place_m(script: Script) -> tuple[float, float]:
    fused = script.pipeline.state.units["FF-01"].place.fused
    assert fused is not None
    return fused.north_m, fused.east_m


@pytest.mark.slow
def test_error_of_the_reference_at_the_station_is_removed_from_other_units_fixes() -> None:
    alone, helped = (a_site(station_has_a_receiver=one) for one in (False, True))
    assert place_m(alone) == pytest.approx((3.0, -3.0), abs=0.1)
    assert 0.5 < north_m(helped) < 2.2
    assert -2.2 < place_m(helped)[1] < -0.5


def test_reference_that_moves_changes_nothing() -> None:
    alone = a_site(station_has_a_receiver=False, walked_m=50.0)
    helped = a_site(station_has_a_receiver=True, walked_m=50.0)
    assert north_m(helped) == pytest.approx(north_m(alone), abs=0.01)


@pytest.mark.parametrize(
    "action",
    [
        SetAnchor(53.5, 10.0001, 0.0, 0.0),
        SetStart("FF-09", 60.0, 0.0, 0.0, 0.0, 0.3, math.pi),
    ],
)
def test_reference_with_a_corrected_start_drops_its_evidence(
    action: SetAnchor | SetStart,
) -> None:
    site = a_site(station_has_a_receiver=True)
    assert site.pipeline.state.site.common_mode_error != CommonModeError()
    site.act(action)
    assert site.pipeline.state.site.common_mode_error == CommonModeError()


def test_start_of_the_reference_holds_for_every_run() -> None:
    """It is switched off and on between incidents, and stays at its place."""
    site = a_site(station_has_a_receiver=True)
    site.act(SetStart("FF-01", 0.0, 0.0, 0.0, 0.0, 0.3, math.pi))
    site.boot_ids = {"FF-01": 8, "FF-09": 8}
    for unit_id in site.boot_ids:
        site.position(unit_id, 0.0, 0.0)
    site.now_s += 60.0
    site.act(OpenIncident("i1", "Mill Lane"))
    for unit_id in site.boot_ids:
        site.position(unit_id, 0.0, 0.0)
    state = site.pipeline.state
    starts = {
        unit_id: one.start for unit_id, one in evidence_of_site(state, OWN_SITE_ID, None).items()
    }
    assert starts["FF-01"] is None
    assert starts["FF-09"] is not None
    assert reference_receiver(state, state.site)["FF-09"].start == starts["FF-09"]


@pytest.mark.slow
def test_solving_again_uses_the_reference_and_each_fix_once() -> None:
    alone, helped = (a_site(station_has_a_receiver=one) for one in (False, True))
    for script in (alone, helped):
        fixes = script.pipeline.state.paths["FF-01"].arrays().fix_m
        assert fixes[:, 0] == pytest.approx(3.0, abs=0.1)  # as received
        script.act(SetPin("p", "FF-01", 0, 0.0, 0.0, 3.0, None, None, 0.35, ""))
    assert 0.0 < north_m(helped) < north_m(alone) - 0.2
    assert set(helped.pipeline.state.site.pin_verdicts) == {"p"}
