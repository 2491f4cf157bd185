"""People whose units track them: their sensors are simulated, foot and all, and go through the
tracker that units run.

They are switched on while their wearers stand.  Four of six have calibrated sensors, two sensors
as a data sheet has them.  The truth is the foot's, as the walk is simulated: strides and all.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from shared.errors import UserError
from shared.messages import Position
from shared.published_walk import PublishedWalk, read_walk
from tests.rig import message_factory
from tests.rig.incident.building import SteelBuilding
from tests.rig.incident.people import LASTS_S, RATE_HZ, WALK_MPS, Script, Truth
from tests.rig.incident.walking import PersonWalk

Floats = NDArray[np.float64]

SWITCHED_ON_S = 5.0  # somebody stands
UNCALIBRATED = {2, 3}  # of six
RISER_M = 0.17
LEAST_M = 0.15  # a shorter move is none
LATE_S = 120.0  # people take longer than they were told to
HEADING_M = 8.0  # walked, which shows how the own frame is turned
PATIENCE_S = 600.0


def tracked_walks(
    rng: np.random.Generator, scripts: Sequence[Script], building: SteelBuilding
) -> list[PersonWalk]:
    """All as long as the shortest."""
    seed = int(rng.integers(2**31))
    with tempfile.TemporaryDirectory(prefix="muster-walks-") as name:
        folder = Path(name)
        for number, script in enumerate(scripts):
            (folder / f"{number}.toml").write_text(scenario_of(script, rng), encoding="utf-8")
        for uncalibrated in (False, True):
            numbers = [n for n in range(len(scripts)) if (n in UNCALIBRATED) == uncalibrated]
            _walk(folder, numbers, seed, uncalibrated=uncalibrated)
        walks = [read_walk(folder / f"{number}.csv") for number in range(len(scripts))]
    count = min(*(len(walk.t_s) for walk in walks), round((LASTS_S + LATE_S) * RATE_HZ))
    return [
        _walked(walk, script, building, count) for walk, script in zip(walks, scripts, strict=True)
    ]


def scenario_of(script: Script, rng: np.random.Generator) -> str:
    """As a scenario file of the simulator."""
    north_m, east_m, down_m = *script.begin_m, 0.0
    legs: list[dict[str, Any]] = [{"type": "stand", "duration_s": SWITCHED_ON_S}]
    for move in script.moves:
        to = [move.to_m[0], move.to_m[1]]
        way_m, rise_m = float(np.hypot(to[0] - north_m, to[1] - east_m)), down_m - move.to_m[2]
        if move.speed_mps == 0.0:
            legs.append({"type": "wait", "duration_s": move.lasts_s})
        elif rise_m:
            risers = max(1, round(abs(rise_m) / RISER_M))
            legs.append({"type": "stairs", "to": to, "rise_m": rise_m, "risers": risers})
        elif way_m > LEAST_M:
            pace = "walk" if move.speed_mps == WALK_MPS else "search"
            legs.append({"type": "walk", "to": [to], "pace": pace})
        else:
            continue
        north_m, east_m, down_m = move.to_m
    legs.append({"type": "wait", "duration_s": LATE_S})
    head = f"start = {json.dumps(list(script.begin_m))}\nheading_deg = {rng.uniform(0.0, 360.0)}\n"
    return head + "".join(f"[[legs]]\n{_table(leg)}" for leg in legs)


def _table(leg: dict[str, Any]) -> str:
    return "".join(f"{key} = {json.dumps(value)}\n" for key, value in leg.items())


def _walk(folder: Path, numbers: Sequence[int], seed: int, *, uncalibrated: bool) -> None:
    files = [str(folder / f"{number}.toml") for number in numbers]
    kind = ["--uncalibrated"] if uncalibrated else []
    how = ["--out", str(folder), "--seed", str(seed + numbers[0]), "--rate-hz", str(RATE_HZ)]
    command = [sys.executable, "-m", "tests.bench", "bench", "published", *files, *how, *kind]
    done = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE_S, check=False)
    if done.returncode:
        raise UserError(f"simulated walks could not be tracked: {done.stderr.strip()[-500:]}")


def _walked(walk: PublishedWalk, script: Script, building: SteelBuilding, count: int) -> PersonWalk:
    t_s, place_m = walk.t_s[:count], walk.truth_m[:count]
    inside = np.flatnonzero([building.depth_inside_m(n, e) > 0.0 for n, e in place_m[:, :2]])
    goes_in_s, comes_out_s = float(t_s[inside[0]]), float(t_s[inside[-1]])
    truth = Truth(t_s, place_m, script.from_engine, goes_in_s, comes_out_s)
    positions = [
        msgspec.structs.replace(
            position,
            header=msgspec.structs.replace(
                position.header, t_mono_ns=message_factory.mono_ns(at_s)
            ),
        )
        for position, at_s in zip(walk.positions[:count], t_s.tolist(), strict=True)
    ]
    return PersonWalk(truth, _turn_rad(truth, positions), positions)


def _turn_rad(truth: Truth, positions: Sequence[Position]) -> float:
    """Rotation of the own frame, by the first metres."""
    away_m = np.linalg.norm(truth.place_m[:, :2] - truth.place_m[0, :2], axis=1)
    until = int((away_m > HEADING_M).argmax()) + 1
    north_m, east_m = np.diff(truth.place_m[:until, :2], axis=0).T
    own = np.diff([complex(one.north_m, one.east_m) for one in positions[:until]])
    return float(np.angle(np.vdot(own, north_m + 1j * east_m)))
