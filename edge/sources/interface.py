"""Interface of sample sources."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import Protocol, runtime_checkable

from edge.samples import OtherSample, SensorBatch, SensorDescription


@dataclass(frozen=True, slots=True)
class Outage:
    """Time during which a source's (simulated) radio is down, since the start."""

    start_s: float
    duration_s: float


class Source(Protocol):
    """Source of samples.

    ``batches`` yields in time order, as fast as the consumer asks; pacing to
    real time is the runtime's business.  A real driver blocks until it has samples.
    """

    @property
    def description(self) -> SensorDescription: ...

    @property
    def is_live(self) -> bool:
        """True for hardware of this machine, whose times are this machine's monotonic clock;
        false where the times are another clock's and are laid onto it: recordings, simulations,
        and what another unit sends.
        """
        ...

    @property
    def radio_outages(self) -> tuple[Outage, ...]: ...

    def batches(self) -> Iterator[SensorBatch]: ...

    def close(self) -> None: ...


@runtime_checkable
class HasSensors(Protocol):
    """Source of several sensors of one person, whose batches name theirs."""

    @property
    def sensors(self) -> Mapping[str, SensorDescription]:
        """Data sheets by the sensors' names, the first one first."""
        ...


def sensors_in(source: Source) -> Mapping[str, SensorDescription]:
    """Return the data sheets of a source's sensors by their names; an only one has the name ``""``
    where it was given none.
    """
    return source.sensors if isinstance(source, HasSensors) else {"": source.description}


class OfflineSource:
    """Base of sources that have no hardware: recordings, simulations, other units."""

    @property
    def is_live(self) -> bool:
        return False

    @property
    def radio_outages(self) -> tuple[Outage, ...]:
        return ()

    def close(self) -> None:
        """Nothing is held open between batches."""


@runtime_checkable
class ReportsFaults(Protocol):
    """Source that detects faults of its sensor, such as that it is not there."""

    def take_faults(self) -> tuple[str, ...]:
        """Return faults since the last call, a sentence each, for a person; from any thread."""
        ...


class AuxiliarySource(ReportsFaults, Protocol):
    """Source beside the main one, read by a thread of its own; its samples join the batches.

    Times are this machine's monotonic clock.  One that is silent, gone or talks nonsense delays
    nothing.
    """

    def start(self) -> None: ...

    def take(self) -> tuple[OtherSample, ...]:
        """Return what came since the last call; never waits."""
        ...

    def close(self) -> None: ...


class Quantity(StrEnum):
    """Quantity that a source may give beside acceleration and rotation."""

    MAGNETIC_FIELD = "magnetic field"
    PRESSURE = "pressure"
    SENSOR_TEMPERATURE = "temperature inside the sensor"
    AMBIENT_TEMPERATURE = "temperature around the equipment"
    BATTERY = "battery"
    FIX = "satellite fixes"
    SIGHTING = "sightings of beacons and tags"
    MAYDAY_BUTTON = "mayday button"
    ACKNOWLEDGE_BUTTON = "button that acknowledges"


@dataclass(frozen=True, slots=True)
class SourceKind:
    """Kind of source, as written ``scheme:argument``."""

    scheme: str
    make: Callable[[str], Source]  # from the text after the colon
    argument: str  # what stands after the colon, for help texts
    gives: frozenset[Quantity] = frozenset()  # at most; docs/concepts.md has the table
