"""Simulation of a scenario: the truth at any time, and the stream of sensor samples."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields, replace
from math import radians

import numpy as np

from edge.samples import (
    ACKNOWLEDGE,
    AmbientSample,
    BatterySample,
    ButtonPress,
    Floats,
    GpsSample,
    ImuBatch,
    OtherSample,
    SensorBatch,
    SensorDescription,
    SightingSample,
)
from edge.simulation.beacons import Beacons
from edge.simulation.body_plan import BodyPlan
from edge.simulation.body_segments import Tremor, segment_motion
from edge.simulation.building import load_building
from edge.simulation.environment import (
    CONSUMER_BARO,
    CONSUMER_MAG,
    IDEAL_BARO,
    IDEAL_MAG,
    UNCALIBRATED_MAG,
    BaroErrors,
    Barometer,
    MagErrors,
    MagneticField,
    SimulatedMagnetometer,
    earth_n_ut,
)
from edge.simulation.gps import Gps
from edge.simulation.imu import (
    CONSUMER_IMU,
    GRAVITY_MPS2,
    IDEAL_IMU,
    UNCALIBRATED_IMU,
    Imu,
    ImuErrors,
)
from edge.simulation.kinematics import Motion
from edge.simulation.planner import Planner
from edge.simulation.scenario import Scenario
from shared.errors import ConfigError
from shared.messages.status import Activity

_BLOCK_S = 2  # generated at once; the noise does not depend on how it is cut into batches
_HALF_STRIDE_S = 0.55
_AROUND = 3  # times of ``_around`` a second


@dataclass(frozen=True, slots=True)
class SensorErrors:
    """The errors of all sensors that are sampled with the inertial ones."""

    imu: ImuErrors
    mag: MagErrors
    baro: BaroErrors


IDEAL_SENSORS = SensorErrors(IDEAL_IMU, IDEAL_MAG, IDEAL_BARO)
CONSUMER_SENSORS = SensorErrors(CONSUMER_IMU, CONSUMER_MAG, CONSUMER_BARO)
UNCALIBRATED_SENSORS = SensorErrors(UNCALIBRATED_IMU, UNCALIBRATED_MAG, CONSUMER_BARO)


class Simulation:
    """Simulation of a scenario; equal seeds give equal samples to the last bit.

    Simulations of one seed are of one person on one walk; of several sensors that this person
    wears each has a number, and errors and a mount of its own.  The sensor sits on its part of
    the body at an angle drawn from the seed.  Navigation axes are those of the site frame (NED,
    origin at its anchor); time starts at 0.
    """

    def __init__(
        self,
        scenario: Scenario,
        seed: int = 0,
        sensors: SensorErrors = CONSUMER_SENSORS,
        number: int = 0,
    ) -> None:
        self.scenario = scenario
        self._number = number
        self.sensors = _limited(sensors, scenario)
        house = load_building()
        self._building = house if scenario.building else None
        self._anchor = scenario.anchor or house.anchor
        walk_seed, mount_seed, self._sensor_seed = np.random.SeedSequence(seed).spawn(3)
        if number:
            _, mount_seed, self._sensor_seed = np.random.SeedSequence([seed, number]).spawn(3)
        walk_rng = np.random.default_rng(walk_seed)
        self.plan = _plan(scenario, walk_rng)
        self._tremor = Tremor(walk_rng)
        self._rotation_bs = _random_rotation(np.random.default_rng(mount_seed))

    @property
    def duration_s(self) -> float:
        return self.plan.duration_s

    @property
    def description(self) -> SensorDescription:
        imu = self.sensors.imu
        accel, gyro = imu.accel.full_scale, imu.gyro.full_scale
        return SensorDescription(
            name=f"simulated {self.scenario.name}",
            rate_hz=self.scenario.rate_hz,
            accel_full_scale_mps2=accel if np.isfinite(accel) else None,
            gyro_full_scale_radps=gyro if np.isfinite(gyro) else None,
            mag_present=True,
            barometer_present=True,
            gain_std=imu.gain_std,
        )

    def activity(self, t_s: float) -> Activity:
        return self.plan.activity(t_s)

    def truth(self, t_s: Floats) -> Motion:
        """The sensor's true motion at times ``t_s`` (n,); body axes are the sensor's own."""
        body = self._body(t_s)
        return replace(
            body,
            rotation_nb=body.rotation_nb @ self._rotation_bs,
            rate_b_radps=body.rate_b_radps @ self._rotation_bs,
        )

    def sensor_rngs(self) -> list[np.random.Generator]:
        """Return the five generators of the sensors' errors, new at each call."""
        return [np.random.default_rng(seed) for seed in _children(self._sensor_seed, 5)]

    def beacon_rng(self) -> np.random.Generator:
        """Return the generator of the beacons' signal strength, new at each call."""
        return np.random.default_rng(_children(self._sensor_seed, 6)[-1])

    def _body(self, t_s: Floats) -> Motion:
        return segment_motion(self.scenario.worn_on, self.plan, self._tremor, t_s)

    def _converted(self, t_s: Floats, body: Motion) -> Motion:
        """Return the motion at every conversion, evenly about the times of the readings."""
        conversions = self.scenario.conversions
        if conversions == 1:
            return body
        offsets = (np.arange(conversions) - 0.5 * (conversions - 1)) / conversions
        each_s = (t_s[:, np.newaxis] + offsets / self.scenario.rate_hz).reshape(-1)
        return self._body(np.maximum(each_s, 0.0))

    def batches(self, batch_s: float = 0.05) -> Iterator[SensorBatch]:
        """Yield the whole walk from its start, generated on demand."""
        rate_hz = self.scenario.rate_hz
        rows = max(1, round(rate_hz * batch_s))
        for block in self._blocks(max(1, round(_BLOCK_S * rate_hz / rows)) * rows):
            yield from _cut(block, rows)

    def _blocks(self, rows: int) -> Iterator[SensorBatch]:
        rate_hz = self.scenario.rate_hz
        imu_rng, mag_rng, baro_rng, gps_rng, other_rng = self.sensor_rngs()
        imu = Imu(self.sensors.imu, self._rotation_bs, rate_hz, imu_rng)
        mag = SimulatedMagnetometer(self.sensors.mag, self._field(mag_rng), mag_rng)
        baro = Barometer(
            self.sensors.baro, self._building, self._anchor.height_m, rate_hz, baro_rng
        )
        others = _Others(self, Gps(self._anchor, self._building, gps_rng), other_rng)
        is_first = self._number == 0  # the slow sensors are the unit's
        total = int(self.duration_s * rate_hz)
        for start in range(0, total, rows):
            index = np.arange(start, min(start + rows, total))
            t_s = index / rate_hz
            # Together: each call takes longer than the numbers of a few more times.
            seconds = _seconds_between(float(t_s[0]), (start + len(index)) / rate_hz)
            other_s = _around(seconds) if is_first else np.zeros(0)
            body, others_body = _split(self._body(np.concatenate((t_s, other_s))), len(t_s))
            temperature_degc = self._imu_temperature_degc(t_s)
            accel_mps2, gyro_radps = imu.measure(self._converted(t_s, body), temperature_degc)
            rotation_ns = body.rotation_nb @ self._rotation_bs
            yield SensorBatch(
                ImuBatch(
                    t_ns=np.rint(t_s * 1e9).astype(np.int64),
                    accel_mps2=accel_mps2,
                    gyro_radps=gyro_radps,
                    mag_ut=mag.measure(start, body.position_n_m, rotation_ns),
                    pressure_pa=baro.measure(start, t_s, body.position_n_m),
                    imu_temperature_degc=temperature_degc,
                ),
                others.at(seconds, others_body) if is_first else (),
            )

    def _field(self, rng: np.random.Generator) -> MagneticField:
        scenario = self.scenario
        if scenario.anchor is None:
            return MagneticField(self._building, rng, scenario.steel_ut)
        return MagneticField(self._building, rng, scenario.steel_ut, earth_n_ut(scenario.anchor))

    def ambient_degc(self, t_s: Floats) -> Floats:
        """Temperature around the equipment at times ``t_s`` (n,)."""
        times_s, values = np.array(self.scenario.ambient_degc).T
        return np.asarray(np.interp(t_s, times_s, values), dtype=np.float64)

    def _imu_temperature_degc(self, t_s: Floats) -> Floats:
        """Return the rest of the warm-up, and a little of the surroundings."""
        around = self.ambient_degc(t_s)
        warming_degc = 5.0 * (1.0 - np.exp(-t_s / 300.0))
        return 22.0 + warming_degc + 0.05 * (around - 22.0)


