"""Environment of the wearer: magnetic field, air pressure, and the sensors for them."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, sin

import numpy as np

from edge.samples import Floats
from edge.simulation.building import Building
from shared.clock import NS_PER_S
from shared.earth_field import EarthField, earth_field
from shared.geo import Anchor, pressure_pa_at

# At the training house in 2026 (World Magnetic Model 2025): north, east, down.
_EARTH_FIELD_N_UT = np.array([16.07, 1.48, 48.56])
_IN_2026_NS = 1_783_000_000 * NS_PER_S
_AIR_SCALE_HEIGHT_M = 8434.0  # isothermal air at 15 degC


@dataclass(frozen=True, slots=True)
class MagErrors:
    noise_std_ut: float = 0.0  # a sample
    hard_iron_std_ut: float = 0.0  # an axis, drawn once
    soft_iron_std: float = 0.0  # drawn once
    resolution_ut: float = 0.0
    every: int = 1  # gives a value at every so many inertial samples


@dataclass(frozen=True, slots=True)
class BaroErrors:
    noise_std_pa: float = 0.0  # a sample
    offset_std_pa: float = 0.0  # drawn once
    drift_pa: float = 0.0  # random walk, Pa / sqrt(s): weather and warming
    slam_std_pa: float = 0.0  # pressure wave of a door, drawn for each
    slam_interval_s: float = 45.0  # mean, indoors
    every: int = 1


IDEAL_MAG = MagErrors()
CONSUMER_MAG = MagErrors(0.4, 8.0, 0.04, 0.15, every=2)
UNCALIBRATED_MAG = MagErrors(0.4, 25.0, 0.10, 0.15, every=2)  # beside a battery
IDEAL_BARO = BaroErrors()
CONSUMER_BARO = BaroErrors(1.5, 60.0, 0.15, 25.0, every=8)


class MagneticField:
    """The earth's field, bent by steel inside a building."""

    def __init__(
        self,
        building: Building | None,
        rng: np.random.Generator,
        steel_ut: float = 3.0,
        earth_n_ut: Floats = _EARTH_FIELD_N_UT,
    ) -> None:
        self._building = building
        self._earth_n_ut = earth_n_ut
        wave_m = rng.uniform(1.5, 5.0, 6)
        direction = rng.normal(0.0, 1.0, (6, 3))
        direction /= np.linalg.norm(direction, axis=1, keepdims=True)
        self._wave_per_m = 2.0 * np.pi / wave_m[:, None] * direction
        self._phase = rng.uniform(0.0, 2.0 * np.pi, 6)
        self._amplitude_ut = rng.normal(0.0, steel_ut, (6, 3))

    def at(self, position_n_m: Floats) -> Floats:
        """Flux density (n, 3) in navigation axes."""
        field_ut = np.tile(self._earth_n_ut, (len(position_n_m), 1))
        if self._building is not None:
            depth_m = self._building.depth_inside_m(position_n_m[:, 0], position_n_m[:, 1])
            share = np.clip((depth_m + 1.0) / 2.0, 0.0, 1.0)[:, None]
            waves = np.sin(position_n_m @ self._wave_per_m.T + self._phase)
            field_ut += share * (waves @ self._amplitude_ut)
        return field_ut


def earth_n_ut(anchor: Anchor) -> Floats:
    """The undisturbed field (3,) at a site in 2026, in the site's axes."""
    found = earth_field(anchor.lat_deg, anchor.lon_deg, anchor.height_m, _IN_2026_NS)
    assert isinstance(found, EarthField)
    heading_rad = found.declination_rad - anchor.rotation_rad
    return np.array(
        [
            found.horizontal_ut * cos(heading_rad),
            found.horizontal_ut * sin(heading_rad),
            found.down_ut,
        ]
    )


