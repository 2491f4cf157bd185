"""Views of the ground, and of pins, beacons and markers of other teams on it."""

from __future__ import annotations

from typing import Annotated

import msgspec

from base_station.views.answer import Answer
from base_station.views.wire.schema import one_of, shown_as
from base_station.views.wire.text_code import TextCodeView


class PinView(Answer, frozen=True):
    """Place of a wearer that a person or a beacon has reported, with the verdict on it."""

    pin_id: str
    kind: Annotated[str, one_of("place", "start", "meeting", "beacon", "tag")]
    unit_id: str
    other_id: str  # the beacon or tag, or the other unit of a meeting; else empty
    t_ms: int  # 0: where the unit's path begins
    north_m: float | None  # None: a meeting, or a beacon that is not placed yet
    east_m: float | None
    floor: int | None
    std_m: float
    heading_rad: float | None
    heading_std_rad: float
    note: str
    by: str  # the user who set it; the unit itself for a sighting
    set_ms: int
    state: Annotated[str, one_of("used", "conflict", "waiting")]
    residual_m: float | None  # between the pin and the trail
    sigmas: float | None  # the same in standard deviations of the expectation
    text: str  # for a person: what it conflicts with, or what it waits for
    text_code: TextCodeView | None = None  # of ``text``, where it has one


class BeaconView(Answer, frozen=True):
    """A beacon or tag that hangs at a known place."""

    beacon_id: str
    label: str
    north_m: float
    east_m: float
    floor: int | None
    std_m: float
    reach_m: float
    seen_ms: int | None  # when a unit last saw it
    site_id: str = ""  # on which site it hangs


class ExternalMarkerView(Answer, frozen=True):
    """A person or marker of another team, from another system."""

    marker_id: str
    source: str  # name of the forwarder
    name: str
    kind: Annotated[str, one_of("person", "marker", "emergency")]
    remarks: str
    north_m: float
    east_m: float
    radius_m: float | None  # of the region in which it is; None: unknown
    t_ms: int  # the time to which the place belongs
    stale_ms: int  # from then on it is old
    site_id: str = ""  # incident whose frame its place uses: a marker is shown on each site


class AnchorView(Answer, frozen=True):
    lat_deg: float
    lon_deg: float
    height_m: float
    plan_rotation_rad: float


class SiteView(Answer, frozen=True):
    """Ground of an incident beside the one of ``Snapshot.incident``."""

    site_id: str
    plan: Annotated[msgspec.Raw, shown_as("Plan | null", {"type": ["object", "null"]})]
    anchor: AnchorView | None
    plan_placed: bool