class _Others:
    """The slow sensors: ambient temperature and GPS every second, battery every ten; and the
    button that says that the wearer has understood, where the scenario has it pressed.
    """

    def __init__(self, simulation: Simulation, gps: Gps, rng: np.random.Generator) -> None:
        self._simulation = simulation
        self._gps = gps
        self._rng = rng
        self._beacons = Beacons(simulation.scenario.beacons, simulation.beacon_rng())

    def at(self, seconds: range, body: Motion) -> tuple[OtherSample, ...]:
        """``body``: the true motion at the times ``_around`` these seconds."""
        places_n_m = body.position_n_m.reshape(len(seconds), _AROUND, 3)
        times_s = body.t_s.reshape(len(seconds), _AROUND)
        samples: list[OtherSample] = []
        for second, place_n_m, t_s in zip(seconds, places_n_m, times_s, strict=True):
            if second % 10 == 0:
                samples.append(BatterySample(second * 1_000_000_000, self._battery(second)))
            samples.append(self._ambient(float(second)))
            samples.append(self._fix(float(second), place_n_m, t_s))
            samples += self._sightings(second, place_n_m[1])
            every_s = self._simulation.scenario.acknowledges_every_s
            if every_s is not None and second % every_s == 0:
                samples.append(ButtonPress(second * 1_000_000_000, ACKNOWLEDGE))
        return tuple(samples)

    def _sightings(self, second: int, place_n_m: Floats) -> list[SightingSample]:
        if not self._simulation.scenario.beacons:
            return []
        north_m, east_m, down_m = place_n_m
        return self._beacons.sightings(second, (float(north_m), float(east_m), float(down_m)))

    def _battery(self, t_s: float) -> float:
        scenario = self._simulation.scenario
        return max(0.0, scenario.battery_start - t_s / scenario.battery_life_s)

    def _ambient(self, t_s: float) -> AmbientSample:
        true_degc = float(self._simulation.ambient_degc(np.array([t_s]))[0])
        reading_degc = true_degc + float(self._rng.normal(0.0, 0.15))
        return AmbientSample(round(t_s * 1e9), round(reading_degc, 2))

    def _fix(self, t_s: float, place: Floats, around_s: Floats) -> GpsSample:
        # The wearer's velocity is the foot's mean over a stride.
        velocity = (place[2] - place[0]) / (around_s[2] - around_s[0])
        return self._gps.fix(
            t_s,
            (float(place[1, 0]), float(place[1, 1]), float(place[1, 2])),
            (float(velocity[0]), float(velocity[1])),
        )


