"""Assessment of one unit by tracks that a test states."""

from __future__ import annotations

from collections.abc import Sequence

from base_station.core.state import StationState
from base_station.core.state.pin import Pin
from base_station.fusion.smoothing.interface import Verdict
from base_station.replay.assessment.report import UnitReport, assess
from base_station.storage.db.records import TrackSample
from shared.clock import NS_PER_S


def shown(t_s: float, north_m: float = 0.0, east_m: float = 0.0, floor: int = 0) -> TrackSample:
    t_ns = round(t_s * NS_PER_S)
    return TrackSample(t_ns, north_m, east_m, 0.0, 1.0, 1.0, 1.0, 0.0, floor, "good")


def assessed(
    live: Sequence[TrackSample], smoothed: Sequence[TrackSample] = (), *pins: Pin
) -> UnitReport:
    state = StationState()
    state.site.pins.update({pin.pin_id: pin for pin in pins})
    verdicts = {pin.pin_id: Verdict(True, 0.5, 0.4) for pin in pins}
    raw = {"FF-01": smoothed}
    (unit,) = assess(
        "i1", "path-graph", 0, state, verdicts, {"FF-01": live}, {"FF-01": smoothed}, raw
    ).units
    return unit


def pin(t_s: float, north_m: float) -> Pin:
    t_ns = round(t_s * NS_PER_S)
    return Pin("p1", "place", "FF-01", t_ns, 0.5, 0, "chief", "", north_m, 0.0, 1)
