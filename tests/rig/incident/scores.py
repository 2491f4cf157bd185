"""Error, uncertainty and smoothness of estimates of an incident's people, by stage."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from base_station.fusion.interface import Estimate
from tests.rig.incident.building import SteelBuilding
from tests.rig.incident.people import RATE_HZ, Truth

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]

CHI2_95_2DOF = 5.991
FOUND_S = 60.0  # of fixes, after which somebody who walks about outside should be found
LEFT_M = 1.0  # from the engine: standing where one is known to be is not scored
SETTLED_S = 30.0  # after coming out
ON_FLOOR_M = 0.3  # nearer than this to a storey: not on the stairs
SEAM_S = 20.0  # about the door
FAR_M = 4.0  # off: in another room
ASTRAY = {"outside of the region": 1.0, "of three times the region": 3.0}

ERROR_STAGES = ("outside", "10 min inside", "back out")
HELD_STAGES = ("outside", "at the door", "1 min", "5 min", "10 min inside", "back out")


def stages(truth: Truth) -> dict[str, Flags]:
    """Rows of each stage."""
    t_s, into_s, out_s = truth.t_s, truth.goes_in_s, truth.comes_out_s
    left = np.linalg.norm(truth.place_m[:, :2] - truth.place_m[0, :2], axis=1) > LEFT_M
    found_s = float(t_s[left.argmax()]) if truth.from_engine else FOUND_S
    return {
        "outside": (t_s >= found_s) & (t_s < into_s - 5.0),
        "at the door": np.abs(t_s - into_s) <= 5.0,
        "1 min": np.abs(t_s - into_s - 60.0) <= 10.0,
        "5 min": np.abs(t_s - into_s - 300.0) <= 10.0,
        "10 min inside": np.abs(t_s - into_s - 600.0) <= 15.0,
        "back out": t_s > out_s + SETTLED_S,
    }


def normalised2(estimate: Estimate, off_m: Floats) -> float:
    """Normalised square of an error (2,): chi-square with 2 degrees of freedom if stated right."""
    product = estimate.correlation_ne * estimate.std_north_m * estimate.std_east_m
    spread = np.array([[estimate.std_north_m**2, product], [product, estimate.std_east_m**2]])
    return float(off_m @ np.linalg.solve(spread, off_m))


@dataclass
class Scores:
    """Scores of one method, over all people."""

    errors_m: dict[str, list[Floats]] = field(
        default_factory=lambda: {stage: [] for stage in ERROR_STAGES}
    )
    held: dict[str, list[Flags]] = field(
        default_factory=lambda: {stage: [] for stage in HELD_STAGES}
    )
    seams_m: list[float] = field(default_factory=list)
    astray: dict[str, list[Flags]] = field(default_factory=lambda: {how: [] for how in ASTRAY})

    def note(self, truth: Truth, places_m: Floats, normalised2: Floats | None) -> None:
        """``places_m`` (n, 2); ``normalised2`` (n,) where a region is stated."""
        off_m = places_m - truth.place_m[:, :2]
        errors_m = np.linalg.norm(off_m, axis=1)
        for stage, rows in stages(truth).items():
            if stage in ERROR_STAGES:
                self.errors_m[stage].append(errors_m[rows])
            if normalised2 is not None:
                self.held[stage].append(normalised2[rows] < CHI2_95_2DOF)
        if normalised2 is not None:
            for how, times in ASTRAY.items():
                sure = normalised2 > times**2 * CHI2_95_2DOF
                self.astray[how].append((errors_m > FAR_M) & sure)
        self.seams_m.append(_seam_m(truth, off_m))

    def add(self, other: Scores) -> None:
        """Those of other people."""
        for stage, errors_m in other.errors_m.items():
            self.errors_m[stage] += errors_m
        for stage, held in other.held.items():
            self.held[stage] += held
        for how, astray in other.astray.items():
            self.astray[how] += astray
        self.seams_m += other.seams_m

    def ce_m(self, stage: str, percent: float) -> float:
        return float(np.percentile(np.concatenate(self.errors_m[stage]), percent))

    def held_95(self, stage: str) -> float:
        return float(np.concatenate(self.held[stage]).mean())

    def part_astray(self, how: str) -> float:
        """Part of the time with a large error outside the stated region."""
        return float(np.concatenate(self.astray[how]).mean())


@dataclass
class FloorScores:
    """Scores of floors, over all people inside who stand on a storey."""

    right: list[Flags] = field(default_factory=list)
    stated: list[Floats] = field(default_factory=list)

    def note(
        self, truth: Truth, building: SteelBuilding, floors: list[int | None], stated: Floats
    ) -> None:
        storeys = -truth.place_m[:, 2] / building.storey_m
        on_storey = np.abs(storeys - np.rint(storeys)) * building.storey_m < ON_FLOOR_M
        inside = (truth.t_s > truth.goes_in_s) & (truth.t_s < truth.comes_out_s)
        reported = np.array([-99 if floor is None else floor for floor in floors])
        rows = on_storey & inside
        self.right.append(reported[rows] == np.rint(storeys[rows]))
        self.stated.append(stated[rows])

    def add(self, other: FloorScores) -> None:
        """Those of other people."""
        self.right += other.right
        self.stated += other.stated

    def part_right(self) -> float:
        return float(np.concatenate(self.right).mean())

    def part_stated(self) -> float:
        return float(np.concatenate(self.stated).mean())


def _seam_m(truth: Truth, off_m: Floats) -> float:
    """The furthest that the estimate jumps within a second of coming out through the door."""
    rows = np.abs(truth.t_s - truth.comes_out_s) <= SEAM_S
    moved_m = off_m[rows][RATE_HZ:] - off_m[rows][:-RATE_HZ]
    return float(np.linalg.norm(moved_m, axis=1).max())
