"""Registry of trackers.  A new tracker is a file and a line here."""

from __future__ import annotations

from functools import partial

from edge.samples import ImuBatch, SensorDescription
from edge.tracker.body.tracker import BodyTracker
from edge.tracker.foot.eskf import EskfTracker
from edge.tracker.foot.output.track_rows import empty_rows
from edge.tracker.hip.state import HipConfig
from edge.tracker.hip.tracker import HipTracker
from edge.tracker.huang.tracker import HuangTracker
from edge.tracker.interface import TrackBatch, Tracker, TrackerEntry
from edge.tracker.waist.tracker import WaistTracker
from shared.earth_field import EarthField
from shared.errors import ConfigError


class NoTracker:
    """Tracker of a unit too weak to track: no rows.  Its tracking agent computes the positions.

    Not in ``TRACKERS``, as it keeps none of their promises.
    """

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
    ),
    TrackerEntry(
        "hip", "velocity of a hip, by a model within each step", HipTracker, ("hip", "waist")
    ),
    TrackerEntry(
        "hip-corridors",
        "the same; assumes straight corridors that meet at right angles",
        partial(HipTracker, config=HipConfig(straight_walks=True, right_angles=True)),
        ("hip", "waist"),
    ),
    TrackerEntry(
        "body",
        "steps of a sensor anywhere but on a foot, with stated errors",
        BodyTracker,
        ("hip", "chest", "waist", "pocket"),
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
