"""``muster bench constants``: it varies all constants, and finds those without effect."""

from __future__ import annotations

from dataclasses import replace

import pytest

from edge.tracker.foot.config import EskfConfig, config_record
from tests.bench.tracker.constant_walks import SIMULATED, Walk
from tests.bench.tracker.constants import (
    FACTORS,
    changed,
    constants,
    constants_table,
    measure_constants,
    never_lines,
)
from tests.rig.inertial_walk import inertial_walk

OF_STANCE = "zupt.stance_velocity_per_motion"
OF_A_BAROMETER = "air.noise_m"


@pytest.fixture(scope="module")
def walk():
    """Ten seconds without a barometer."""
    walked = inertial_walk("straight", lasts_s=10.0)
    description = replace(walked.description, mag_present=False, barometer_present=False)
    return Walk(SIMULATED, "straight", description, walked.sensed(), None)


def values(config):
    """Return all numbers of a configuration, those of its parts too."""
    record = config_record(config)[0].item()
    return [one for part in record for one in (part if isinstance(part, tuple) else (part,))]


def test_every_constant_is_varied_and_nothing_else():
    default = values(EskfConfig())
    assert len(constants()) == len(default)
    for name in constants():
        for factor in FACTORS:
            differing = [
                pair
                for pair in zip(values(changed(name, factor)), default, strict=True)
                if pair[0] != pair[1]
            ]
            assert len(differing) == 1, name


def test_shares_near_one_stay_below_it():
    assert changed("output.saturation_ratio", 2.0).output.saturation_ratio == pytest.approx(0.97)
    assert changed("consistency.memory", 0.5).consistency.memory == pytest.approx(0.85)


def test_constant_of_an_absent_sensor_has_no_effect_and_one_of_stances_has(walk):
    found = measure_constants([walk], [OF_STANCE, OF_A_BAROMETER])
    assert [one.constant for one in found] == [OF_A_BAROMETER, OF_STANCE]
    idle, deciding = found
    assert not idle.decides
    assert idle.rows == 0.0
    assert deciding.walks == {SIMULATED: 1}
    assert deciding.rows > 0.0
    assert deciding.error_ratio != 1.0
    lines = list(never_lines(found))
    assert OF_A_BAROMETER in lines[0]
    assert OF_STANCE not in lines[0]
    assert constants_table(found).row_count == len(found)