def _seconds_between(start_s: float, end_s: float) -> range:
    return range(int(np.ceil(start_s)), int(np.ceil(end_s)))


def _around(seconds: range) -> Floats:
    """Half a stride before each second, itself, and half a stride after it; none is negative."""
    offsets_s = np.array([-_HALF_STRIDE_S, 0.0, _HALF_STRIDE_S])
    times_s: Floats = np.array(seconds, np.float64)[:, np.newaxis] + offsets_s
    return np.maximum(times_s, 0.0).reshape(-1)


def _split(motion: Motion, count: int) -> tuple[Motion, Motion]:
    """Return the motion at the first ``count`` times, and at the others."""
    columns = [getattr(motion, field.name) for field in fields(Motion)]
    return Motion(*(one[:count] for one in columns)), Motion(*(one[count:] for one in columns))


def _limited(sensors: SensorErrors, scenario: Scenario) -> SensorErrors:
    """Return the sensors with the full scales that the scenario has."""
    accel, gyro = sensors.imu.accel, sensors.imu.gyro
    if scenario.accel_full_scale_g is not None:
        accel = replace(accel, full_scale=scenario.accel_full_scale_g * GRAVITY_MPS2)
    if scenario.gyro_full_scale_degps is not None:
        gyro = replace(gyro, full_scale=radians(scenario.gyro_full_scale_degps))
    return replace(sensors, imu=replace(sensors.imu, accel=accel, gyro=gyro))


def _plan(scenario: Scenario, rng: np.random.Generator) -> BodyPlan:
    planner = Planner(rng, scenario.start, scenario.down_m, radians(scenario.heading_deg))
    for leg in scenario.legs:
        planner.do(leg)
    while scenario.loop and planner.plan.duration_s < scenario.duration_s:
        before_s = planner.plan.duration_s
        for leg in scenario.loop:
            planner.do(leg)
        if planner.plan.duration_s == before_s:
            raise ConfigError(f"the loop of scenario {scenario.name!r} takes no time")
    return planner.plan


def _children(seed: np.random.SeedSequence, count: int) -> list[np.random.SeedSequence]:
    """Return child seeds as ``spawn``, but the same ones at every call."""
    return [
        np.random.SeedSequence(seed.entropy, spawn_key=(*seed.spawn_key, k)) for k in range(count)
    ]


def _random_rotation(rng: np.random.Generator) -> Floats:
    """A matrix (3, 3) drawn evenly from all rotations (Shoemake 1992)."""
    quaternion = rng.normal(0.0, 1.0, 4)
    w, x, y, z = quaternion / np.linalg.norm(quaternion)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def _cut(block: SensorBatch, rows: int) -> Iterator[SensorBatch]:
    """Cut a block into batches; each other sample comes with the batch it fell into."""
    imu = block.imu
    for start in range(0, len(imu), rows):
        last = start + rows >= len(imu)
        begin_ns = imu.t_ns[start]
        end_ns = np.iinfo(np.int64).max if last else imu.t_ns[start + rows]
        yield SensorBatch(
            imu.part(slice(start, start + rows)),
            tuple(other for other in block.others if begin_ns <= other.t_ns < end_ns),
        )
