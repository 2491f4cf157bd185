"""Descriptions of fields about positions, pins and beacons."""

from __future__ import annotations

from collections.abc import Mapping

FIELDS: Mapping[str, str] = {
    # ---- pins and beacons
    "Reference.unit_id": "The unit whose barometer stays where it is; empty: none.",
    "other_unit_id": "The unit of the other person of the meeting.",
    "PinView.by": "Who set it; the unit's id where the unit itself saw a beacon or tag.",
    "BeaconForm.incident_id": "The open incident on whose site it hangs; null: the only open one, "
    "or the station's own site where none is open.",
    "Reference.incident_id": "The open incident of whose site it is; null: as for a beacon.",
    "PinForm.t_ms": "When the wearer was there; left out: now, or as before.",
    "MeetingForm.t_ms": "When they met; left out: now.",
    "StartForm.t_ms": "When they were there together; 0: where each unit's path begins.",
    "PinView.t_ms": "When the wearer was there; 0: where the unit's path begins.",
    "PinView.kind": "place, start, meeting, beacon or tag.",
    "pin_id": "The pin's id.",
    "beacon_id": "Id of the beacon or tag, as it sends or bears it.",
    "other_id": "The beacon or tag, or the other unit of a meeting; else empty.",
    "set_ms": "When it was set.",
    "PinView.state": "used, conflict or waiting.",
    "PinView.text": "What it conflicts with or waits for, in words; empty: it is used.",
    "PinView.text_code": "Code of that text; null: it has none.",
    "residual_m": "Metres between the pin and the trail; null: not solved yet.",
    "sigmas": "The same in standard deviations of what was expected; null: not solved yet.",
    "reach_m": "From how far the beacon or tag is seen, metres.",
    "seen_ms": "When a unit last saw it; null: none has.",
    # ---- places
    "north_m": "Metres north.",
    "east_m": "Metres east.",
    "down_m": "Metres down: below the incident frame's origin.",
    "std_m": "Standard deviation of the place in each horizontal direction, metres.",
    "std_north_m": "Standard deviation north, metres.",
    "std_east_m": "Standard deviation east, metres.",
    "std_down_m": "Standard deviation of the height, metres.",
    "heading_rad": "Heading, radians clockwise from north.",
    "heading_std_rad": "Standard deviation of the heading, radians; pi: unknown.",
    "floor": "The floor's number, 0 the ground floor; null: not known.",
    "quality": "How good the position is: good, degraded or lost.",
}
