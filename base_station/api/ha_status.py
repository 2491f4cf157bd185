"""State of a pair of stations, as the API needs it."""

from __future__ import annotations

from typing import Protocol

from base_station.views.wire import StandbyView


class HaStatus(Protocol):
    def view(self) -> StandbyView: ...

    def refusal(self) -> str | None:
        """Sentence with the reason why nothing can be changed here; None if this station leads."""
        ...

    def take_over(self) -> None:
        """Ask this station to lead; it does so shortly after."""
        ...
