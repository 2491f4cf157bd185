"""Recordings: a sensor's faults pass and are counted, a file's faults are named."""

from __future__ import annotations

import gzip
import json
from pathlib import Path

import numpy as np
import pytest

from edge.samples import ImuBatch
from edge.sources.recording import RecordingReport, RecordingSource, read_trial, read_truth
from shared.errors import RecordingError

HEADER = "t_s,accel_x_mps2,accel_y_mps2,accel_z_mps2,gyro_x_radps,gyro_y_radps,gyro_z_radps"
STILL = "0.1,0.2,-9.8,0.001,0.002,0.003"


def recording(tmp_path: Path, rows: list[str], header: str = HEADER) -> Path:
    path = tmp_path / "imu.csv"
    path.write_text("\n".join([header, *rows]) + "\n", encoding="utf-8")
    return path


def at_times(*times_s: float) -> list[str]:
    return [f"{t_s:.3f},{STILL}" for t_s in times_s]


def joined(source: RecordingSource) -> ImuBatch:
    parts = [batch.imu for batch in source.batches()]
    return ImuBatch(
        t_ns=np.concatenate([imu.t_ns for imu in parts]),
        accel_mps2=np.concatenate([imu.accel_mps2 for imu in parts]),
        gyro_radps=np.concatenate([imu.gyro_radps for imu in parts]),
    )


def test_every_sample_comes_once_and_in_si_units(tmp_path: Path) -> None:
    source = RecordingSource(recording(tmp_path, at_times(*np.arange(0, 1, 0.005))))
    samples = joined(source)
    assert len(samples) == 200
    assert samples.t_ns[1] == 5_000_000
    assert samples.accel_mps2[7].tolist() == [0.1, 0.2, -9.8]
    assert samples.gyro_radps[7].tolist() == [0.001, 0.002, 0.003]
    assert source.description.rate_hz == pytest.approx(200.0)
    assert not source.is_live
    assert source.radio_outages == ()


@pytest.mark.parametrize("batch_s", [0.001, 0.05, 10.0])
def test_batches_have_the_length_asked_for(tmp_path: Path, batch_s: float) -> None:
    path = recording(tmp_path, at_times(*np.arange(0, 1, 0.01)))
    sizes = [len(batch.imu) for batch in RecordingSource(path, batch_s=batch_s).batches()]
    assert sum(sizes) == 100
    assert set(sizes[:-1]) <= {max(1, round(batch_s * 100))}


def test_a_trial_folder_says_rate_sensor_and_full_scale(tmp_path: Path) -> None:
    (tmp_path / "imu.csv.gz").write_bytes(
        gzip.compress("\n".join([HEADER, *at_times(0, 0.1, 0.2)]).encode())
    )
    trial = {"rate_hz": 10.5, "sensor": "a sensor", "gyro_full_scale_dps": 500, "colour": "red"}
    (tmp_path / "trial.json").write_text(json.dumps(trial), encoding="utf-8")
    description = RecordingSource(tmp_path).description
    assert description.name == "a sensor"
    assert description.rate_hz == 10.5
    assert description.gyro_full_scale_radps == pytest.approx(np.radians(500))
    assert not description.mag_present


def test_optional_columns_in_any_order(tmp_path: Path) -> None:
    header = f"pressure_pa,{HEADER},mag_x_ut,mag_y_ut,mag_z_ut,imu_temperature_degc"
    rows = [f"101325,0.0,{STILL},20,1,40,25", f",0.1,{STILL},,,,"]
    source = RecordingSource(recording(tmp_path, rows, header))
    imu = source.imu
    assert imu.mag_ut is not None
    assert imu.pressure_pa is not None
    assert imu.imu_temperature_degc is not None
    assert imu.pressure_pa[0] == 101325.0
    assert np.isnan(imu.pressure_pa[1])
    assert imu.mag_ut[0].tolist() == [20.0, 1.0, 40.0]
    assert np.isnan(imu.mag_ut[1]).all()
    assert np.isnan(imu.imu_temperature_degc[1])
    assert source.description.mag_present
    assert source.description.barometer_present
    assert source.report.nan_samples == 0, "a missed magnetometer sample is no bad sample"


def test_oddities_of_a_sensor_are_counted_and_kept(tmp_path: Path) -> None:
    rows = at_times(0.00, 0.01, 0.02, 0.02, 0.03, 0.025, 0.035, 0.50, 0.51)
    rows[1] = "0.010,,0.2,-9.8,0.001,0.002,0.003"
    rows[2] = "0.020,0.1,0.2,-9.8,0.001,nan,0.003"
    source = RecordingSource(recording(tmp_path, rows))
    longest_gap_s = source.report.longest_gap_s
    assert longest_gap_s == pytest.approx(0.465)
    assert source.report == RecordingReport(
        samples=9,
        nan_samples=2,
        duplicate_times=1,
        backward_times=1,
        gaps=1,
        longest_gap_s=longest_gap_s,
        saturated_samples=0,
    )
    samples = joined(source)
    assert (np.rint(samples.t_ns / 1e6)).tolist() == [0, 10, 20, 20, 30, 25, 35, 500, 510]
    assert np.isnan(samples.accel_mps2[1, 0])
    assert np.isnan(samples.gyro_radps[2, 1])
    assert str(source.report) == (
        "9 samples: 2 with missing values, 1 with repeated times, 1 with times going back, "
        "1 gaps, the longest 0.465 s"
    )


