"""Operator actions about places: plan, anchor, references, pins and starts."""

from __future__ import annotations

import math
from collections.abc import Iterator

from base_station.core.events import ClosedIncidentChanged, PinsChanged, TrailBackfilled
from base_station.core.pins.incident_scope import concerns_closed_incident
from base_station.core.pins.pin_registry import PinAction, change_pins, units_of
from base_station.core.positioning.positioning import Positioning
from base_station.core.state import SiteState, StationState
from base_station.core.state.resolve_queue import request_resolve
from base_station.fusion.gnss.common_mode_error import CommonModeError
from base_station.fusion.interface import Start
from base_station.site.plan_reader import PlanReader
from shared.coded_text import coded
from shared.errors import UserError
from shared.geo import Anchor
from shared.messages.pins import PlaceBeacon, SetPin, StartTogether
from shared.messages.station import SetAnchor, SetPlan, SetReference, SetStart

PlaceChange = PinsChanged | ClosedIncidentChanged | TrailBackfilled


class PlaceActionHandler:
    """Applies operators' actions about places to the live state."""

    def __init__(self, positioning: Positioning, plans: PlanReader) -> None:
        self._positioning = positioning
        self._plans = plans

    def change_site(self, state: StationState, action: SetAnchor | SetPlan | SetReference) -> None:
        """Apply an anchor, a plan or the reference of a barometer."""
        site_id = state.site_id_of(action.incident_id)
        site = state.sites[site_id]
        if isinstance(action, SetAnchor):
            self._positioning.set_anchor(state, site_id, _checked_anchor(action))
        elif isinstance(action, SetReference):
            _require_finite(action.down_m)
            unit_id = state.registered_unit(action.unit_id).unit_id if action.unit_id else None
            site.barometers.set_reference(unit_id, action.down_m)
            site.common_mode_error = CommonModeError()
        else:
            site.plan = self._plans.plan(action.geojson)
            self._positioning.replace_map(state, site_id)
            for unit_id in sorted(set().union(*map(units_of, site.pins.values()))):
                request_resolve(state.late, unit_id, state.t_ns)  # one by one: live goes first

    def pin(self, state: StationState, by: str, action: PinAction) -> Iterator[PlaceChange]:
        """Apply a pin, a start of several people, a beacon or a meeting."""
        site_id = _site_of_place(state, action)
        is_first = site_id is not None and _is_first_known_place(state.sites[site_id])
        debriefed = [
            one.incident_id
            for one in state.incidents.values()
            if one.closed_ns is not None
            and concerns_closed_incident(state, one.site_id, action, one.closed_ns)
        ]
        changed = change_pins(state, by, action)
        yield from map(ClosedIncidentChanged, debriefed)
        if site_id is not None and is_first:
            moved = self._positioning.switch_to_plan_frame(state, site_id)
            yield from map(TrailBackfilled, sorted(moved))
            changed |= moved
        yield pins_changed(changed)

    def start(self, state: StationState, action: SetStart) -> Iterator[PlaceChange]:
        """Apply the position and heading at which the path of a unit starts."""
        unit = state.registered_unit(action.unit_id)
        _require_finite(action.north_m, action.east_m, action.down_m, action.heading_rad)
        _require_finite(action.std_m, action.heading_std_rad)
        if action.std_m < 0.0 or action.heading_std_rad < 0.0:
            raise UserError(
                coded(
                    "start-uncertainty-negative",
                    "a start needs uncertainties that are not negative",
                )
            )
        start = Start(
            action.north_m,
            action.east_m,
            action.down_m,
            action.heading_rad,
            action.std_m,
            action.heading_std_rad,
        )
        touched = {unit.unit_id}
        if _is_first_known_place(state.sites[unit.site_id]):
            touched |= self._positioning.switch_to_plan_frame(state, unit.site_id)
        self._positioning.start(state, unit, start)
        yield pins_changed(touched)
        yield from map(TrailBackfilled, sorted(touched))


def pins_changed(unit_ids: set[str]) -> PinsChanged:
    """Return the event that the pinned paths of units changed."""
    return PinsChanged(tuple(sorted(unit_ids)))


def _site_of_place(state: StationState, action: PinAction) -> str | None:
    """Site on which an action gives a place; None where it gives none."""
    match action:
        case SetPin():
            unit_ids: tuple[str, ...] = (action.unit_id,)
        case StartTogether():
            unit_ids = action.unit_ids[:1]
        case PlaceBeacon():
            return state.site_id_of(action.incident_id)
        case _:
            return None
    return next((state.units[one].site_id for one in unit_ids if one in state.units), None)


def _is_first_known_place(site: SiteState) -> bool:
    """True if a place reported now is the first one on a plan that has not been placed on the
    Earth: so far the positions of people there come from satellites alone.
    """
    pinned = any(pin.kind in {"place", "start"} for pin in site.pins.values())
    is_known = site.start_set or pinned or bool(site.beacons)
    return site.plan is not site.placed_plan and not is_known


def _checked_anchor(action: SetAnchor) -> Anchor:
    _require_finite(action.lat_deg, action.lon_deg, action.height_m, action.plan_rotation_rad)
    if abs(action.lat_deg) > 90.0 or abs(action.lon_deg) > 180.0:
        raise UserError(
            coded(
                "anchor-no-place",
                "{lat_deg}, {lon_deg} is no latitude and longitude",
                lat_deg=action.lat_deg,
                lon_deg=action.lon_deg,
            )
        )
    return Anchor(action.lat_deg, action.lon_deg, action.height_m, action.plan_rotation_rad)


def _require_finite(*values: float) -> None:
    if not all(math.isfinite(value) for value in values):
        raise UserError(coded("number-not-finite", "a coordinate or angle is no finite number"))
