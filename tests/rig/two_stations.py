"""Two real stations for a test."""

from __future__ import annotations

from contextlib import ExitStack
from pathlib import Path

from tests.bench.standby.station_of_pair import Place
from tests.bench.standby.two_stations import TwoStations
from tests.rig.loaded_program import launch_loaded


def two_stations(folder: Path, places: tuple[Place, Place], closing: ExitStack) -> TwoStations:
    """They are ended with ``closing``, and what they said is shown with a test that fails."""
    two = TwoStations(folder, places, closing, launch_loaded)
    closing.callback(lambda: print(two.first.output(), two.second.output(), sep="\n"))
    return two
