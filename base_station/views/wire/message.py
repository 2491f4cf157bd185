"""Messages to the console: the snapshot, and what changes after it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated

import msgspec

from base_station.views.wire.alarm import AlarmView
from base_station.views.wire.command import CommandView
from base_station.views.wire.incident import DispatchView, IncidentView
from base_station.views.wire.place import (
    AnchorView,
    BeaconView,
    ExternalMarkerView,
    PinView,
    SiteView,
)
from base_station.views.wire.replay import ReplayView
from base_station.views.wire.schema import shown_as
from base_station.views.wire.station import HealthView
from base_station.views.wire.trail import POINTS, TrailPoint
from base_station.views.wire.unit import UnitView


class Snapshot(msgspec.Struct, frozen=True, tag="snapshot"):
    seq: int
    now_ms: int
    incident: IncidentView | None
    units: tuple[UnitView, ...]
    alarms: tuple[AlarmView, ...]  # all that are not resolved, and the last resolved ones
    commands: tuple[CommandView, ...]  # all that are open, and the last closed ones; oldest first
    pins: tuple[PinView, ...]  # in the order of setting
    beacons: tuple[BeaconView, ...]
    external: tuple[ExternalMarkerView, ...]  # of other teams, where the site has an anchor
    # GeoJSON as stored: see docs/messages
    plan: Annotated[msgspec.Raw, shown_as("Plan", {"type": "object"})] | None
    anchor: AnchorView | None
    health: HealthView
    replay: ReplayView | None
    # All that are open, and closed ones until the next is opened on their site.
    incidents: tuple[IncidentView, ...] = ()
    sites: tuple[SiteView, ...] = ()  # beside the one of ``incident``
    plan_placed: bool = True  # False: the plan is not placed on the Earth yet
    dispatches: tuple[DispatchView, ...] = ()  # from which no incident was opened, oldest first


class _WhatChanges(msgspec.Struct, frozen=True, omit_defaults=True, kw_only=True):
    """Fields that ``Delta`` and ``FieldDelta`` have in common."""

    alarms: tuple[AlarmView, ...] = ()
    commands: tuple[CommandView, ...] = ()
    trails: Mapping[str, Annotated[msgspec.Raw, POINTS]] = {}  # of units whose past changed
    pins: tuple[PinView, ...] | None = None  # all of them, where any changed
    beacons: tuple[BeaconView, ...] | None = None
    external: tuple[ExternalMarkerView, ...] | None = None  # all of them, where any changed
    health: HealthView | None = None
    incident: IncidentView | None = None
    replay: ReplayView | None = None


class Delta(_WhatChanges, frozen=True, tag="delta", omit_defaults=True):
    seq: int
    now_ms: int
    units: tuple[UnitView, ...] = ()


# The fields of a ``UnitView`` that changed, all of them for a unit that is new.  Where such a field
# is an object and was one before, it has the fields of that which changed: as in a merge patch of
# JSON (RFC 7396), but null is a value.  Of a position, time and place always come together.
UnitChange = dict[str, object]


class FieldDelta(_WhatChanges, frozen=True, tag="field_delta", omit_defaults=True):
    """Changes since the message with ``after_seq``."""

    seq: int
    after_seq: int
    now_ms: int
    units: dict[
        str, Annotated[UnitChange, shown_as("UnitChange", {"type": "object"})]
    ] = {}  # by unit
    passed: Mapping[str, tuple[TrailPoint, ...]] = {}  # by unit: where it was between the two, at
    # most once a second; only where several messages were merged