def test_saturated_samples_are_counted_where_full_scale_is_known(tmp_path: Path) -> None:
    rows = at_times(0.0, 0.1, 0.2)
    rows[1] = f"0.1,0.1,0.2,-9.8,0.001,{-np.radians(500):.6f},0.003"
    recording(tmp_path, rows)
    (tmp_path / "trial.json").write_text('{"gyro_full_scale_dps": 500}', encoding="utf-8")
    assert RecordingSource(tmp_path).report.saturated_samples == 1


def test_nothing_unusual_is_stated_so(tmp_path: Path) -> None:
    source = RecordingSource(recording(tmp_path, at_times(0.0, 0.1, 0.2)))
    assert str(source.report) == "3 samples: nothing unusual"


@pytest.mark.parametrize(
    ("header", "rows", "reported"),
    [
        ("", [], "is empty"),
        ("", [HEADER, *at_times(0, 1)], "starts with an empty line"),
        (HEADER.replace(",", ";"), ["0;0,1;2,0;9,8;4,0;5,0;6,0"], "between semicolons"),
        (HEADER.replace(",", "\t"), ["0\t1\t2\t9.8\t4\t5\t6"], "between tabs"),
        (HEADER, [], "no samples"),
        (HEADER.replace("gyro_y_radps,", ""), ["0,1,2,3,4,5"], "missing column gyro_y_radps"),
        (HEADER.replace("accel_x_mps2", "accel_x_g"), at_times(0, 1), "did you mean accel_x_mps2"),
        (HEADER.replace("gyro_x_radps", "gyro_x_dps"), at_times(0, 1), "did you mean gyro_x_radps"),
        (HEADER + ",mag_x_ut", [f"0,{STILL},1", f"1,{STILL},1"], "only mag_x_ut"),
        (HEADER + ",t_s", [f"0,{STILL},1"], "t_s is there twice"),
        (HEADER, [*at_times(0), "0.1,0.1,oops,3,4,5,6"], "line 3, column accel_y_mps2: 'oops'"),
        (HEADER, [*at_times(0), "0.1,0.1,0.2"], "line 3: 3 cells"),
        (HEADER, [*at_times(0, 0.1), f"0.2,{STILL},7"], "line 4: 8 cells"),
        (HEADER, [*at_times(0), f",{STILL}"], "sample 2, column t_s"),
        (HEADER, at_times(1, 1, 1), "never advance"),
        (HEADER, ["0,0,0,1,0,0,0", "1,0,0,1,0,0,0"], "looks like g"),
        (HEADER, ["0,0,0,9.8,200,0,0", "1,0,0,9.8,300,0,0"], "looks like degrees"),
    ],
)
def test_a_bad_file_is_named_with_what_to_do(
    tmp_path: Path, header: str, rows: list[str], reported: str
) -> None:
    path = recording(tmp_path, rows, header)
    with pytest.raises(RecordingError) as caught:
        RecordingSource(path)
    assert reported in str(caught.value)
    assert "imu.csv" in str(caught.value)


def test_a_missing_file_a_bare_folder_and_binary_junk(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match="there is no recording"):
        RecordingSource(tmp_path / "nothing")
    with pytest.raises(RecordingError, match=r"folder without imu.csv.gz"):
        RecordingSource(tmp_path)
    junk = tmp_path / "junk.csv"
    junk.write_bytes(bytes(range(256)))
    with pytest.raises(RecordingError, match="is not text"):
        RecordingSource(junk)
    not_gzip = tmp_path / "plain.csv.gz"
    not_gzip.write_text(HEADER, encoding="utf-8")
    with pytest.raises(RecordingError, match="cannot be read"):
        RecordingSource(not_gzip)


def test_a_torn_gzip_file_is_named(tmp_path: Path) -> None:
    whole = gzip.compress("\n".join([HEADER, *at_times(*np.arange(0, 5, 0.01))]).encode())
    path = tmp_path / "imu.csv.gz"
    path.write_bytes(whole[: len(whole) // 2])
    with pytest.raises(RecordingError, match="damaged gzip"):
        RecordingSource(path)


@pytest.mark.parametrize("text", ['{"rate_hz": "fast"}', '{"rate_hz": 0}', "not json"])
def test_a_bad_trial_file_is_named(tmp_path: Path, text: str) -> None:
    recording(tmp_path, at_times(0, 1))
    (tmp_path / "trial.json").write_text(text, encoding="utf-8")
    with pytest.raises(RecordingError, match=r"trial\.json"):
        RecordingSource(tmp_path)


def test_truth_is_turned_z_down_without_a_mirror(tmp_path: Path) -> None:
    assert read_truth(tmp_path) is None
    (tmp_path / "truth.csv").write_text("t_s,x_m,y_m,z_m\n0,1,2,3\n", encoding="utf-8")
    truth = read_truth(tmp_path)
    assert truth is not None
    assert truth.position_n_m.tolist() == [[1.0, -2.0, -3.0]]
    (tmp_path / "truth.csv").write_text("t_s,x_m,y_m\n0,1,2\n", encoding="utf-8")
    flat = read_truth(tmp_path)
    assert flat is not None
    assert np.isnan(flat.position_n_m[0, 2])


@pytest.mark.slow
def test_recorded_walks_are_read(walks: Path) -> None:
    trials = sorted(walks.glob("*/*"))
    assert trials
    for trial in trials:
        source = RecordingSource(trial)
        expected_s = read_trial(trial).duration_s
        assert expected_s is not None
        duration_s = float(source.imu.t_ns[-1] - source.imu.t_ns[0]) * 1e-9
        assert duration_s == pytest.approx(expected_s, abs=0.1)
