"""Selection of a tracker for the sensors of a person, by their places and by what was set."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import combinations

from edge.body_places import FOOT, is_worn_on
from edge.samples import SensorDescription
from edge.tracker.choice.interface import Choice
from edge.tracker.choice.one_sensor import OneSensorTracker
from edge.tracker.interface import (
    BodyDimensions,
    MultiSensorTracker,
    MultiSensorTrackerEntry,
    TrackerEntry,
    WornSensor,
)
from edge.tracker.registry import (
    MULTI_SENSOR_TRACKERS,
    TRACKERS,
    accepts_placement,
    find_tracker,
    make_multi_sensor_tracker,
)
from shared.coded_text import CodedText, coded
from shared.errors import ConfigError

AUTO = "auto"  # by place, which is recognised by motion where it is not set
BY_PLACE = "by-place"  # as on a foot where it is not set
_ON_FOOT, _ELSEWHERE = "eskf", "body"  # of one sensor, where none was named

Sensors = Mapping[str, SensorDescription]  # by name; each says its place, empty where unknown


@dataclass(frozen=True, slots=True)
class TrackerSelection:
    """Tracker and the sensors that it tracks by."""

    tracker: str
    sensors: tuple[str, ...]
    notes: tuple[str, ...] = ()  # what does not fit, for a person

    def make(self, sensors: Sensors, dimensions: BodyDimensions) -> MultiSensorTracker:
        """Return a new tracker of this selection."""
        if self.tracker in _names_of_one():
            (name,) = self.sensors
            tracker = find_tracker(self.tracker).make(sensors[name])
            place = sensors[name].place
            return OneSensorTracker(tracker, name, place, dimensions.step_scales.get(place))
        worn = {name: WornSensor(sensors[name], sensors[name].place) for name in self.sensors}
        return make_multi_sensor_tracker(self.tracker, worn, dimensions)

    def choice(self, recognised: Mapping[str, str]) -> Choice:
        """Return what is to be known of it; ``recognised``: places that motion has shown."""
        return Choice(self.tracker, self.foot_sensor, dict(recognised), self.notes)

    @property
    def worn_on(self) -> str:
        """Place that a tracker of one sensor expects; empty for one of several sensors."""
        if self.tracker not in _names_of_one():
            return ""
        return find_tracker(self.tracker).worn_on[0]

    @property
    def foot_sensor(self) -> str | None:
        """Name of the sensor that has to be on a foot, for a tracker of one sensor."""
        if self.tracker not in _names_of_one() or FOOT not in find_tracker(self.tracker).worn_on:
            return None
        return self.sensors[0]


def select_automatically(sensors: Sensors, dimensions: BodyDimensions) -> TrackerSelection:
    """Return the tracker that makes the most of sensors at known places."""
    for count in range(len(sensors), 1, -1):
        for names in combinations(sensors, count):
            places = [sensors[name].place for name in names]
            for entry in MULTI_SENSOR_TRACKERS:
                if accepts_placement(entry, places):
                    return _select_several(entry, sensors, names, dimensions)
    on_foot = [name for name in sensors if is_worn_on(sensors[name].place, (FOOT,))]
    tracker = _ON_FOOT if on_foot else _ELSEWHERE
    name = next(iter(on_foot or sensors))
    return TrackerSelection(tracker, (name,), _unused(tracker, sensors, (name,)))


def select_named(tracker: str, sensors: Sensors, dimensions: BodyDimensions) -> TrackerSelection:
    """Return the tracker of this name with the sensors that fit it; where they do not fit, another
    one and a note that says so: a wearer is tracked all the same.

    Raises ConfigError for a name that is none.
    """
    if tracker in (AUTO, BY_PLACE):
        return select_automatically(with_places(sensors, {}), dimensions)
    if tracker in _names_of_one():
        return _select_one(find_tracker(tracker), sensors)
    entry = next((one for one in MULTI_SENSOR_TRACKERS if one.name == tracker), None)
    if entry is None:
        several = (one.name for one in MULTI_SENSOR_TRACKERS)
        known = (*_names_of_one(), *several, BY_PLACE, AUTO, "none")
        raise ConfigError(f"There is no tracker '{tracker}'. Known trackers: {', '.join(known)}.")
    for names in combinations(sensors, min(len(entry.places), len(sensors))):
        if accepts_placement(entry, [sensors[name].place for name in names]):
            return _select_several(entry, sensors, names, dimensions)
    instead = select_automatically(sensors, dimensions)
    needed = " and ".join(" or ".join(choices) for choices in entry.places)
    has = ", ".join(sensor.place or "an unknown place" for sensor in sensors.values())
    note = coded(
        "tracker-needs",
        "tracker {tracker} needs one sensor each at {needed}, and this unit has {has}: {instead} "
        "tracks instead",
        tracker=tracker,
        needed=needed,
        has=has,
        instead=instead.tracker,
    )
    return TrackerSelection(instead.tracker, instead.sensors, (note, *instead.notes))


def with_places(sensors: Sensors, places: Mapping[str, str]) -> dict[str, SensorDescription]:
    """Return the sensors, those at an unknown place where ``places`` has them, else on a foot."""
    return {
        name: sensor if sensor.place else replace(sensor, place=places.get(name, FOOT))
        for name, sensor in sensors.items()
    }


def _select_several(
    entry: MultiSensorTrackerEntry,
    sensors: Sensors,
    names: tuple[str, ...],
    dimensions: BodyDimensions,
) -> TrackerSelection:
    notes = _unused(entry.name, sensors, names)
    if _needs_leg_length(entry):
        notes = (*notes, *_leg_notes(entry.name, dimensions))
    return TrackerSelection(entry.name, names, notes)


def _select_one(entry: TrackerEntry, sensors: Sensors) -> TrackerSelection:
    """Return the sensor that is best for a tracker of one."""
    names = [
        name
        for part in entry.worn_on
        for name, sensor in sensors.items()
        if is_worn_on(sensor.place, (part,))
    ]
    unknown = [name for name, sensor in sensors.items() if not sensor.place]
    name = next(iter((*names, *unknown, *sensors)))
    notes = _unused(entry.name, sensors, (name,))
    place = sensors[name].place
    if place and name not in names:
        notes = (
            *notes,
            coded(
                "tracker-made-for",
                "tracker {tracker} is made for {places}, and the sensor is worn on {place}: set "
                "tracker to {auto}",
                tracker=entry.name,
                places=" or ".join(entry.worn_on),
                place=place,
                auto=AUTO,
            ),
        )
    if entry.by_compass and not sensors[name].mag_present:
        notes = (
            *notes,
            coded(
                "tracker-no-compass",
                "tracker {tracker} keeps its heading by the compass, and the sensor has no "
                "magnetometer: the heading drifts",
                tracker=entry.name,
            ),
        )
    return TrackerSelection(entry.name, (name,), notes)


def _unused(tracker: str, sensors: Sensors, used: tuple[str, ...]) -> tuple[str, ...]:
    unused = [name for name in sensors if name not in used]
    if not unused:
        return ()
    by = " and ".join(used)
    return (
        coded(
            "tracker-unused",
            "tracker {tracker} tracks by {used}; {unused} is recorded only",
            tracker=tracker,
            used=by,
            unused=" and ".join(unused),
        ),
    )


def _leg_notes(tracker: str, dimensions: BodyDimensions) -> Iterator[CodedText]:
    if dimensions.leg_length_m is not None and dimensions.is_leg_implausible:
        yield coded(
            "tracker-leg-implausible",
            "the leg length of {leg_m:.2f} m fits no person, or not the height that is set: "
            "tracker {tracker} takes one by the height, else a usual one; correct "
            "wearer.leg_length_m (hip joint to sole, in metres) or wearer.height_m",
            tracker=tracker,
            leg_m=dimensions.leg_length_m,
        )
    if dimensions.leg_length_m is None and dimensions.height_m is None:
        yield coded(
            "tracker-usual-leg",
            "tracker {tracker} takes a usual leg length, as none is set: distances are off by as "
            "much as that is; give wearer.leg_length_m or wearer.height_m",
            tracker=tracker,
        )


def _needs_leg_length(entry: MultiSensorTrackerEntry) -> bool:
    return any("shank" in choices for choices in entry.places)


def _names_of_one() -> tuple[str, ...]:
    return tuple(entry.name for entry in TRACKERS)
