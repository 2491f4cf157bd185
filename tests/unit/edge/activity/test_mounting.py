"""Mounting check: recorded feet are never rejected, backs and telephones always."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from edge.activity.mounting import WINDOW_NS, WINDOWS_TO_DECIDE, MountingCheck
from edge.samples import ImuBatch
from edge.sources.csv_table import read_table
from shared.clock import NS_PER_S

RATE_HZ = 100
AXES = tuple(
    f"{kind}_{axis}_{unit}"
    for kind, unit in (("accel", "mps2"), ("gyro", "radps"))
    for axis in "xyz"
)
MAGNETIC = tuple(f"mag_{axis}_ut" for axis in "xyz")
MAX_STEPS = 20
DECIDED_S = (WINDOWS_TO_DECIDE + 1) * WINDOW_NS / NS_PER_S


def recorded(path: Path) -> ImuBatch:
    table = read_table(path, ("t_s", *AXES), MAGNETIC)
    columns = np.column_stack([table[name] for name in AXES])
    t_ns = np.round(table["t_s"] * NS_PER_S).astype(np.int64)
    return ImuBatch(t_ns, columns[:, :3], columns[:, 3:])


def rejected_s(imu: ImuBatch, batch: int = 10) -> float | None:
    """Time at which the check first rejects the samples; None: never."""
    check = MountingCheck()
    for start in range(0, len(imu), batch):
        part = imu.part(slice(start, start + batch))
        check.push(part)
        if not check.is_on_foot:
            return float(part.t_ns[-1]) / NS_PER_S
    return None


def feet(walks: Path, hard_walks: Path, body: Path) -> Iterator[Path]:
    for folder in (walks, hard_walks):
        yield from folder.glob("*/*/imu.csv.gz")
    yield from body.glob("*/*/*_foot.csv.gz")


@pytest.mark.slow
def test_recorded_foot_is_never_rejected(
    walks: Path, hard_walks: Path, worn_elsewhere: tuple[Path, Path]
) -> None:
    paths = sorted(feet(walks, hard_walks, worn_elsewhere[0]))
    assert len(paths) > 150
    assert [path for path in paths if rejected_s(recorded(path)) is not None] == []


@pytest.mark.slow
def test_recorded_back_is_rejected_within_twenty_steps(
    worn_elsewhere: tuple[Path, Path],
) -> None:
    paths = sorted(worn_elsewhere[0].glob("*/*/lower_back.csv.gz"))
    assert len(paths) > 50
    for path in paths:
        trial = json.loads((path.parent / "trial.json").read_text(encoding="utf-8"))
        swings = [*trial["left_swing_or_stride_s"], *trial["right_swing_or_stride_s"]]
        found_s = rejected_s(recorded(path))
        assert found_s is not None, path
        assert sum(begin_s < found_s for begin_s, _ in swings) <= MAX_STEPS, path


@pytest.mark.slow
def test_recorded_telephone_is_rejected(worn_elsewhere: tuple[Path, Path]) -> None:
    paths = sorted(worn_elsewhere[1].glob("*/*/imu.csv.gz"))
    assert len(paths) > 30
    assert [path for path in paths if rejected_s(recorded(path)) is None] == []


def hip(duration_s: float, start_s: float = 0.0, shake_mps2: float = 3.0) -> ImuBatch:
    """Specific force and rate of a part of the body that neither swings nor rests."""
    t_s = start_s + np.arange(round(duration_s * RATE_HZ)) / RATE_HZ
    accel_mps2 = np.zeros((len(t_s), 3))
    accel_mps2[:, 2] = 9.81 + shake_mps2 * np.sin(2.0 * np.pi * 1.8 * t_s)
    gyro_radps = np.full((len(t_s), 3), 0.5)
    return ImuBatch(np.round(t_s * NS_PER_S).astype(np.int64), accel_mps2, gyro_radps)


def foot(duration_s: float, start_s: float) -> ImuBatch:
    """The same with a stance of 0.4 s each second."""
    imu = hip(duration_s, start_s)
    imu.gyro_radps[imu.t_ns % NS_PER_S < 0.4 * NS_PER_S] = 0.0
    return imu


@pytest.mark.parametrize("batch", [1, 7, 1000])
def test_verdict_does_not_depend_on_the_batches(batch: int) -> None:
    found_s = rejected_s(hip(20.0), batch)
    assert found_s is not None
    assert DECIDED_S - 2.5 < found_s <= DECIDED_S + batch / RATE_HZ


def test_unit_put_on_a_foot_again_is_accepted_after_as_much_motion() -> None:
    check = MountingCheck()
    check.push(hip(20.0))
    check.push(foot(4.0, 20.0))
    assert not check.is_on_foot
    check.push(foot(8.0, 24.0))
    assert check.is_on_foot


@pytest.mark.parametrize(
    "imu",
    [
        hip(60.0, shake_mps2=0.5),
        ImuBatch(np.arange(6000) * (NS_PER_S // RATE_HZ), *np.full((2, 6000, 3), np.nan)),
        hip(0.0),
    ],
    ids=["stands", "no numbers", "no samples"],
)
def test_samples_without_motion_decide_nothing(imu: ImuBatch) -> None:
    assert rejected_s(imu) is None


def test_gap_and_clock_that_goes_back_decide_nothing() -> None:
    check = MountingCheck()
    for start_s in (5.0, 2.0, 8000.0):
        check.push(hip(1.2, start_s))
    assert check.is_on_foot
