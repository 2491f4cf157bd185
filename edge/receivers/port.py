"""The port of receivers' languages: what is said, line by line, made into fixes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from edge.samples import GpsSample
from edge.sources.line import Line
from edge.sources.line_place import LinePlace

MOST_SATELLITES = 255  # more than there are in the sky: what says more is damaged


@dataclass(frozen=True, slots=True)
class Report:
    """What a receiver says of one instant: ``fix.t_ns`` is when its first word of it came."""

    fix: GpsSample
    of_day_ns: int | None  # UTC since midnight, as the receiver has it; None: it does not say


class Dialect(Protocol):
    """One receiver's language.  Called by one thread."""

    @property
    def place(self) -> LinePlace: ...

    @property
    def latency_s(self) -> float:
        """From the instant of a fix to its first word, where everything is quickest."""
        ...

    @property
    def longest(self) -> int:
        """Bytes of a line."""
        ...

    @property
    def hint(self) -> str:
        """What to look at where its lines cannot be understood."""
        ...

    def __str__(self) -> str:
        """Which receiver, for a person."""
        ...

    def open(self) -> Line:
        """A line on which it speaks; what was half said is forgotten.  Raises OSError."""
        ...

    def hear(self, line: bytes, began_ns: int) -> tuple[Report, ...]:
        """What is whole with a line that began to come at ``began_ns``.

        Raises WireError for what it cannot have said.
        """
        ...

    def pause(self) -> tuple[Report, ...]:
        """What is whole because nothing more has come for half a second."""
        ...

    def why_nothing(self) -> str:
        """Why the line is open and there have been no reports, as far as it is understood; empty:
        what came gives no reason.
        """
        ...


@dataclass(frozen=True, slots=True)
class ReceiverKind:
    """One kind of receiver, as written ``scheme:argument``."""

    scheme: str
    make: Callable[[str], Dialect]  # from the text after the colon; raises ConfigError
    argument: str  # what stands after the colon, for help texts
