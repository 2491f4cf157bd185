"""The calibration that a simulated unit would have been given before it was worn."""

from __future__ import annotations

from datetime import UTC, datetime

import numpy as np

from edge.calibration.model import Calibration
from edge.calibration.procedure import solve, take
from edge.calibration.steps import PosesStep, StillStep, TurningStep, WarmUpStep
from edge.simulation.handled_unit import EDGES, SIDES, HandledUnit, cut
from edge.simulation.simulation import Simulation

_MADE = datetime(2026, 1, 1, tzinfo=UTC)


def calibration_of(simulation: Simulation) -> Calibration:
    """Handle the walk's own unit by the book: the same errors, found as a person would."""
    unit = HandledUnit(worn_in=simulation)
    still, poses, turning, warm_up = StillStep(), PosesStep(), TurningStep(), WarmUpStep()
    take(still, cut(iter((unit.rest(14.0),))))
    take(poses, cut(unit.poses(np.vstack((SIDES, EDGES)))))
    take(turning, cut(unit.turning(45)))
    take(warm_up, cut(unit.warm_up(400.0)))
    return solve((still, poses, turning, warm_up), "", simulation.description.name, _MADE)
