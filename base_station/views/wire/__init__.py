"""Messages to the console over the WebSocket ``/api/v1/live``: a snapshot, then its changes.

Both carry ``seq``; a delta whose ``seq`` is not the last one plus one means that the console missed
something and must ask for a snapshot (send ``{"type": "snapshot"}``). Trails from before the
snapshot follow one by one, whenever no delta waits.

``/api/v1/live`` gives ``Delta`` messages, with each changed unit whole.  With ``?deltas=fields`` it
gives ``FieldDelta`` instead, with the fields that changed.  A console that asks for these also
confirms what it has shown: it sends ``{"type": "shown", "count": N}``, where N is the number of
messages of any type that it has received over this connection and shown.  Until the last snapshot
or delta is confirmed, changes are merged; the next ``FieldDelta`` has all of them, and names in
``after_seq`` the message that it follows.  Messages are compressed if the console offers it
(permessage-deflate).

Times are milliseconds since 1970 (station time; in a replay, the time of the incident). Positions
are metres north, east and down in the incident frame.  The console's ``src/wire/`` and the page
``docs/live.md`` are generated from these types (``python -m tests.rig.console_types``).
"""

from __future__ import annotations

from base_station.views.wire.alarm import AlarmParametersView, AlarmView
from base_station.views.wire.command import CommandView, DeliveryView
from base_station.views.wire.incident import DispatchView, IncidentView
from base_station.views.wire.message import Delta, FieldDelta, Snapshot, UnitChange
from base_station.views.wire.place import (
    AnchorView,
    BeaconView,
    ExternalMarkerView,
    PinView,
    SiteView,
)
from base_station.views.wire.replay import GapView, ReplayView
from base_station.views.wire.schema import one_of, shown_as
from base_station.views.wire.station import (
    ArchiveView,
    ForwarderView,
    HealthView,
    RadioView,
    RecordingView,
    StandbyView,
)
from base_station.views.wire.text_code import TextCodeView
from base_station.views.wire.trail import Trail, TrailPoint, encoded_trail
from base_station.views.wire.unit import (
    ClockView,
    DutyView,
    Link,
    PersonView,
    PositionView,
    PreflightView,
    SensorTemperatureView,
    StatusView,
    TrustView,
    UnitView,
    WornSensorView,
)

__all__ = [
    "AlarmParametersView",
    "AlarmView",
    "AnchorView",
    "ArchiveView",
    "BeaconView",
    "ClockView",
    "CommandView",
    "DeliveryView",
    "Delta",
    "DispatchView",
    "DutyView",
    "ExternalMarkerView",
    "FieldDelta",
    "ForwarderView",
    "GapView",
    "HealthView",
    "IncidentView",
    "Link",
    "PersonView",
    "PinView",
    "PositionView",
    "PreflightView",
    "RadioView",
    "RecordingView",
    "ReplayView",
    "SensorTemperatureView",
    "SiteView",
    "Snapshot",
    "StandbyView",
    "StatusView",
    "TextCodeView",
    "Trail",
    "TrailPoint",
    "TrustView",
    "UnitChange",
    "UnitView",
    "WornSensorView",
    "encoded_trail",
    "one_of",
    "shown_as",
]
