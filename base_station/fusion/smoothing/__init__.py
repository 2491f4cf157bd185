"""Smoothers, the first of which the station uses: whole trails from everything that is known.

To add one: write ``base_station/fusion/smoothing/<name>.py`` with a frozen dataclass that has what
``Smoother`` asks for (see ``interface``) and name it in ``SMOOTHERS``.  The suite
``tests/contracts/test_smoothers.py`` runs over every entry.
"""

from __future__ import annotations

from base_station.fusion.smoothing.interface import Smoother
from base_station.fusion.smoothing.path_graph import PathGraph

SMOOTHERS: tuple[Smoother, ...] = (PathGraph(),)
