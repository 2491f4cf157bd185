"""Published positions of a walk whose truth is known, as a CSV that people can read too."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from shared.clock import NS_PER_S
from shared.messages import Header, Position
from shared.out_file import whole
from shared.quality import Quality, Reason

Floats = NDArray[np.float64]

TRUTH = ("t_s", "true_north_m", "true_east_m", "true_down_m")
FIGURES = (
    "north_m", "east_m", "down_m", "velocity_north_mps", "velocity_east_mps", "velocity_down_mps",
    "std_north_m", "std_east_m", "std_down_m", "correlation_ne", "heading_rad", "heading_std_rad",
    "distance_m",
)  # fmt: skip
FLAGS = ("stationary", "quality", "reasons")


@dataclass(frozen=True)
class PublishedWalk:
    """Times since the first position."""

    t_s: Floats  # (n,)
    truth_m: Floats  # (n, 3) north, east, down in a frame of the truth's own
    positions: Sequence[Position]  # (n,) without unit and pressure


def write_walk(path: Path, walk: PublishedWalk) -> None:
    published = [[float(getattr(one, name)) for name in FIGURES + FLAGS] for one in walk.positions]
    table = np.column_stack((walk.t_s, walk.truth_m, published))
    form = ["%.3f", *["%.4f"] * (len(TRUTH) - 1 + len(FIGURES)), *["%d"] * len(FLAGS)]
    header = ",".join(TRUTH + FIGURES + FLAGS)
    with whole(path) as making:
        np.savetxt(making, table, form, delimiter=",", header=header, comments="")


def read_walk(path: Path) -> PublishedWalk:
    """Walk in a file of ``write_walk``."""
    table = np.loadtxt(path, delimiter=",", skiprows=1, ndmin=2)
    figures = table[:, len(TRUTH) : len(TRUTH) + len(FIGURES)].tolist()
    flags = table[:, len(TRUTH) + len(FIGURES) :].astype(np.int64).tolist()
    positions = [
        Position(
            header=Header("", 1, row + 1, round(t_s * NS_PER_S)),
            pressure_pa=None,
            stationary=bool(flags[row][0]),
            quality=Quality(flags[row][1]),
            reasons=Reason(flags[row][2]),
            **dict(zip(FIGURES, figures[row], strict=True)),
        )
        for row, t_s in enumerate(table[:, 0].tolist())
    ]
    return PublishedWalk(table[:, 0], table[:, 1 : len(TRUTH)], positions)
