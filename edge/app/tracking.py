"""Tracker of a unit, from its settings and its sensors."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from edge.agent.fitted_sensor import FittedSensor
from edge.body_places import FOOT, is_worn_on
from edge.config import EdgeConfig
from edge.tracker.choice.automatic import AutomaticTracker
from edge.tracker.choice.one_sensor import OneSensorTracker
from edge.tracker.choice.selection import AUTO, select_named
from edge.tracker.interface import BodyDimensions, MultiSensorTracker, StepScale
from edge.tracker.registry import NoTracker
from shared.channels import NO_TRACKER


@dataclass(frozen=True, slots=True)
class Tracking:
    """Tracker as a pipeline takes it."""

    name: str
    tracker: MultiSensorTracker
    foot_sensor: str | None = None  # name of the sensor that has to be on a foot
    worn_on: str = ""  # place on the body that is assumed for a sensor without a configured one
    notes: tuple[str, ...] = ()  # what does not fit, for a person


def tracking_of(
    config: EdgeConfig,
    sensors: Sequence[FittedSensor],
    step_scales: Mapping[str, StepScale] | None = None,
) -> Tracking:
    """Return a new tracker.  Raises ConfigError for a name that is none.

    ``step_scales``: of the wearer's steps, by place of the sensor, where they are known.
    """
    if config.tracker == NO_TRACKER:
        first = sensors[0]
        on_foot = not first.description.place or is_worn_on(first.description.place, (FOOT,))
        foot_sensor = first.name if on_foot else None
        return Tracking(NO_TRACKER, OneSensorTracker(NoTracker()), foot_sensor)
    described = {one.name: one.corrected for one in sensors}
    wearer = config.wearer
    dimensions = BodyDimensions(wearer.height_m, wearer.leg_length_m, step_scales or {})
    if config.tracker == AUTO and not all(one.place for one in described.values()):
        return Tracking(AUTO, AutomaticTracker(described, dimensions))
    selection = select_named(config.tracker, described, dimensions)
    return Tracking(
        selection.tracker,
        selection.make(described, dimensions),
        selection.foot_sensor,
        selection.worn_on,
        selection.notes,
    )
