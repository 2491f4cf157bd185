"""Foot trackers: the registry.  A new tracker is a file and a line here."""

from __future__ import annotations

from edge.samples import SensorDescription
from edge.tracker.eskf import EskfTracker
from edge.tracker.huang import HuangTracker
from edge.tracker.port import Tracker, TrackerEntry
from shared.errors import ConfigError

TRACKERS: tuple[TrackerEntry, ...] = (
    TrackerEntry("eskf", "error-state filter with stride-adaptive stance (default)", EskfTracker),
    TrackerEntry(
        "huang", "the thesis's method: pitch-rate stance, quasi-static resets", HuangTracker
    ),
)


def make_tracker(
    name: str, description: SensorDescription, beside: tuple[str, ...] = ()
) -> Tracker:
    """Return a new tracker by its name in ``TRACKERS``; ``ConfigError`` if there is none.

    ``beside``: what else the caller would have taken for a name.
    """
    for entry in TRACKERS:
        if entry.name == name:
            return entry.make(description)
    known = ", ".join((*(entry.name for entry in TRACKERS), *beside))
    raise ConfigError(f"There is no tracker '{name}'. Known trackers: {known}.")
