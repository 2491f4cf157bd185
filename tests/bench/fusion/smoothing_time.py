"""Time to smooth an hour of ten units, and to solve one of them again with a pin."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from rich.console import Console
from rich.progress import track as progress_bar

from base_station.fusion.odometry.path_history import PathHistory
from base_station.fusion.odometry.points import RESTART, PathArrays
from base_station.fusion.smoothing.interface import PositionConstraint, Smoother, UnitEvidence
from shared.clock import NS_PER_S
from tests.bench.fusion.simulated_walks import RATE_HZ, Receiver, Walk
from tests.rig.incident.people import LASTS_S

UNITS, HOUR_S, OUTSIDE_S = 10, 3600.0, 180.0


def times_s(smoother: Smoother, seed: int, stays: Mapping[str, UnitEvidence]) -> dict[str, float]:
    """CPU seconds; ``stays``: of people in a building whose walls are known."""
    wandering = {
        str(number): UnitEvidence(_wandered(seed + number).arrays(), None)
        for number in progress_bar(
            range(UNITS), description="An hour", console=Console(stderr=True), transient=True
        )
    }
    path = wandering["0"].path
    row = len(path) // 2
    north_m, east_m = path.own_m[row].tolist()
    pin = PositionConstraint("pin", int(path.t_ns[row]), north_m, east_m, 5.0)
    pinned = {"0": replace(wandering["0"], places=(pin,))}
    units = list(stays.values())
    walled = {str(number): _an_hour_of(units[number % len(units)]) for number in range(UNITS)}
    begun_s = [time.thread_time()]
    for solve, evidence in (
        (smoother.smooth, wandering),
        (smoother.smooth, walled),
        (smoother.solve, pinned),
    ):
        solve(evidence)
        begun_s.append(time.thread_time())
    names = "hour", "hour among walls", "pin"
    return dict(zip(names, np.diff(begun_s).tolist(), strict=True))


def _wandered(seed: int) -> PathHistory:
    rng = np.random.default_rng(seed)
    walk, receiver, history = Walk.wander(rng, HOUR_S), Receiver(rng), PathHistory()
    for row in range(len(walk)):
        position = walk.position(row)
        t_ns, t_s = position.header.t_mono_ns, float(walk.t_s[row])
        history.append(position, t_ns, jumped=False)
        if row % RATE_HZ == 0 and t_s < OUTSIDE_S:
            history.fix(receiver.fix(t_s, walk.truth_m[row]), t_ns)
    return history


def _an_hour_of(stay: UnitEvidence) -> UnitEvidence:
    """One incident's path, again and again for an hour: each time the unit starts anew."""
    columns: dict[str, list[Any]] = {name: [] for name in PathArrays.__dataclass_fields__}
    for again in range(round(HOUR_S / LASTS_S)):
        later_ns = round(again * LASTS_S * NS_PER_S)
        for name, parts in columns.items():
            part = getattr(stay.path, name).copy()
            if name.endswith("t_ns"):
                part += later_ns
            elif name == "flags" and again:
                part[0] |= RESTART
            parts.append(part)
    return replace(stay, path=PathArrays(**{k: np.concatenate(v) for k, v in columns.items()}))
