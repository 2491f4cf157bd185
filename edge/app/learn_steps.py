"""Command ``muster edge learn-steps``: lengths of a person's steps by a walk of known length."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import closing
from dataclasses import dataclass, replace
from threading import Event

import typer

from edge.agent.step_learning import is_of_a_walk, learn, scale_by_length
from edge.app.fitted_sensors import fitted_sensors
from edge.app.opened_sources import open_sources
from edge.app.tracking import tracking_of
from edge.config import EdgeConfig
from edge.identity import unit_connection
from edge.samples import SensorBatch
from edge.sources.bus import BusSource
from edge.sources.interface import Source
from edge.storage.data_folder import UnitDataFolder
from edge.storage.step_scales import StepScales
from edge.tracker.interface import LearnsSteps, StepScale
from shared.errors import ConfigError, UserError

LENGTH_M = (10.0, 1000.0)  # shorter: a step more or less counts too much


@dataclass(frozen=True, slots=True)
class MeasuredWalk:
    """One walk of known length."""

    place: str  # of the sensor
    tracked_m: float
    strides: int
    scale: StepScale  # of this walk


def learn_steps(config: EdgeConfig, length_m: float, for_s: float | None, stop: Event) -> None:
    """Track a walk, compare it with its length, keep and print what that shows of the wearer.

    Raises UserError, with nothing kept, where the walk cannot have been that long.
    """
    if not config.wearer.person:
        raise ConfigError(
            "whose steps these are is missing: give --person, the same as wearer.person in the "
            "unit's settings"
        )
    if not LENGTH_M[0] <= length_m <= LENGTH_M[1]:
        raise UserError(
            f"--length-m {length_m:g}: walk between {LENGTH_M[0]:g} and {LENGTH_M[1]:g} m, "
            "measured with a tape; 20 m are enough"
        )
    unit_id = unit_connection(config).unit_id
    with (
        closing(open_sources(config)) as source,
        closing(UnitDataFolder(config.data / unit_id)) as folder,
    ):
        if isinstance(source, BusSource):
            raise ConfigError(f"{config.source} is another unit; give the sensor's own source")
        walk = measure_walk(config, source, folder, length_m, _until(source, for_s, stop))
        store = StepScales(folder.step_scales, config.wearer.person)
        learnt = learn(store.learnt.get(walk.place), walk.scale)
        store.save({walk.place: learnt})
    typer.echo(
        f"{length_m:g} m walked, {walk.tracked_m:.1f} m tracked in {walk.strides} strides. Steps "
        f"of this person, sensor at {walk.place or 'an unknown place'}: {learnt.factor:.3f} of the "
        f"usual length, known to {100.0 * learnt.std:.1f} %. Used from the unit's next start."
    )


def measure_walk(
    config: EdgeConfig,
    source: Source,
    folder: UnitDataFolder,
    length_m: float,
    batches: Iterator[SensorBatch],
) -> MeasuredWalk:
    """Return what a walk of known length shows.  Raises UserError where it cannot be that long."""
    sensors = fitted_sensors(config, source, folder.path.name, folder.calibrations)
    tracking = tracking_of(config, sensors)
    tracker = tracking.tracker
    corrections = {one.name: one.correction() for one in sensors}
    parts = []
    for batch in batches:
        correction = corrections.get(batch.sensor)
        imu = batch.imu if correction is None else correction.push(batch.imu)
        if len(imu):
            parts.append(tracker.push(batch.sensor, imu))
    parts.append(tracker.finish())
    place = tracker.scaled_place if isinstance(tracker, LearnsSteps) else None
    if place is None:
        raise UserError(
            f"tracker {tracking.name} does not take its path from steps alone: lengths of steps "
            "are learnt of one sensor on trunk, hip, chest, in a pocket or a hand; give --worn-on"
        )
    rows = [part for part in parts if len(part)]
    tracked_m = float(rows[-1].distance_m[-1]) if rows else 0.0
    strides = int(rows[-1].steps[-1]) if rows else 0
    if tracked_m == 0.0 or not is_of_a_walk(length_m / tracked_m):
        raise UserError(
            f"{tracked_m:.1f} m were tracked in {strides} strides, and {length_m:g} m are given: "
            "no person's steps are so far from the usual length; nothing is kept. Stand, walk the "
            "length at an ordinary pace, stand, and give the length in metres"
        )
    scale = scale_by_length(length_m, tracked_m, tracker.path_noise)
    return MeasuredWalk(place, tracked_m, strides, scale)


def with_person(config: EdgeConfig, person: str | None) -> EdgeConfig:
    """Return the settings with this wearer, where one is given."""
    if person is None:
        return config
    return replace(config, wearer=replace(config.wearer, person=person))


def _until(source: Source, for_s: float | None, stop: Event) -> Iterator[SensorBatch]:
    """Yield the batches until the time is over, or the person stops it."""
    first_ns: int | None = None
    for batch in source.batches():
        yield batch
        if not len(batch.imu):
            continue
        first_ns = int(batch.imu.t_ns[0]) if first_ns is None else first_ns
        is_over = for_s is not None and batch.imu.t_ns[-1] - first_ns >= for_s * 1e9
        if is_over or stop.is_set():
            return
