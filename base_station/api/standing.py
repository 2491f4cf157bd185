"""What the API knows of this station's being one of two."""

from __future__ import annotations

from typing import Protocol

from base_station.views.wire import StandbyView


class Standing(Protocol):
    def view(self) -> StandbyView: ...

    def refusal(self) -> str | None:
        """Why nothing can be changed here, as a sentence; None: this station leads."""
        ...

    def take_over(self) -> None:
        """Soon."""
        ...
