"""Views of a replay and of a gap in the record."""

from __future__ import annotations

from base_station.views.answer import Answer
from base_station.views.wire.text_code import TextCodeView


class GapView(Answer, frozen=True):
    """Time without records."""

    from_ms: int
    until_ms: int


class ReplayView(Answer, frozen=True):
    """State of a replay; absent when the console shows the live picture."""

    incident_id: str
    start_ms: int
    end_ms: int
    at_ms: int
    speed: float
    playing: bool
    seeking: bool = False  # on the way to ``at_ms``; the shown state is of another time
    flaws: tuple[str, ...] = ()  # reason why parts are not shown as recorded, in words
    flaw_codes: tuple[TextCodeView, ...] = ()  # of ``flaws``, in their order
    gap: GapView | None = None  # around its time: the shown state is of before
