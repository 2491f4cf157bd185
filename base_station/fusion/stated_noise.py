"""Process noise that a unit states of its own path, in the parameters of fusers and smoothers.

The noise that these have from the beginning is that of a foot, and is kept for all that a unit does
not state.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, TypeVar

from shared.path_noise import PathNoise

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

    Parameters = TypeVar("Parameters", bound=DataclassInstance)

# Beyond these a path says nothing of the way, and equations become too stiff to solve.
MOST_SCALE_STD = 0.5
MOST_WALK_M_PER_SQRT_M = 3.0
MOST_TURN_RAD_PER_SQRT_M = 0.5


def with_path_noise(parameters: Parameters, noise: PathNoise | None) -> Parameters:
    """Return parameters with the fields ``scale_std``, ``walk_m_per_sqrt_m`` and
    ``turn_rad_per_sqrt_m`` as stated.
    """
    if noise is None:
        return parameters
    stated = {
        "scale_std": (noise.scale_std, MOST_SCALE_STD),
        "walk_m_per_sqrt_m": (noise.place_std_m_per_sqrt_m, MOST_WALK_M_PER_SQRT_M),
        "turn_rad_per_sqrt_m": (noise.turn_std_rad_per_sqrt_m, MOST_TURN_RAD_PER_SQRT_M),
    }
    changes = {name: min(std, most) for name, (std, most) in stated.items() if std is not None}
    return replace(parameters, **changes)
