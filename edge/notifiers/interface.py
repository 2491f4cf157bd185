"""Interface of outputs that notify the wearer."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from threading import Event
from typing import Protocol

from edge.notifiers.signals import Notice


class Notifier(Protocol):
    """Output of one kind; each is used by one thread."""

    def play(self, notice: Notice, interrupt: Event) -> None:
        """Play the notice once and return at its end, or soon after ``interrupt`` is set.

        Raises OSError where the output does not work.
        """
        ...

    def close(self) -> None:
        """Leave the output dark and silent; may be called where nothing was played."""
        ...


@dataclass(frozen=True, slots=True)
class NotifierKind:
    """Kind of output, as written ``scheme:argument``."""

    scheme: str
    make: Callable[[str, Path], Notifier]  # argument, where sysfs is mounted; raises ConfigError
    argument: str  # what stands after the colon, for help texts
    is_audible: bool = True
