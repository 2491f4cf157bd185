"""Fusers, the first of which the station uses.

To add one: write ``base_station/fusion/<name>.py`` with a frozen dataclass that has what
``FuserKind`` asks for (see ``interface``), parameters as fields with their defaults, and name it in
``FUSERS``.  The suite ``tests/contracts/test_fusers.py`` runs over every entry.
"""

from __future__ import annotations

from base_station.fusion.gps_inertial import GpsInertial
from base_station.fusion.interface import FuserKind

FUSERS: tuple[FuserKind, ...] = (GpsInertial(),)
