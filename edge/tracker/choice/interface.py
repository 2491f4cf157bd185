"""Choice of a tracker, as those who use the tracker may ask for it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Protocol, runtime_checkable


@dataclass(frozen=True, slots=True)
class Choice:
    """Tracker that was chosen, and why."""

    tracker: str  # its name
    foot_sensor: str | None = None  # name of the sensor that it needs on a foot; None: of none
    recognised: Mapping[str, str] = field(default_factory=dict)  # places, by sensor, by motion
    notes: tuple[str, ...] = ()  # what does not fit, for a person


@runtime_checkable
class ChoosesTracker(Protocol):
    """Tracker that chooses itself which one it is."""

    @property
    def choice(self) -> Choice | None:
        """None: it is not made yet."""
        ...
