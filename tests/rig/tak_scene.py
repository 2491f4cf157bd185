"""Scene for a forwarder to TAK: a station's picture with people of whom a test changes what it
cares about.
"""

from __future__ import annotations

from typing import Any

import msgspec

from base_station.core.pipeline import StationPipeline
from base_station.storage.db.known_people import person_lookup
from base_station.views.station import StationFacts, snapshot
from base_station.views.units import unit_views
from base_station.views.wire import AlarmView, AnchorView, Delta, Snapshot, UnitView
from shared.messages.station import OpenIncident, SetAnchor
from tests.rig import message_factory
from tests.rig.station_script import Script

ANCHOR = AnchorView(52.5, 13.4, 40.0, 0.0)
T_MS = 1_700_000_000_000  # of the first position


class Scene:
    """Picture with an open incident and units at their starts."""

    def __init__(self, *unit_ids: str, anchor: bool = True, incident: bool = True) -> None:
        self.script = Script()
        if anchor:
            self.script.act(SetAnchor(ANCHOR.lat_deg, ANCHOR.lon_deg, ANCHOR.height_m, 0.0))
        if incident:
            self.script.act(OpenIncident("i1", "Kitchen"))
        for unit_id in unit_ids or ("FF-01",):
            self.script.register(unit_id)
            self.script.say(message_factory.position(self.script.header(unit_id)))

    @property
    def pipeline(self) -> StationPipeline:
        return self.script.pipeline

    def picture(self, **changes: Any) -> Snapshot:
        shown = snapshot(self.pipeline.state, 1, StationFacts(), person_lookup({}))
        return msgspec.structs.replace(shown, **changes)

    def unit(self, unit_id: str = "FF-01", **changes: Any) -> UnitView:
        state = self.pipeline.state
        (view,) = unit_views(state, [state.units[unit_id]], person_lookup({}))
        return msgspec.structs.replace(view, **changes)

    def moved(self, north_m: float, t_s: float, unit_id: str = "FF-01", **changes: Any) -> UnitView:
        """The unit's wearer so far north of the start, so long after it."""
        unit = self.unit(unit_id)
        assert unit.position is not None
        position = msgspec.structs.replace(
            unit.position, north_m=north_m, t_ms=unit.position.t_ms + round(1000 * t_s)
        )
        return msgspec.structs.replace(unit, position=position, **changes)


def delta(*units: UnitView, alarms: tuple[AlarmView, ...] = ()) -> Delta:
    return Delta(seq=2, now_ms=T_MS, units=units, alarms=alarms)


def alarm(
    unit_id: str = "FF-01", state: str = "raised", rule: str = "mayday", priority: int = 1
) -> AlarmView:
    return AlarmView(
        alarm_id=f"{rule}|{unit_id}|1",
        rule=rule,
        unit_id=unit_id,
        priority=priority,
        state=state,
        level=rule,
        text=f"{unit_id}: {rule}",
        by="",
        raised_ms=T_MS,
        last_raised_ms=T_MS,
        changed_ms=T_MS,
    )
