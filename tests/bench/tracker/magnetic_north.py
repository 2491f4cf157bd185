"""Accuracy of magnetic north at a calibrated unit, and of its stated deviation."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime

import numpy as np
from rich.table import Table

from edge.samples import Floats, ImuBatch
from edge.simulation.building import load_building
from edge.simulation.simulation import Simulation
from edge.tracker.interface import TrackBatch
from edge.tracker.registry import make_tracker
from edge.tracker.track_rows import join_rows
from shared.earth_field import EarthField, earth_field
from tests.bench.tracker.simulated_calibration import calibration_of
from tests.bench.tracker.walk_errors import rms, rotations_of

_EVERY = 200  # rows
_NEW_YEAR_NS = round(datetime(2026, 1, 1, tzinfo=UTC).timestamp() * 1e9)


@dataclass(frozen=True, slots=True)
class NorthErrors:
    """Over walks of one kind, root mean squares where it was reported."""

    walks: str
    reported: float  # share of the time
    off_deg: float
    std_deg: float  # as stated, median
    stated: float  # off by its stated deviation; 1 is honest, more is too sure


def field_of_house() -> EarthField:
    """Field of the model at the place where simulated people walk."""
    anchor = load_building().anchor
    found = earth_field(anchor.lat_deg, anchor.lon_deg, anchor.height_m, _NEW_YEAR_NS)
    assert isinstance(found, EarthField)
    return found


def find_north(
    walks: str,
    simulations: Sequence[Simulation],
    samples_of: Callable[[Simulation], ImuBatch],
    tracker: str,
) -> NorthErrors:
    """Calibrate each simulated unit by the book and track its walk with the field known."""
    offs, stds, reported = [], [], []
    for simulation in simulations:
        calibration = calibration_of(simulation)
        made = make_tracker(tracker, calibration.described(simulation.description))
        made.set_earth_field(field_of_house(), 0)
        imu = calibration.apply(samples_of(simulation), simulation.description)
        off_rad, std_rad, share = _north_of(join_rows([made.push(imu), made.finish()]), simulation)
        offs.append(off_rad)
        stds.append(std_rad)
        reported.append(share)
    off_rad, std_rad = np.concatenate(offs), np.concatenate(stds)
    if not len(off_rad):
        return NorthErrors(walks, 0.0, 0.0, 0.0, 0.0)
    return NorthErrors(
        walks,
        reported=float(np.mean(reported)),
        off_deg=float(np.degrees(rms(off_rad))),
        std_deg=float(np.degrees(np.median(std_rad))),
        stated=rms(off_rad / std_rad),
    )


def _north_of(rows: TrackBatch, simulation: Simulation) -> tuple[Floats, Floats, float]:
    """Error of magnetic north and its stated deviation where it is reported, and its share."""
    every = np.arange(0, len(rows), _EVERY)
    known = every[np.isfinite(rows.magnetic_north_std_rad[every])]
    truth = simulation.truth(np.asarray(rows.t_ns[known] * 1e-9, dtype=np.float64))
    turn = np.einsum("nij,nkj->nik", rotations_of(rows.quaternion_nb[known]), truth.rotation_nb)
    frame_rad = np.arctan2(turn[:, 1, 0] - turn[:, 0, 1], turn[:, 0, 0] + turn[:, 1, 1])
    off_rad = rows.magnetic_north_rad[known] - field_of_house().declination_rad - frame_rad
    wrapped_rad = np.asarray(np.angle(np.exp(1j * off_rad)), dtype=np.float64)
    return wrapped_rad, rows.magnetic_north_std_rad[known], len(known) / len(every)


def north_table(found: Sequence[NorthErrors]) -> Table:
    table = Table(title="Magnetic north of a calibrated unit (over stated deviation; 1 is honest)")
    for title in ("walks", "reported", "off, deg", "stated, deg"):
        table.add_column(title)
    for one in found:
        if one.reported == 0.0:
            table.add_row(one.walks, "never", "", "")
            continue
        off = f"{one.off_deg:.1f} ({one.stated:.1f})"
        table.add_row(one.walks, f"{100.0 * one.reported:.0f} %", off, f"{one.std_deg:.1f}")
    return table
