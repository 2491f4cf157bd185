"""Source of recorded walks: a trial folder (``imu.csv.gz``, ``trial.json``, ``truth.csv``) or a
bare CSV.

What a sensor can do (missed samples, gaps, repeated or backward times, clipping)
is counted and passed on as it was recorded, because coping with it is the
tracker's work.  What only a person can do (wrong columns, wrong units, text
among the numbers) is an error.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import msgspec
import numpy as np

from edge.samples import Floats, ImuBatch, Nanoseconds, SensorBatch, SensorDescription
from edge.sources.csv_table import read_table
from edge.sources.interface import OfflineSource
from shared.errors import RecordingError

_ACCEL = ("accel_x_mps2", "accel_y_mps2", "accel_z_mps2")
_GYRO = ("gyro_x_radps", "gyro_y_radps", "gyro_z_radps")
_MAG = ("mag_x_ut", "mag_y_ut", "mag_z_ut")
_PRESSURE = "pressure_pa"
_TEMPERATURE = "imu_temperature_degc"

_GAP_INTERVALS = 3.0  # a hole this many sample intervals wide is called a gap
_CLIP_FRACTION = 0.998  # of full scale; sensors clip a little below the round number


class Trial(msgspec.Struct, frozen=True):
    """Contents of ``trial.json``; unknown keys are left alone."""

    dataset: str = ""
    trial: str = ""
    rate_hz: float | None = None
    duration_s: float | None = None
    truth_kind: str = ""
    sensor: str = ""
    licence: str = ""
    path_length_m: float | None = None
    closure_tolerance_m: float | None = None
    gyro_full_scale_dps: float | None = None
    accel_full_scale_mps2: float | None = None


@dataclass(frozen=True, slots=True, eq=False)
class RecordedTruth:
    """Reference positions of a trial, turned from z-up to the tracker's z-down.

    Origin and yaw stay arbitrary; ``down`` is NaN where the reference is flat.
    """

    t_s: Floats  # (n,) on the recording's clock
    position_n_m: Floats  # (n, 3) x, -y, -z of the file: right-handed, down positive


@dataclass(frozen=True, slots=True)
class RecordingReport:
    """Report of what is unusual in a recording; printing it gives one line for a person."""

    samples: int
    nan_samples: int  # samples in which an inertial axis is missing
    duplicate_times: int
    backward_times: int
    gaps: int  # holes of more than three sample intervals
    longest_gap_s: float  # 0 without a gap
    saturated_samples: int  # at full scale, where the full scale is known

    def __str__(self) -> str:
        counts = (
            (self.nan_samples, "with missing values"),
            (self.duplicate_times, "with repeated times"),
            (self.backward_times, "with times going back"),
            (self.gaps, f"gaps, the longest {self.longest_gap_s:.3f} s"),
            (self.saturated_samples, "at the sensor's full scale"),
        )
        found = [f"{count} {what}" for count, what in counts if count]
        return f"{self.samples} samples: " + (", ".join(found) if found else "nothing unusual")


class RecordingSource(OfflineSource):
    """Source that plays a recording from its first sample to its last; reads it whole when made.

    ``path`` is a trial folder or a bare CSV / CSV.gz with the same columns,
    whose rate is then estimated from its times.  Raises ``RecordingError``.
    """

    def __init__(self, path: Path | str, batch_s: float = 0.05) -> None:
        file, trial = _locate(Path(path))
        self._imu = _read_imu(file)
        self.trial = trial
        rate_hz = trial.rate_hz or _estimate_rate_hz(file, self._imu.t_ns)
        full_scale_dps = trial.gyro_full_scale_dps
        self._description = SensorDescription(
            name=trial.sensor or file.name,
            rate_hz=rate_hz,
            accel_full_scale_mps2=trial.accel_full_scale_mps2,
            gyro_full_scale_radps=None if full_scale_dps is None else np.radians(full_scale_dps),
            mag_present=self._imu.mag_ut is not None,
            barometer_present=self._imu.pressure_pa is not None,
        )
        _check_units(file, self._imu)
        self.report = _inspect(self._imu, self._description)
        self._rows_per_batch = max(1, round(rate_hz * batch_s))

    @property
    def description(self) -> SensorDescription:
        return self._description

    @property
    def imu(self) -> ImuBatch:
        """The whole recording at once."""
        return self._imu

    def batches(self) -> Iterator[SensorBatch]:
        for start in range(0, len(self._imu), self._rows_per_batch):
            yield SensorBatch(self._imu.part(slice(start, start + self._rows_per_batch)))


def read_trial(path: Path | str) -> Trial:
    """Read ``trial.json`` of a trial folder; an empty ``Trial`` without one."""
    file = Path(path) / "trial.json"
    if not file.exists():
        return Trial()
    try:
        trial = msgspec.json.decode(file.read_bytes(), type=Trial)
    except (msgspec.DecodeError, UnicodeDecodeError) as error:
        raise RecordingError(f"{file}: {error}; correct it or remove the file") from error
    if trial.rate_hz is not None and not 1.0 <= trial.rate_hz <= 1e5:
        raise RecordingError(
            f"{file}: rate_hz is {trial.rate_hz:g}; give samples per second, or leave it out"
        )
    return trial


def read_truth(path: Path | str) -> RecordedTruth | None:
    """Read ``truth.csv`` of a trial folder; ``None`` when the trial has none."""
    file = Path(path) / "truth.csv"
    if not file.exists():
        return None
    table = read_table(file, ("t_s", "x_m", "y_m"), ("z_m",))
    down_m = -table["z_m"] if "z_m" in table else np.full(len(table["t_s"]), np.nan)
    return RecordedTruth(table["t_s"], np.column_stack((table["x_m"], -table["y_m"], down_m)))


def _locate(path: Path) -> tuple[Path, Trial]:
    if not path.exists():
        raise RecordingError(f"there is no recording at {path}; check the path")
    if path.is_file():
        return path, Trial()
    for name in ("imu.csv.gz", "imu.csv"):
        if (path / name).is_file():
            return path / name, read_trial(path)
    raise RecordingError(
        f"{path} is a folder without imu.csv.gz or imu.csv; give a trial's own folder"
    )


def _read_imu(file: Path) -> ImuBatch:
    table = read_table(file, ("t_s", *_ACCEL, *_GYRO), (*_MAG, _PRESSURE, _TEMPERATURE))
    some = [name for name in _MAG if name in table]
    if some and len(some) < len(_MAG):
        raise RecordingError(f"{file}: of the magnetometer there is only {', '.join(some)}")
    return ImuBatch(
        t_ns=_nanoseconds(file, table["t_s"]),
        accel_mps2=_columns(table, _ACCEL),
        gyro_radps=_columns(table, _GYRO),
        mag_ut=_columns(table, _MAG) if some else None,
        pressure_pa=table.get(_PRESSURE),
        imu_temperature_degc=table.get(_TEMPERATURE),
    )


def _columns(table: dict[str, Floats], names: tuple[str, ...]) -> Floats:
    return np.column_stack([table[name] for name in names])


def _nanoseconds(file: Path, t_s: Floats) -> Nanoseconds:
    unusable = np.flatnonzero(~(np.abs(t_s) < 9e9))
    if len(unusable):
        raise RecordingError(
            f"{file}, sample {unusable[0] + 1}, column t_s: {t_s[unusable[0]]:g} is not a time in "
            "seconds; a sample without a time cannot be placed, so remove its line"
        )
    return np.rint(t_s * 1e9).astype(np.int64)


def _estimate_rate_hz(file: Path, t_ns: Nanoseconds) -> float:
    step_ns = np.diff(t_ns)
    forward_ns = step_ns[step_ns > 0]
    if not len(forward_ns):
        raise RecordingError(
            f"{file}: the times in t_s never advance, so the sample rate is unknown; "
            "give at least two samples with different times"
        )
    return 1e9 / float(np.median(forward_ns))


def _check_units(file: Path, imu: ImuBatch) -> None:
    """Catch g and degrees under the names of SI columns: no walk looks like that in SI."""
    accel = np.linalg.norm(imu.accel_mps2, axis=1)
    accel = accel[np.isfinite(accel)]
    if len(accel) and 0.5 < float(np.median(accel)) < 2.0:
        raise RecordingError(
            f"{file}: the typical acceleration is {np.median(accel):.2f}, which looks like g; "
            "multiply the accel columns by 9.80665 to have m/s^2"
        )
    gyro = np.linalg.norm(imu.gyro_radps, axis=1)
    gyro = gyro[np.isfinite(gyro)]
    if len(gyro) and float(np.quantile(gyro, 0.95)) > 100.0:
        raise RecordingError(
            f"{file}: angular rates reach {np.quantile(gyro, 0.95):.0f}, which looks like degrees "
            "per second; multiply the gyro columns by pi/180 to have rad/s"
        )


def _inspect(imu: ImuBatch, description: SensorDescription) -> RecordingReport:
    step_s = np.diff(imu.t_ns) * 1e-9
    gaps_s = step_s[step_s > _GAP_INTERVALS / description.rate_hz]
    bad = ~np.isfinite(imu.accel_mps2).all(axis=1) | ~np.isfinite(imu.gyro_radps).all(axis=1)
    saturated = np.zeros(len(imu), dtype=bool)
    for values, full_scale in (
        (imu.accel_mps2, description.accel_full_scale_mps2),
        (imu.gyro_radps, description.gyro_full_scale_radps),
    ):
        if full_scale is not None:
            saturated |= (np.abs(values) >= _CLIP_FRACTION * full_scale).any(axis=1)
    return RecordingReport(
        samples=len(imu),
        nan_samples=int(bad.sum()),
        duplicate_times=int((step_s == 0).sum()),
        backward_times=int((step_s < 0).sum()),
        gaps=len(gaps_s),
        longest_gap_s=float(gaps_s.max(initial=0.0)),
        saturated_samples=int(saturated.sum()),
    )
