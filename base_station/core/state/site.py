"""Site: ground on which people work, with its frame, plan, pins and floors."""

from __future__ import annotations

import msgspec

from base_station.core.state.pin import Beacon, Pin, PinVerdict
from base_station.fusion.building_model.building import LearntBuilding
from base_station.fusion.gnss.common_mode_error import CommonModeError
from base_station.fusion.vertical.weather import Barometers
from base_station.site.learnt_floors import LearntFloors
from base_station.site.plan import Plan
from base_station.site.storeys import Storey
from shared.geo import Anchor

OWN_SITE_ID = ""  # of the station's own site: there is always one


class SiteState(msgspec.Struct):
    """Plan, incident frame, pins and floors; positions of its units are in its frame."""

    plan: Plan | None = None
    anchor: Anchor | None = None
    anchor_by_gps: bool = False  # no person placed the frame; the first good fix did
    fixes_anchor: Anchor | None = None  # as it was when a fix was taken last
    far_fixes: int = 0  # in a row, too far from there to be of this site
    common_mode_error: CommonModeError = msgspec.field(default_factory=CommonModeError)
    barometers: Barometers = msgspec.field(default_factory=Barometers)
    start_set: bool = False  # a person set where a unit began
    pins: dict[str, Pin] = msgspec.field(default_factory=dict)  # in the order of setting
    pin_verdicts: dict[str, PinVerdict] = msgspec.field(default_factory=dict)
    beacons: dict[str, Beacon] = msgspec.field(default_factory=dict)
    sighting_solved_ns: int = 0  # when a sighting was last solved at once
    learnt_building: LearntBuilding = LearntBuilding()
    learnt_floors: LearntFloors = msgspec.field(default_factory=LearntFloors)

    @property
    def placed_plan(self) -> Plan | None:
        """Plan; None also where its position in the incident frame is unknown, because the first
        fix defined that frame.
        """
        return None if self.anchor_by_gps else self.plan

    def storeys_at(self, north_m: float, east_m: float) -> tuple[Storey, ...]:
        """Storeys of the building there, lowest first: the plan's, or else the learnt ones."""
        if self.plan is not None and self.plan.storeys:
            return self.plan.storeys
        return self.learnt_floors.storeys_at(north_m, east_m)
