"""Parts of a station that a forwarder uses, for tests that are about some of them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from base_station.forwarders.interface import Surroundings
from base_station.storage.db.known_people import person_lookup
from shared.clock import Clock


def surroundings(
    clock: Clock, leads: Callable[[], bool] = lambda: True, data: Path = Path()
) -> Surroundings:
    """Surroundings of a station with an empty log and people without names."""
    return Surroundings(
        clock=clock,
        leads=leads,
        data=data,
        people=person_lookup({}),
        read_log=lambda _: (),
        note_external=lambda *_: None,
    )
