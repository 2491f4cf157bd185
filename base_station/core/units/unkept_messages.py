"""Messages that units could not store in their journals: those that the link lost too are in no
log.
"""

from __future__ import annotations

from base_station.core.state import StationState
from shared.coded_text import coded


def unkept_problem(state: StationState) -> str:
    """Problem as a sentence for a person; empty: every unit has kept all its messages."""
    beats = ((unit.name, unit.heartbeat) for unit in state.units.values())
    counts = {name: beat.never_saved + beat.given_up for name, beat in beats if beat is not None}
    numbers = ", ".join(f"{name} {count}" for name, count in counts.items() if count)
    if not numbers:
        return ""
    return coded(
        "messages-not-kept",
        "Messages that a unit's journal had no room for, since the unit started: {counts}. Where "
        "the link lost them too they are gone: free or replace the unit's disk",
        counts=numbers,
    )
