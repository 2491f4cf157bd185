"""``muster track`` and ``muster bench track`` from a recording on disk."""

from __future__ import annotations

import json
import shutil

import numpy as np
import pytest
import typer
from typer.testing import CliRunner

from edge.app.track import COLUMNS, GAIT_COLUMNS, track
from edge.sample_codec.codec import SampleEncoder
from edge.sample_codec.descriptions import unit_sensor
from edge.samples import AmbientSample, SensorBatch, SensorDescription
from edge.storage.black_box.black_box import BlackBox
from shared.clock import ManualClock
from shared.errors import ConfigError, RecordingError, UserError
from tests.bench.tracker.track import WIDTH, bench_track, find_trials
from tests.rig.exact_strides import walk

AMBIENT = AmbientSample(0, 20.0)
HEADER = "t_s,accel_x_mps2,accel_y_mps2,accel_z_mps2,gyro_x_radps,gyro_y_radps,gyro_z_radps"


@pytest.fixture
def trial(tmp_path):
    folder = tmp_path / "walks" / "made" / "straight"
    folder.mkdir(parents=True)
    recorded = walk(strides=4)
    table = np.column_stack(
        (recorded.imu.t_ns * 1e-9, recorded.imu.accel_mps2, recorded.imu.gyro_radps)
    )
    np.savetxt(folder / "imu.csv", table, delimiter=",", header=HEADER, comments="")
    truth = recorded.position_n_m[::20]
    np.savetxt(
        folder / "truth.csv",
        np.column_stack((recorded.imu.t_ns[::20] * 1e-9, truth[:, 0], -truth[:, 1], -truth[:, 2])),
        delimiter=",",
        header="t_s,x_m,y_m,z_m",
        comments="",
    )
    about = {"dataset": "made", "trial": "straight", "rate_hz": 200.0, "sensor": "none"}
    (folder / "trial.json").write_text(json.dumps(about))
    return folder


def invoke(command, *arguments):
    app = typer.Typer()
    app.command()(command)
    result = CliRunner().invoke(app, [str(argument) for argument in arguments])
    assert result.exit_code == 0, result.output
    return result.output


def test_a_box_without_an_inertial_sample_is_stated_to_have_none(tmp_path):
    """The sensor was never there, and the thermometer was."""
    raw = SampleEncoder("u1", 7)
    description = raw.description(
        0, (unit_sensor("", SensorDescription("s", 100.0)),), source="", tracker=""
    )
    box = BlackBox(tmp_path / "box", description, 10**9, ManualClock())
    box.write(raw.messages(SensorBatch(walk(strides=1).imu.part(slice(0)), (AMBIENT,))))
    box.close()
    (boot,) = (tmp_path / "box").iterdir()
    out = tmp_path / "track.csv"
    with pytest.raises(RecordingError, match="holds no inertial samples"):
        track(boot, out)
    assert not out.exists()


def test_track_says_why_rows_are_not_good(trial, tmp_path):
    whole = invoke(track, trial, "--out", tmp_path / "whole.csv")
    assert "0% of the rows are not good." in " ".join(whole.split())
    lines = (trial / "imu.csv").read_text().splitlines(keepends=True)
    (trial / "imu.csv").write_text("".join(lines[:500] + lines[600:]))
    holed = invoke(track, trial, "--out", tmp_path / "holed.csv")
    assert "of the rows are not good: samples missing (" in " ".join(holed.split())


def test_track_writes_a_line_a_sample(trial, tmp_path):
    out = tmp_path / "track.csv"
    invoke(track, trial, "--out", out)
    lines = out.read_text().splitlines()
    assert lines[0] == COLUMNS
    assert lines[0].startswith("t_s,north_m,east_m,down_m,std_north_m,std_east_m,std_down_m")
    table = np.loadtxt(out, delimiter=",", skiprows=1)
    assert len(table) == len((trial / "imu.csv").read_text().splitlines()) - 1
    assert np.linalg.norm(table[-1, 1:3]) == pytest.approx(4 * 1.3, abs=0.2)
    assert np.all(np.diff(table[:, 0]) > 0.0)


