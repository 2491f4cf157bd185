"""What the log holds beside its own records so that Foxglove and Lichtblick show it as it is: a
place on the map for each unit, and the alarms as log lines.  Our own readers skip these topics.
"""

from __future__ import annotations

import math

from foxglove_schemas_protobuf.LocationFix_pb2 import LocationFix
from foxglove_schemas_protobuf.Log_pb2 import Log
from google.protobuf.timestamp_pb2 import Timestamp

from shared.clock import NS_PER_S
from shared.geo import Anchor
from shared.mcap_log import location_topic, log_topic
from shared.messages import STATION_ID, AlarmChange, AlarmState, FusedPosition

_LEVEL_BY_PRIORITY = {1: Log.FATAL, 2: Log.ERROR, 3: Log.WARNING}


class FoxgloveTopics:
    """``of`` gives the record that belongs beside one of the station's decisions."""

    def __init__(self) -> None:
        self._last_second: dict[str, int] = {}

    def of(
        self, decision: FusedPosition | AlarmChange, anchor: Anchor | None
    ) -> tuple[str, bytes] | None:
        """``(topic, payload)``; None where there is nothing to show.

        A unit's place is said once a second, and where the site has an anchor.
        """
        if isinstance(decision, AlarmChange):
            topic = log_topic(decision.unit_id or STATION_ID)
            return topic, _log_line(decision).SerializeToString()
        second = decision.t_meas_ns // NS_PER_S
        if anchor is None or self._last_second.get(decision.unit_id) == second:
            return None
        self._last_second[decision.unit_id] = second
        return location_topic(decision.unit_id), _location(decision, anchor).SerializeToString()


def _log_line(change: AlarmChange) -> Log:
    level = Log.INFO
    if change.state is AlarmState.RAISED:
        level = _LEVEL_BY_PRIORITY.get(change.priority, Log.WARNING)
    by = f" by {change.by}" if change.by else ""
    return Log(
        timestamp=_timestamp(change.header.t_utc_ns),
        level=level,
        name=change.rule,
        message=f"{change.unit_id or STATION_ID}: {change.text} ({change.state.name.lower()}{by})",
    )


def _location(fused: FusedPosition, anchor: Anchor) -> LocationFix:
    lat_deg, lon_deg, height_m = anchor.to_geodetic(fused.north_m, fused.east_m, fused.down_m)
    fix = LocationFix(
        timestamp=_timestamp(fused.t_meas_ns),
        frame_id=fused.unit_id,
        latitude=lat_deg,
        longitude=lon_deg,
        altitude=height_m,
        position_covariance=_covariance_enu_m2(fused, anchor.rotation_rad),
        position_covariance_type=LocationFix.KNOWN,
    )
    if fused.heading_std_rad < math.pi:
        fix.heading = (fused.heading_rad + anchor.rotation_rad) % (2.0 * math.pi)
    return fix


def _covariance_enu_m2(fused: FusedPosition, rotation_rad: float) -> tuple[float, ...]:
    """3 x 3 by rows, true east, true north, up."""
    sine, cosine = math.sin(rotation_rad), math.cos(rotation_rad)
    north_m2, east_m2 = fused.std_north_m**2, fused.std_east_m**2
    mixed_m2 = fused.correlation_ne * fused.std_north_m * fused.std_east_m
    turned_m2 = 2.0 * sine * cosine * mixed_m2
    true_east_m2 = sine * sine * north_m2 + cosine * cosine * east_m2 + turned_m2
    true_north_m2 = cosine * cosine * north_m2 + sine * sine * east_m2 - turned_m2
    true_mixed_m2 = sine * cosine * (north_m2 - east_m2) + (cosine**2 - sine**2) * mixed_m2
    up_m2 = fused.std_down_m**2
    return (true_east_m2, true_mixed_m2, 0.0, true_mixed_m2, true_north_m2, 0.0, 0.0, 0.0, up_m2)


def _timestamp(t_ns: int) -> Timestamp:
    return Timestamp(seconds=t_ns // NS_PER_S, nanos=t_ns % NS_PER_S)
