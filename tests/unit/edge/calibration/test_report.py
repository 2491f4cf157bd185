"""Report at the end of a calibration for its maker."""

from __future__ import annotations

from dataclasses import dataclass
from io import StringIO
from pathlib import Path

import pytest
from rich.console import Console

from edge.calibration.file import identity
from edge.calibration.model import Accelerometer, Calibration, Gyroscope, Magnetometer
from edge.calibration.report import print_report
from tests.rig.calibration_steps import MADE

NONE = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))


@dataclass
class Found:
    """A calibration with what matters here."""

    misaligned: float = 0.0
    misaligned_std: float = 0.0
    residual_mps2: float = 0.002
    poses: int = 12

    def calibration(self) -> Calibration:
        return Calibration(
            "u1",
            "s",
            MADE,
            Accelerometer(
                gain=((1.012, self.misaligned, 0.0), (0.0, 0.995, 0.0), (0.0, 0.0, 1.0)),
                gain_std=((3e-4, self.misaligned_std, 0.0), (0.0, 3e-4, 0.0), (0.0, 0.0, 3e-4)),
                bias_mps2=(0.05, -0.1, 0.0),
                bias_std_mps2=(0.001, 0.001, 0.001),
                poses=self.poses,
                residual_mps2=self.residual_mps2,
            ),
            Gyroscope(
                bias_radps=(0.01, 0.0, -0.02),
                bias_std_radps=(1e-4, 1e-4, 1e-4),
                residual_radps=1e-4,
            ),
            Magnetometer(
                ((1.1, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 0.9)),
                NONE,
                (12.0, -7.0, 20.0),
                (0.1, 0.1, 0.1),
                48.0,
                0.3,
            ),
        )


def printed(found: Found, out: str = "u1.toml") -> str:
    reported = StringIO()
    print_report(found.calibration(), Path(out), Console(file=reported, width=110))
    return reported.getvalue()


def row(text: str, name: str) -> list[str]:
    (line,) = (line for line in text.splitlines() if f" {name} " in line)
    return [cell.strip() for cell in line.strip("│┃ ").split("│")]


def test_each_sensor_is_reported_in_the_units_of_a_person() -> None:
    reported = printed(Found())
    assert identity(Found().calibration()) in reported
    scale = row(reported, "accelerometer scale")
    assert scale == [
        "accelerometer scale",
        "+12.00 ± 0.30",
        "-5.00 ± 0.30",
        "+0.00 ± 0.30",
        "1/1000",
    ]
    assert row(reported, "gyroscope bias")[1:] == [
        "+0.5730 ± 0.0057",
        "+0.0000 ± 0.0057",
        "-1.1459 ± 0.0057",
        "deg/s",
    ]
    assert row(reported, "hard iron")[1:4] == ["+12.00 ± 0.10", "-7.00 ± 0.10", "+20.00 ± 0.10"]
    assert (
        "Residuals: accelerometer 0.0020 m/s2 over 12 poses; gyroscope 0.0057 deg/s; "
        "magnetometer 0.30 of 48.0 uT." in reported
    )
    assert "Poor" not in reported


@pytest.mark.parametrize("std", [0.0, 1e-4])
def test_misalignment_is_reported_or_asked_for(std: float) -> None:
    reported = printed(Found(misaligned=0.01, misaligned_std=std))
    assert ("lean the unit on its edges" in reported) is (std == 0.0)
    assert ("misaligned xy, xz, yz" in reported) is (std > 0.0)
    if std:
        assert row(reported, "... misaligned xy, xz, yz")[1:3] == [
            "+0.573 ± 0.006",
            "+0.000 ± 0.000",
        ]


def test_poor_calibration_has_to_be_repeated() -> None:
    assert "Poor: accelerometer off by 0.060 m/s2; do it again." in printed(
        Found(residual_mps2=0.06)
    )


def test_six_poses_without_a_residual_are_stated_to_have_none() -> None:
    reported = printed(Found(residual_mps2=0.0, poses=6))
    assert "Residuals: accelerometer unknown over 6 poses; " in reported
    assert "Poor: accelerometer of 6 poses only: nothing checks it; do it again." in reported
    assert "lean the unit on its edges" in reported


@pytest.mark.parametrize(
    "out", ["boxes [new]/[red]FF-01.toml", f"{'deep/' * 30}FF-01.toml"], ids=["brackets", "long"]
)
def test_path_of_the_file_is_reported_completely(out: str) -> None:
    reported = printed(Found(), out)
    assert f"Written to {out}; use it with `muster edge run --calibration {out}`." in reported
