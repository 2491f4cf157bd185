"""Registry of trackers.  A new tracker is a file and a line here."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import partial
from itertools import permutations

from edge.body_places import is_worn_on
from edge.samples import ImuBatch, SensorDescription
from edge.tracker.body.tracker import BodyTracker
from edge.tracker.foot.eskf import EskfTracker
from edge.tracker.fused_paths.tracker import FOOT_AND_TRUNK, TWO_FEET, FusedPathsTracker
from edge.tracker.hip.state import HipConfig
from edge.tracker.hip.tracker import HipTracker
from edge.tracker.huang.tracker import HuangTracker
from edge.tracker.interface import (
    FOOT,
    LEFT_FOOT,
    RIGHT_FOOT,
    BodyDimensions,
    MultiSensorTracker,
    MultiSensorTrackerEntry,
    TrackBatch,
    Tracker,
    TrackerEntry,
    WornSensor,
)
from edge.tracker.torso_shank.tracker import TorsoShankTracker
from edge.tracker.track_rows import empty_rows
from edge.tracker.waist.tracker import WaistTracker
from shared.earth_field import EarthField
from shared.errors import ConfigError
from shared.path_noise import PathNoise


class NoTracker:
    """Tracker of a unit too weak to track: no rows.  Its tracking agent computes the positions.

    Not in ``TRACKERS``, as it does not fulfil the contract of their interface.
    """

    path_noise: PathNoise | None = None

    def push(self, batch: ImuBatch) -> TrackBatch:
        del batch
        return empty_rows()

    def set_earth_field(self, field: EarthField, t_ns: int) -> None:
        del field, t_ns

    def finish(self) -> TrackBatch:
        return empty_rows()


TRACKERS: tuple[TrackerEntry, ...] = (
    TrackerEntry("eskf", "error-state filter with stride-adaptive stance (default)", EskfTracker),
    TrackerEntry(
        "huang", "the thesis's method: pitch-rate stance, quasi-static resets", HuangTracker
    ),
    TrackerEntry(
        "waist",
        "steps of a sensor on the waist, lengths by their frequency",
        WaistTracker,
        ("waist", "hip"),
        by_compass=True,
    ),
    TrackerEntry(
        "hip",
        "velocity of a hip, by a model within each step",
        HipTracker,
        ("hip", "waist"),
        by_compass=True,
    ),
    TrackerEntry(
        "hip-corridors",
        "the same; assumes straight corridors that meet at right angles",
        partial(HipTracker, config=HipConfig(straight_walks=True, right_angles=True)),
        ("hip", "waist"),
        by_compass=True,
    ),
    TrackerEntry(
        "body",
        "steps of a sensor anywhere but on a foot, with stated errors",
        BodyTracker,
        ("hip", "chest", "waist", "pocket"),
    ),
)

MULTI_SENSOR_TRACKERS: tuple[MultiSensorTrackerEntry, ...] = (
    MultiSensorTrackerEntry(
        "torso_shank",
        "velocity of a torso, put right by a shank once a stride",
        TorsoShankTracker,
        (("chest", "waist"), ("shank",)),
    ),
    MultiSensorTrackerEntry(
        "two_feet",
        "paths of both feet, each by eskf, fused into one",
        partial(FusedPathsTracker, config=TWO_FEET),
        ((LEFT_FOOT, FOOT), (RIGHT_FOOT, FOOT)),
    ),
    MultiSensorTrackerEntry(
        "foot_and_trunk",
        "path of a foot, and of the trunk where the foot fails, with lengths learnt from it",
        partial(FusedPathsTracker, config=FOOT_AND_TRUNK),
        ((FOOT, LEFT_FOOT, RIGHT_FOOT), ("waist", "chest", "hip")),
    ),
)


def make_tracker(
    name: str, description: SensorDescription, other_names: tuple[str, ...] = ()
) -> Tracker:
    """Return a new tracker by its name in ``TRACKERS``; ``ConfigError`` if there is none.

    ``other_names``: what else the caller would have taken for a name.
    """
    return find_tracker(name, other_names).make(description)


def find_tracker(name: str, other_names: tuple[str, ...] = ()) -> TrackerEntry:
    """Return the line of ``TRACKERS`` with this name; see ``make_tracker``."""
    for entry in TRACKERS:
        if entry.name == name:
            return entry
    known = ", ".join((*(entry.name for entry in TRACKERS), *other_names))
    raise ConfigError(f"There is no tracker '{name}'. Known trackers: {known}.")


def make_multi_sensor_tracker(
    name: str, sensors: Mapping[str, WornSensor], dimensions: BodyDimensions | None = None
) -> MultiSensorTracker:
    """Return a new tracker of a person by its name in ``MULTI_SENSOR_TRACKERS``.

    ``sensors``: by their names; more than the tracker needs are refused too, as nothing would
    become of their samples.  ``ConfigError`` if there is no such tracker, or the places do not fit.
    """
    entry = find_multi_sensor_tracker(name)
    places = [sensor.place for sensor in sensors.values()]
    if not accepts_placement(entry, places):
        needed = " and ".join(" or ".join(choices) for choices in entry.places)
        raise ConfigError(
            f"Tracker '{name}' needs one sensor each at {needed}; "
            f"this person has: {', '.join(places) or 'none'}."
        )
    return entry.make(sensors, dimensions or BodyDimensions())


def find_multi_sensor_tracker(name: str) -> MultiSensorTrackerEntry:
    """Return the line of ``MULTI_SENSOR_TRACKERS`` with this name, or raise ``ConfigError``."""
    for entry in MULTI_SENSOR_TRACKERS:
        if entry.name == name:
            return entry
    known = ", ".join(entry.name for entry in MULTI_SENSOR_TRACKERS)
    raise ConfigError(f"There is no tracker '{name}' of several sensors. Known trackers: {known}.")


def accepts_placement(entry: MultiSensorTrackerEntry, places: Iterable[str]) -> bool:
    """Return True if sensors at these places, one at each, are those that a tracker needs."""
    return any(
        all(is_worn_on(*pair) for pair in zip(order, entry.places, strict=True))
        for order in permutations(places)
        if len(order) == len(entry.places)
    )
