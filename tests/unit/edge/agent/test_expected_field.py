"""Expected field of the Earth for the tracker: from settings, fixes and the date."""

from __future__ import annotations

from datetime import UTC, datetime
from math import degrees, nan
from pathlib import Path

import numpy as np
import pytest

from edge.agent.expected_field import ExpectedField
from edge.agent.fitted_sensor import FittedSensor
from edge.agent.pipeline import TrackerPipeline, UnitIdentity
from edge.config import EdgeConfig
from edge.samples import ApproximatePosition, GpsSample, ImuBatch, SensorBatch, SensorDescription
from edge.tracker.choice.one_sensor import OneSensorTracker
from edge.tracker.registry import NoTracker
from shared.clock import NS_PER_S, ManualClock
from shared.config import load_config
from shared.earth_field import EarthField
from shared.errors import ConfigError
from shared.header_factory import HeaderFactory

REYKJAVIK = ApproximatePosition(64.15, -21.94)
SYDNEY = ApproximatePosition(-33.87, 151.21)
NOW_NS = round(datetime(2026, 7, 4, tzinfo=UTC).timestamp()) * NS_PER_S


def utc_ns_of(t_ns: int) -> int:
    return NOW_NS + t_ns


def samples(start_s: float = 0.0, others: tuple[GpsSample, ...] = ()) -> SensorBatch:
    t_ns = round(start_s * NS_PER_S) + np.arange(10) * 10_000_000
    return SensorBatch(ImuBatch(t_ns, np.ones((10, 3)), np.zeros((10, 3))), others)


def fix(
    place: ApproximatePosition, t_s: float = 0.05, *, fix_type: int = 3, std_m: float = 3.0
) -> GpsSample:
    t_ns = round(t_s * NS_PER_S)
    return GpsSample(t_ns, place.lat_deg, place.lon_deg, 40.0, std_m, 5.0, fix_type, 8, 0.0, 0.0)


def declination_deg(learned: tuple[EarthField, int] | None) -> float:
    assert learned is not None
    return degrees(learned[0].declination_rad)


def test_settings_give_the_field_from_the_first_sample_on_and_once():
    where = ExpectedField(REYKJAVIK)
    learned = where.take(samples(7.0), utc_ns_of)
    assert declination_deg(learned) == pytest.approx(-11.13, abs=0.02)
    assert learned is not None
    assert learned[1] == 7 * NS_PER_S
    assert where.take(samples(8.0), utc_ns_of) is None


def test_fix_replaces_the_settings_for_good():
    where = ExpectedField(REYKJAVIK)
    where.take(samples(), utc_ns_of)
    learned = where.take(samples(1.0, (fix(SYDNEY, 1.05),)), utc_ns_of)
    assert declination_deg(learned) == pytest.approx(12.82, abs=0.02)
    assert learned is not None
    assert learned[1] == fix(SYDNEY, 1.05).t_ns
    assert where.take(samples(2.0, (fix(REYKJAVIK, 2.05),)), utc_ns_of) is None


@pytest.mark.parametrize(
    "useless", [fix(ApproximatePosition(nan, 0.0)), fix(SYDNEY, fix_type=0), fix(SYDNEY, std_m=1e4)]
)
def test_useless_fix_gives_no_field(useless: GpsSample):
    assert ExpectedField(None).take(samples(0.0, (useless,)), utc_ns_of) is None


def test_no_field_without_settings_and_fixes():
    assert ExpectedField(None).take(samples(), utc_ns_of) is None


def test_field_waits_until_the_clock_is_set():
    where = ExpectedField(REYKJAVIK)
    assert where.take(samples(0.0, (fix(SYDNEY),)), lambda t_ns: t_ns) is None
    assert declination_deg(where.take(samples(1.0), utc_ns_of)) == pytest.approx(-11.13, abs=0.02)


def test_replay_seconds_later_finds_the_same_field():
    live = ExpectedField(None).take(samples(0.0, (fix(SYDNEY),)), utc_ns_of)
    again = ExpectedField(None).take(
        samples(0.0, (fix(SYDNEY),)), lambda t: utc_ns_of(t) + NS_PER_S
    )
    assert live == again


def test_pipeline_gives_the_field_to_the_tracker_before_the_samples():
    reported: list[str] = []

    class Listening(NoTracker):
        def push(self, batch: ImuBatch):
            reported.append("samples")
            return super().push(batch)

        def set_earth_field(self, field: EarthField, t_ns: int) -> None:
            reported.append(f"{degrees(field.declination_rad):.0f} from {t_ns / NS_PER_S}")

    identity = UnitIdentity(
        "1", "test", "t", (FittedSensor(SensorDescription("s", 100.0)),), place=REYKJAVIK
    )
    header_factory = HeaderFactory("u1", 7, ManualClock(NOW_NS))
    pipeline = TrackerPipeline(identity, OneSensorTracker(Listening()), header_factory, 5.0)
    pipeline.step(samples(3.0))
    pipeline.step(samples(3.1, (fix(SYDNEY, 3.15),)))
    assert reported == ["-11 from 3.0", "samples", "13 from 3.15", "samples"]


def settings(folder: Path, place: str) -> EdgeConfig:
    file = folder / "unit.toml"
    file.write_text(f'source = "simulated:square-60m"\n{place}\n')
    return load_config(file, EdgeConfig)


def test_place_is_a_setting_of_the_agent(tmp_path: Path):
    assert settings(tmp_path, "").place is None
    assert settings(tmp_path, "[place]\nlat_deg = 64.15\nlon_deg = -21.94").place == REYKJAVIK


@pytest.mark.parametrize(
    ("place", "named"),
    [
        ("[place]\nlat_deg = 64.15", "lon_deg"),
        ("[place]\nlat_deg = 164.15\nlon_deg = 1.0", "lat_deg"),
        ("[place]\nlat = 64.15\nlon_deg = 1.0", "lat_deg"),
    ],
)
def test_impossible_place_is_named(tmp_path: Path, place: str, named: str):
    with pytest.raises(ConfigError, match=named):
        settings(tmp_path, place)
