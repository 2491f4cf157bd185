"""Smoothers, the first of which the station uses: whole trails from everything that is known.

To add one: write ``base_station/fusion/smoother/<name>.py`` with a frozen dataclass that has what
``Smoother`` asks for (see ``port``) and name it in ``SMOOTHERS``.  The suite
``tests/contracts/test_smoothers.py`` runs over every entry.
"""

from __future__ import annotations

from base_station.fusion.smoother.path_graph import PathGraph
from base_station.fusion.smoother.port import Smoother

SMOOTHERS: tuple[Smoother, ...] = (PathGraph(),)
