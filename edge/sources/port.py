"""The port every sample source implements."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

from edge.samples import OtherSample, SensorBatch, SensorDescription


@dataclass(frozen=True, slots=True)
class Outage:
    """A time during which a source's (simulated) radio is down, since the start."""

    start_s: float
    duration_s: float


class Source(Protocol):
    """Where samples come from.

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


class Played:
    """What holds of sources that have no hardware: recordings, simulations, other units."""

    @property
    def is_live(self) -> bool:
        return False

    @property
    def radio_outages(self) -> tuple[Outage, ...]:
        return ()

    def close(self) -> None:
        """Nothing is held open between batches."""


@runtime_checkable
class TellsFaults(Protocol):
    """A source that knows what is wrong with its sensor, such as that it is not there."""

    def take_faults(self) -> tuple[str, ...]:
        """What a person must hear since the last call, a sentence each; from any thread."""
        ...


class Beside(TellsFaults, Protocol):
    """What is read beside a source, by a thread of its own, and put into its batches.

    Times are this machine's monotonic clock.  One that is silent, gone or talks nonsense delays
    nothing.
    """

    def start(self) -> None: ...

    def take(self) -> tuple[OtherSample, ...]:
        """What came since the last call; never waits."""
        ...

    def close(self) -> None: ...


@dataclass(frozen=True, slots=True)
class SourceKind:
    """One kind of source, as written ``scheme:argument``."""

    scheme: str
    make: Callable[[str], Source]  # from the text after the colon
    argument: str  # what stands after the colon, for help texts
