"""Units that walk a round together, with paths that turn away from it, each in its own frame."""

from __future__ import annotations

import math

from base_station.core.state.trail import TrailStep
from shared.messages.pins import SetPin
from shared.messages.station import OpenIncident, SetStart
from tests.rig.published_path import DeadReckoning
from tests.rig.station_script import Script

DRIFT_RADPS = 1e-3
ROUND_M = 160.0
PLAN = (
    b'{"type":"FeatureCollection","muster":{"frame":"site-m","floors":[{"floor":0,"down_m":0},'
    b'{"floor":1,"down_m":-3.2}]},"features":[{"type":"Feature","properties":{"kind":"outline"},'
    b'"geometry":{"type":"Polygon","coordinates":[[[0,0],[40,0],[40,30],[0,30],[0,0]]]}}]}'
)


def truth(second: float) -> tuple[float, float]:
    """A circle, walked at 1 m/s: a path that shows nothing of a building's walls."""
    radius_m = ROUND_M / math.tau
    angle = second / radius_m
    return radius_m * math.sin(angle), radius_m * (1.0 - math.cos(angle))


class Walk:
    """The units, the script of what the station hears of them, and how far off it is."""

    def __init__(self, *unit_ids: str, turn_rad: float = 0.0, script: Script | None = None) -> None:
        self.script = script or Script()
        self.script.register(*unit_ids)
        self.script.act(OpenIncident("i1", "Mill Lane"))
        self.units = unit_ids
        self.turn_rad = turn_rad
        self.own = {unit_id: DeadReckoning() for unit_id in unit_ids}
        self.walked_s = 0

    def go(self, seconds: int, silent: tuple[str, ...] = ()) -> None:
        for _ in range(seconds):
            self.script.now_s += 1.0
            self.walked_s += 1
            before, after = truth(self.walked_s - 1), truth(self.walked_s)
            north_m, east_m = after[0] - before[0], after[1] - before[1]
            for number, unit_id in enumerate(self.units):
                off_rad = self.turn_rad + (-1) ** number * DRIFT_RADPS * self.walked_s
                own = self.own[unit_id]
                own.step(north_m, east_m, off_rad)
                if unit_id not in silent:
                    self.script.position(unit_id, *own.place_m, distance_m=float(self.walked_s))

    def start(self, unit_id: str, heading_std_rad: float = 0.05) -> None:
        self.script.act(SetStart(unit_id, 0.0, 0.0, 0.0, -self.turn_rad, 0.5, heading_std_rad))

    def pin(self, pin_id: str, unit_id: str, second: float, off_m: float = 0.0) -> list[object]:
        north_m, east_m = truth(second)
        t_ns = self.script.t_ns - round((self.walked_s - second) * 1e9)
        pin = SetPin(pin_id, unit_id, t_ns, north_m + off_m, east_m, 0.5, None, None, 0.0, "")
        return list(self.script.act(pin))

    def trail(self, unit_id: str) -> list[TrailStep]:
        return self.script.pipeline.state.units[unit_id].trails.shown

    def worst_m(self, unit_id: str, begin_s: float = 0.0, end_s: float = math.inf) -> float:
        begin_ns = self.script.t_ns - self.walked_s * 10**9
        apart = [0.0]
        for step in self.trail(unit_id):
            second = (step.t_ns - begin_ns) / 1e9
            if begin_s <= second <= end_s:
                apart.append(math.dist((step.north_m, step.east_m), truth(second)))
        return max(apart)

    def state(self, pin_id: str) -> str:
        return self.script.pipeline.state.site.pin_verdicts[pin_id].state

    def now_off_m(self, unit_id: str) -> float:
        fused = self.script.pipeline.state.units[unit_id].place.fused
        assert fused is not None
        return math.dist((fused.north_m, fused.east_m), truth(self.walked_s))


def walk_from_the_engine() -> Walk:
    """Walk of one unit with a reported start, of five minutes."""
    walk = Walk("FF-01")
    walk.start("FF-01")
    walk.go(300)
    return walk
