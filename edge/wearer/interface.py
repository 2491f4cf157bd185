"""Interface of button drivers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from shared.clock import Clock
from shared.errors import MusterError


class ButtonError(MusterError):
    """A button cannot be read now; the text states why, and what to do."""


@dataclass(frozen=True, slots=True)
class ContactChange:
    """State of the button's contact from an instant on; bounce is not removed."""

    t_ns: int  # this machine's monotonic clock
    is_pressed: bool


class ButtonDriver(Protocol):
    """Driver of one button; called by one thread.

    ``open``, ``wait`` and ``read`` raise ButtonError or OSError where the button cannot be read; it
    is closed then, and opened again later.
    """

    def open(self) -> None: ...

    def wait(self, timeout_s: float) -> None:
        """Return when there is something to read, or after this time."""
        ...

    def read(self) -> tuple[ContactChange, ...]:
        """Return what came since, in order; never waits.  The first after ``open`` is the state
        that the button has by then.
        """
        ...

    def close(self) -> None:
        """May be called again, and where ``open`` has failed."""
        ...


@dataclass(frozen=True, slots=True)
class ButtonKind:
    """Kind of button, as written ``scheme:argument?option=value``."""

    scheme: str
    make: Callable[[str, dict[str, str], Clock], ButtonDriver]  # argument, options; ConfigError
    argument: str  # what stands after the colon, for help texts