class SimulatedMagnetometer:
    def __init__(self, errors: MagErrors, field: MagneticField, rng: np.random.Generator) -> None:
        self._errors = errors
        self._field = field
        self._rng = rng
        self._hard_iron_ut = rng.normal(0.0, 1.0, 3) * errors.hard_iron_std_ut
        soft = rng.normal(0.0, 1.0, (3, 3)) * errors.soft_iron_std
        self._soft_iron = np.eye(3) + (soft + soft.T) / 2.0

    def measure(self, index: int, position_n_m: Floats, rotation_ns: Floats) -> Floats:
        """Flux density (n, 3), sensor axes; NaN between its samples.

        ``index`` counts the first row since the start.
        """
        rows = slice(-index % self._errors.every, None, self._errors.every)
        field_ut = self._field.at(position_n_m[rows])
        reading = np.einsum("nji,nj->ni", rotation_ns[rows], field_ut) @ self._soft_iron
        reading += self._hard_iron_ut
        reading += self._rng.normal(0.0, 1.0, reading.shape) * self._errors.noise_std_ut
        if self._errors.resolution_ut:
            reading = np.rint(reading / self._errors.resolution_ut) * self._errors.resolution_ut
        measured = np.full(position_n_m.shape, np.nan)
        measured[rows] = reading
        return measured


class Barometer:
    """Static pressure with the waves that closing doors send through a building."""

    def __init__(
        self,
        errors: BaroErrors,
        building: Building | None,
        site_height_m: float,
        rate_hz: float,
        rng: np.random.Generator,
    ) -> None:
        self._errors = errors
        self._building = building
        self._rng = rng
        self._rate_hz = rate_hz
        self._surface_pa = pressure_pa_at(site_height_m)
        self._offset_pa = float(rng.normal(0.0, 1.0)) * errors.offset_std_pa
        self._slam_rng = rng.spawn(1)[0]
        self._slams: list[tuple[float, float]] = []  # time, amplitude
        self._next_slam_s = float(self._slam_rng.exponential(errors.slam_interval_s))

    def measure(self, index: int, t_s: Floats, position_n_m: Floats) -> Floats:
        """Pressure (n,); NaN between its samples.  ``index`` counts the first row."""
        errors = self._errors
        rows = slice(-index % errors.every, None, errors.every)
        at_s, place = t_s[rows], position_n_m[rows]
        steps = self._rng.normal(0.0, 1.0, len(at_s))
        walk_pa = self._offset_pa + np.cumsum(
            steps * errors.drift_pa * (errors.every / self._rate_hz) ** 0.5
        )
        if len(walk_pa):
            self._offset_pa = float(walk_pa[-1])
        measured = np.full(len(t_s), np.nan)
        measured[rows] = (
            self._surface_pa * np.exp(place[:, 2] / _AIR_SCALE_HEIGHT_M)
            + walk_pa
            + self._door_waves_pa(at_s, place)
            + self._rng.normal(0.0, 1.0, len(at_s)) * errors.noise_std_pa
        )
        return measured

    def _door_waves_pa(self, t_s: Floats, position_n_m: Floats) -> Floats:
        waves_pa = np.zeros(len(t_s))
        if self._building is None or self._errors.slam_std_pa == 0.0 or not len(t_s):
            return waves_pa
        while self._next_slam_s < t_s[-1]:
            amplitude_pa = float(self._slam_rng.normal(0.0, self._errors.slam_std_pa))
            self._slams = [*self._slams[-4:], (self._next_slam_s, amplitude_pa)]
            self._next_slam_s += float(self._slam_rng.exponential(self._errors.slam_interval_s))
        for slam_s, amplitude_pa in self._slams:
            age_s = np.maximum(t_s - slam_s, 0.0)
            waves_pa += amplitude_pa * np.exp(-age_s / 0.4) * np.sin(2.0 * np.pi * 1.5 * age_s)
        indoors = self._building.depth_inside_m(position_n_m[:, 0], position_n_m[:, 1]) > 0.0
        return waves_pa * indoors
