"""Fusers, of which the station uses the first unless its settings name another.

To add one: write ``base_station/fusion/<name>.py`` with a frozen dataclass that has what
``FuserKind`` asks for (see ``interface``), parameters as fields with their defaults, and name it in
``FUSERS``.  The suite ``tests/contracts/test_fusers.py`` runs over every entry.
"""

from __future__ import annotations

from base_station.fusion.gps_inertial import GpsInertial
from base_station.fusion.gps_switching import GpsSwitching
from base_station.fusion.interface import FuserKind

FUSERS: tuple[FuserKind, ...] = (GpsInertial(), GpsSwitching())


def fuser_named(name: str) -> FuserKind | None:
    """The fuser of that name; None where there is none."""
    return next((kind for kind in FUSERS if kind.name == name), None)
