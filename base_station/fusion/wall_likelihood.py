"""Likelihood of a step on a plan: crossed walls, room beside walls, stairs; for particle filter and
smoother.
"""

from __future__ import annotations

THROUGH_WALL = 0.02  # the remaining likelihood of a crossing: plans lack doors
OFF_FLOOR = 0.02  # the same of a step outside of the building above the ground floor
BESIDE_WALL = 0.5  # the same where there is no room for half a body
OFF_STAIRS = 0.2  # the same where the path climbs and the plan has stairs elsewhere
CLIMBS = 0.25  # rise over way from which a path climbs
UNSEEN_M = 3.0  # after a gap as long as this the corners of the way are unknown
