"""Two real stations for a test."""

from __future__ import annotations

from contextlib import ExitStack
from pathlib import Path

from base_station.bench.standby.one_of_two import Place
from base_station.bench.standby.two_stations import TwoStations


def two_stations(folder: Path, places: tuple[Place, Place], closing: ExitStack) -> TwoStations:
    """They are ended with ``closing``, and what they said is shown with a test that fails."""
    two = TwoStations(folder, places, closing)
    closing.callback(lambda: print(two.first.said(), two.second.said(), sep="\n"))
    return two
