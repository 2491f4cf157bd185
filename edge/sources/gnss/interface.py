"""Interface of receiver dialects: lines into fixes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from edge.samples import GpsSample
from edge.sources.transport.address import TransportAddress
from edge.sources.transport.connection import Connection

MOST_SATELLITES = 255  # more than there are in the sky: what says more is damaged


@dataclass(frozen=True, slots=True)
class Report:
    """Report of one instant: ``fix.t_ns`` is when its first byte came."""

    fix: GpsSample
    of_day_ns: int | None  # UTC since midnight, as the receiver has it; None: it does not say


class Dialect(Protocol):
    """Language of a receiver.  Called by one thread."""

    @property
    def place(self) -> TransportAddress: ...

    @property
    def latency_s(self) -> float:
        """Delay from the instant of a fix to its first byte, where everything is quickest."""
        ...

    @property
    def longest(self) -> int:
        """Longest line in bytes."""
        ...

    @property
    def hint(self) -> str:
        """Hint of what to check where its lines cannot be understood."""
        ...

    @property
    def title(self) -> str:
        """Name of the receiver, for a person."""
        ...

    def __str__(self) -> str:
        """Return the same, for a log."""
        ...

    def open(self) -> Connection:
        """Open a connection on which it sends; a half-read line is forgotten.  Raises OSError."""
        ...

    def parse_line(self, line: bytes, began_ns: int) -> tuple[Report, ...]:
        """Return the reports that are complete with a line that began to come at ``began_ns``.

        Raises WireError for a line that is no report of a receiver.
        """
        ...

    def end_of_burst(self) -> tuple[Report, ...]:
        """Return the reports that are complete because nothing more has come for half a second."""
        ...

    def silence_reason(self) -> str:
        """Return why the line is open and there have been no reports, as far as known; empty: no
        reason is known.
        """
        ...


@dataclass(frozen=True, slots=True)
class ReceiverKind:
    """Kind of receiver, as written ``scheme:argument``."""

    scheme: str
    make: Callable[[str], Dialect]  # from the text after the colon; raises ConfigError
    argument: str  # what stands after the colon, for help texts
