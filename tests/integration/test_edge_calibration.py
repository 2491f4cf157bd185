"""An agent with a calibration: content of its black box."""

from __future__ import annotations

from pathlib import Path
from threading import Event

import numpy as np
import pytest

from edge.app.calibration_session import calibrate_recorded
from edge.app.run import run_agent
from edge.calibration.file import identity, read_calibration
from edge.config import EdgeConfig
from edge.sources.recording import RecordingSource
from edge.sources.registry import open_source
from shared.channels import DESCRIPTION, parse_key
from shared.codec import decode
from shared.mcap_log import read_log
from shared.messages import UnitDescription


@pytest.fixture
def still(tmp_path: Path) -> Path:
    """A recording of 15 s at rest, biased by 0.02 rad/s."""
    path = tmp_path / "still.csv"
    noise = np.random.default_rng(1).normal(0.0, 0.002, (1500, 6))
    rows = np.column_stack((np.arange(1500) * 0.01, noise + np.array([0, 0, 9.81, 0.02, 0, 0])))
    header = "t_s,accel_x_mps2,accel_y_mps2,accel_z_mps2,gyro_x_radps,gyro_y_radps,gyro_z_radps"
    np.savetxt(path, rows, "%.6f", delimiter=",", header=header, comments="")
    return path


def test_the_black_box_keeps_raw_samples_and_names_the_calibration(still, tmp_path):
    file = tmp_path / "u1.toml"
    calibrate_recorded({"still": str(still)}, file, "u1", None)
    config = EdgeConfig(
        source=f"recording:{still}",
        unit="u1",
        connect=("tcp/127.0.0.1:9",),
        data=tmp_path / "data",
        calibration=file,
    )
    run_agent(config, Event(), for_s=None, paced=False)
    calibration = read_calibration(file)
    (boot,) = (tmp_path / "data" / "u1" / "black_box").iterdir()
    kept = list(open_source(f"mcap:{boot}").batches())
    rates = np.vstack([batch.imu.gyro_radps for batch in kept])
    raw = RecordingSource(still).imu.gyro_radps
    assert np.abs(rates - raw).max() < 1e-3  # as the wire quantises
    assert rates[:, 0].mean() == pytest.approx(0.02, abs=1e-3)
    described = [
        decode(DESCRIPTION, payload)
        for _, key, payload in read_log(boot, on_damage=pytest.fail)
        if parse_key(key)[1] is DESCRIPTION
    ]
    named = {message.calibration for message in described if isinstance(message, UnitDescription)}
    assert named == {identity(calibration)}
    copy = tmp_path / "data" / "u1" / "calibrations" / f"{identity(calibration)}.toml"
    assert read_calibration(copy) == calibration
