"""Topics for Foxglove and Lichtblick beside the log's own records: a place on the map for each
unit, the building below them, and the alarms as log lines.  Our own readers skip these topics.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import msgspec
from foxglove_schemas_protobuf.GeoJSON_pb2 import GeoJSON
from foxglove_schemas_protobuf.LocationFix_pb2 import LocationFix
from foxglove_schemas_protobuf.Log_pb2 import Log
from google.protobuf.timestamp_pb2 import Timestamp

from base_station.site.plan import Plan
from shared.clock import NS_PER_S
from shared.geo import Anchor
from shared.mcap_log import PLAN_TOPIC, location_topic, log_topic
from shared.messages import STATION_ID, AlarmChange, AlarmState, FusedPosition

_PLAN_EVERY_NS = 900 * NS_PER_S  # as a segment of the log is long: each is opened by itself
_PLACED_AT_ONCE = 200  # points of a plan: some two milliseconds
_LEVEL_BY_PRIORITY = {1: Log.FATAL, 2: Log.ERROR, 3: Log.WARNING}


class _Features(msgspec.Struct):
    features: list[msgspec.Raw] = []


class FoxgloveTopics:
    """Records for Foxglove that belong to the station's decisions."""

    def __init__(self) -> None:
        self._last_second: dict[str, int] = {}
        self._building: tuple[Plan, Anchor] | None = None  # that is logged now, or was last
        self._placing: Iterator[bytes] = iter(())  # it, on the Earth, step by step
        self._plan = b""  # as it is logged; empty: not all of it has a place yet
        self._plan_logged_ns = 0

    def of(
        self, decision: FusedPosition | AlarmChange, anchor: Anchor | None
    ) -> tuple[str, bytes] | None:
        """Return topic and payload for a decision; None if there is nothing to show.

        A unit's position is logged once a second, if the site has an anchor.
        """
        if isinstance(decision, FusedPosition):
            return self._location_of(decision, anchor)
        topic = log_topic(decision.unit_id or STATION_ID)
        return topic, _log_line(decision).SerializeToString()

    def _location_of(self, fused: FusedPosition, anchor: Anchor | None) -> tuple[str, bytes] | None:
        second = fused.t_meas_ns // NS_PER_S
        if anchor is None or self._last_second.get(fused.unit_id) == second:
            return None
        self._last_second[fused.unit_id] = second
        return location_topic(fused.unit_id), _location(fused, anchor).SerializeToString()

    def plan(self, plan: Plan | None, anchor: Anchor | None, t_ns: int) -> tuple[str, bytes] | None:
        """Return the building on the Earth, if its place is known: when it changes, and again at
        intervals.  A large one is converted in parts, some with each call, because the caller is
        the engine's thread.
        """
        if plan is None or anchor is None:
            return None
        logged = self._building
        if logged is None or logged[0] is not plan or logged[1] is not anchor:
            self._building, self._plan = (plan, anchor), b""
            self._placing = _plan_in_wgs84(plan, anchor)
        elif self._plan and t_ns - self._plan_logged_ns < _PLAN_EVERY_NS:
            return None
        self._plan = self._plan or next(self._placing)
        if not self._plan:
            return None
        self._plan_logged_ns = t_ns
        return PLAN_TOPIC, self._plan


def _plan_in_wgs84(plan: Plan, anchor: Anchor) -> Iterator[bytes]:
    """Convert the plan's features to WGS-84, without heights, as a map shows none.  Before the
    result, yields an empty string after every ``_PLACED_AT_ONCE`` points.
    """
    features = []
    points = 0
    for encoded in msgspec.json.decode(plan.geojson, type=_Features).features:
        feature = msgspec.json.decode(encoded)
        geometry = feature.get("geometry") or {}
        if not geometry.get("coordinates"):
            continue
        coordinates: list[Any] = []
        for placed in _to_geodetic(geometry["coordinates"], coordinates, anchor):
            points += placed
            if points >= _PLACED_AT_ONCE:
                points = 0
                yield b""
        placed_geometry = {"type": geometry["type"], "coordinates": coordinates[0]}
        features.append(msgspec.Raw(msgspec.json.encode({**feature, "geometry": placed_geometry})))
    collection = {"type": "FeatureCollection", "features": features}
    yield GeoJSON(geojson=msgspec.json.encode(collection).decode()).SerializeToString()


def _to_geodetic(coordinates: Any, into: list[Any], anchor: Anchor) -> Iterator[int]:
    """Append one ``[east_m, north_m, ...]``, or lists of such to any depth, as ``[lon, lat]``;
    yields after each point.
    """
    if coordinates and isinstance(coordinates[0], int | float):
        lat_deg, lon_deg, _ = anchor.to_geodetic(coordinates[1], coordinates[0], 0.0)
        into.append([round(lon_deg, 8), round(lat_deg, 8)])
        yield 1
        return
    parts: list[Any] = []
    into.append(parts)
    for one in coordinates:
        yield from _to_geodetic(one, parts, anchor)


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
    """3 x 3 covariance by rows, along true east, true north and up, m2."""
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
