"""A black box tracked again as by its unit: settings and joined files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from msgspec.structs import replace

from edge.app.merged_batches import merged
from edge.app.retrack import config_of
from edge.samples import ButtonPress, ImuBatch, SensorBatch
from edge.sources.black_box import BlackBoxSource
from shared.clock import NS_PER_S
from shared.errors import ConfigError, RecordingError
from tests.rig.retracked_incident import unit


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("units") / "FF-01"
    assert list(unit(folder, "FF-01", "straight", 2.0))
    (boot,) = (folder / "black_box").iterdir()
    return boot


def test_settings_are_those_of_the_unit_with_what_is_given(recording: Path) -> None:
    source = BlackBoxSource(recording)
    config = config_of(source, recording, "", None, ["wearer.height_m=1.8", "worn_on = foot"])
    assert (config.tracker, config.wearer.height_m, config.worn_on) == ("eskf", 1.8, "foot")
    config = config_of(source, recording, "", None, ["gyro_bias_std_radps=0.002"])
    assert config.sensor("").gyro_bias_std_radps == 0.002
    assert config_of(source, recording, "huang", None, ()).tracker == "huang"


@pytest.mark.parametrize(
    ("setting", "message"),
    [
        ("wearer.heigth_m=1.8", "did you mean height_m"),
        ("wearer.height_m=9", r"wearer\.height_m"),
        ("wearer.height_m=tall", r"wearer\.height_m"),
        ("battery=auto", "battery is no setting"),
        ("gain_std", "no setting with its value"),
    ],
)
def test_a_setting_that_cannot_be_is_refused(recording: Path, setting: str, message: str) -> None:
    with pytest.raises(ConfigError, match=message):
        config_of(BlackBoxSource(recording), recording, "", None, [setting])


def test_calibrations_of_then_are_found_beside_the_boots(
    recording: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    source = BlackBoxSource(recording)
    sensors = tuple(replace(one, calibration="c1") for one in source.recorded.sensors)
    calibrated = replace(source.recorded, sensors=sensors)
    monkeypatch.setattr(BlackBoxSource, "recorded", property(lambda _: calibrated))
    with pytest.raises(RecordingError, match="calibration c1, which the unit used, is not beside"):
        config_of(source, recording, "", None, ())
    for folder in (recording.parent.parent, recording.parent):  # of a unit, and of a station
        kept = folder / "calibrations" / "c1.toml"
        kept.parent.mkdir()
        kept.touch()
        assert config_of(source, recording, "", None, ()).calibration == kept
    other = recording / "other.toml"
    assert config_of(source, recording, "", other, ()).calibration == other


def test_batches_end_where_another_second_begins() -> None:
    batches = list(_batches(count=50, period_ns=NS_PER_S // 20))
    found = [batch for _, batch in merged(batches)]
    times_ns = np.concatenate([batch.imu.t_ns for batch in found])
    assert times_ns.tolist() == [t for _, batch in batches for t in batch.imu.t_ns.tolist()]
    assert sum(len(batch.others) for batch in found) == len(batches)
    assert len(found) < 6
    # Each but the first and the last ends with the first batch that reaches another second.
    for batch in found[1:-1]:
        assert batch.imu.t_ns[-1] // NS_PER_S > batch.imu.t_ns[-6] // NS_PER_S


def test_a_gap_ends_a_batch() -> None:
    first, second = list(_batches(6, NS_PER_S // 20)), list(_batches(6, NS_PER_S // 20, 3.0))
    found = [batch for _, batch in merged([*first, *second])]
    for batch in found:
        assert np.diff(batch.imu.t_ns).max(initial=0) < NS_PER_S // 4


def _batches(count: int, period_ns: int, from_s: float = 0.3) -> list[tuple[int, SensorBatch]]:
    """Five samples each."""
    found = []
    for number in range(count):
        begin_ns = round(from_s * NS_PER_S) + number * period_ns
        t_ns = begin_ns + np.arange(5, dtype=np.int64) * (period_ns // 5)
        imu = ImuBatch(t_ns, np.zeros((5, 3)), np.zeros((5, 3)), pressure_pa=np.zeros(5))
        found.append((begin_ns, SensorBatch(imu, (ButtonPress(begin_ns, "mayday"),))))
    return found