def test_gait_has_a_line_for_each_swing(trial, tmp_path):
    out = tmp_path / "gait.csv"
    invoke(track, trial, "--out", tmp_path / "track.csv", "--gait", out)
    titles, *lines = out.read_text().splitlines()
    assert titles == GAIT_COLUMNS
    events = np.array([[float(cell or "nan") for cell in line.split(",")] for line in lines])
    assert len(events) >= 4
    toe_off_s, contact_s, swing_s, stance_s = events.T
    assert swing_s == pytest.approx(contact_s - toe_off_s, abs=0.0011)
    assert stance_s[:-1] == pytest.approx(toe_off_s[1:] - contact_s[:-1], abs=0.0011)
    assert np.isnan(stance_s[-1])  # nothing follows


def test_gait_of_a_sensor_that_is_on_no_foot_is_refused(trial, tmp_path):
    app = typer.Typer()
    app.command()(track)
    out, gait = tmp_path / "track.csv", tmp_path / "gait.csv"
    options = ["--out", str(out), "--gait", str(gait), "--tracker", "body"]
    result = CliRunner().invoke(app, [str(trial), *options])
    assert isinstance(result.exception, ConfigError)
    assert "sensor on a foot" in str(result.exception)
    assert not out.exists()


def test_output_that_cannot_be_written_is_reported(trial, tmp_path):
    app = typer.Typer()
    app.command()(track)
    result = CliRunner().invoke(app, [str(trial), "--out", str(tmp_path / "no" / "where.csv")])
    assert isinstance(result.exception, UserError)
    assert "choose another place" in str(result.exception)


def test_among_several_boots_of_a_black_box_one_is_to_be_chosen(tmp_path):
    (tmp_path / "boot").mkdir()
    (tmp_path / "boot" / "000001-20260301T100000Z.mcap").write_bytes(b"")
    app = typer.Typer()
    app.command()(track)
    result = CliRunner().invoke(app, [str(tmp_path), "--out", str(tmp_path / "track.csv")])
    assert "choose one of boot" in str(result.exception)


def test_bench_scores_every_trial_as_table_and_json(trial, tmp_path):
    json_file = tmp_path / "figures.json"
    output = invoke(bench_track, trial.parents[1], "--json", json_file)
    assert "made" in output
    report = json.loads(json_file.read_text())
    (figures,) = report["trials"]
    assert figures["trial"] == "straight"
    assert figures["ate_m"] < 0.1
    assert figures["vertical_rms_m"] < 0.1
    assert report["datasets"]["made"]["ate_m"]["mean"] == pytest.approx(figures["ate_m"])


def test_bench_shows_several_sets_apart(trial, tmp_path):
    hard = tmp_path / "hard"
    shutil.copytree(trial.parents[1], hard)
    json_file = tmp_path / "figures.json"
    output = invoke(bench_track, trial.parents[1], hard, "--json", json_file)
    assert "hard/made" in output
    report = json.loads(json_file.read_text())
    assert list(report["datasets"]) == [f"{trial.parents[1].name}/made", "hard/made"]


def test_bench_tracks_with_worse_sensors(trial, tmp_path):
    json_file = tmp_path / "figures.json"
    output = invoke(bench_track, trial, "--perturbed", "--json", json_file)
    assert "another mount" in output
    outcomes = json.loads(json_file.read_text())["perturbed"]
    assert outcomes[0]["perturbation"] == "as recorded"
    assert outcomes[0]["right"]


def test_tables_fit_a_terminal(trial):
    assert max(len(line) for line in invoke(bench_track, trial).splitlines()) <= WIDTH


def test_a_folder_without_trials_is_an_error(tmp_path):
    with pytest.raises(UserError, match="trials"):
        find_trials(tmp_path)
