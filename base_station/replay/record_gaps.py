"""Stretches of the past of which the log has no record: links and positions age in them as they
would have live, and nothing is decided.
"""

from __future__ import annotations

from dataclasses import dataclass

from base_station.core.events import Output, UnitChanged
from base_station.core.pipeline import StationPipeline
from shared.clock import NS_PER_S

LONGEST_NS = 5 * NS_PER_S  # between two records: the station's tick is recorded once a second


@dataclass(frozen=True)
class RecordGap:
    from_ns: int  # of the last record before it; 0: there is none
    until_ns: int | None  # of the first record behind it; None: there is none


class UnrecordedTime:
    """Ages the picture of a pipeline, and takes that back before the next record is stepped: later
    decisions are made from the same state as live.
    """

    def __init__(self, pipeline: StationPipeline) -> None:
        self._pipeline = pipeline
        state = pipeline.state
        self._t_ns = state.t_ns
        self._shown = {name: (unit.link, unit.place.reach) for name, unit in state.units.items()}

    def advance_time(self, t_ns: int) -> list[Output]:
        return self._pipeline.advance_time(t_ns)

    def roll_back(self) -> list[Output]:
        state = self._pipeline.state
        state.t_ns = self._t_ns
        for name, (link, reach) in self._shown.items():
            state.units[name].link, state.units[name].place.reach = link, reach
        return [UnitChanged(name) for name in self._shown]
