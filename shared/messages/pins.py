"""Pins: places of a wearer that a person knows, and places of beacons.

Places are north and east in the incident frame; times are the station's, and 0 means: where each
unit's path begins.
"""

from __future__ import annotations

import msgspec


class SetPin(msgspec.Struct, frozen=True):
    """This unit was here then.  A pin with the id of an earlier one replaces it."""

    pin_id: str
    unit_id: str
    t_ns: int
    north_m: float
    east_m: float
    std_m: float  # of each axis
    floor: int | None  # of the plan
    heading_rad: float | None  # which way the wearer looked or went
    heading_std_rad: float
    note: str


class StartTogether(msgspec.Struct, frozen=True):
    """These units were together here then; each gets a pin ``{pin_id}:{unit_id}``."""

    pin_id: str
    unit_ids: tuple[str, ...]
    t_ns: int
    north_m: float
    east_m: float
    std_m: float
    floor: int | None
    heading_rad: float | None  # which way all of them looked
    heading_std_rad: float
    note: str


class SetMeeting(msgspec.Struct, frozen=True):
    """Meeting of two people at an unknown place."""

    pin_id: str
    unit_id: str
    other_unit_id: str
    t_ns: int
    std_m: float  # how far apart they may have been, each axis
    note: str


class RemovePin(msgspec.Struct, frozen=True):
    """Undoes a pin, whatever set it; with the id of a ``StartTogether``, all of its pins."""

    pin_id: str


class PlaceBeacon(msgspec.Struct, frozen=True):
    """A beacon or tag hangs here; one with the id of an earlier one replaces it."""

    beacon_id: str
    label: str
    north_m: float
    east_m: float
    floor: int | None
    std_m: float  # of its place, each axis
    reach_m: float  # from how far away it can be seen
    incident_id: str = ""  # on whose site; empty: on the station's own


class RemoveBeacon(msgspec.Struct, frozen=True):
    beacon_id: str
