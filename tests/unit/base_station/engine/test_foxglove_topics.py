"""Topics of a log for other programs: places in WGS-84 and alarms as log lines."""

from __future__ import annotations

import math
from dataclasses import replace

import msgspec
import pytest
from foxglove_schemas_protobuf.GeoJSON_pb2 import GeoJSON
from foxglove_schemas_protobuf.LocationFix_pb2 import LocationFix
from foxglove_schemas_protobuf.Log_pb2 import Log

from base_station.engine.foxglove_topics import FoxgloveTopics
from base_station.site.plan import read_plan
from shared.clock import NS_PER_S
from shared.geo import Anchor
from shared.messages import STATION_ID, AlarmChange, AlarmState, FusedPosition, Header
from tests.rig import message_factory

T0_NS = 1_700_000_000 * NS_PER_S
HEADER = Header(STATION_ID, 1, 1, 0, T0_NS + 5)
# The plan's north points due east.
ANCHOR = Anchor(60.0, 10.0, 100.0, rotation_rad=math.pi / 2)
FUSED = message_factory.fused(
    HEADER,
    "anna",
    t_meas_ns=T0_NS,
    north_m=100.0,
    down_m=-3.0,
    std_north_m=2.0,
    std_east_m=1.0,
    std_down_m=0.5,
    correlation_ne=0.5,
    floor=1,
)
ALARM = AlarmChange(
    header=HEADER,
    alarm_id="a1",
    rule="heat",
    unit_id="anna",
    priority=1,
    state=AlarmState.RAISED,
    level="critical",
    text="too hot",
    by="",
    raised_ns=T0_NS,
    last_raised_ns=T0_NS,
)


def location_of(fused: FusedPosition) -> LocationFix:
    shown = FoxgloveTopics().of(fused, ANCHOR)
    assert shown is not None
    topic, payload = shown
    assert topic == "foxglove/anna/location"
    return LocationFix.FromString(payload)


def test_place_is_rotated_by_the_plans_rotation() -> None:
    fix = location_of(FUSED)
    assert fix.longitude > 10.0
    assert fix.latitude == pytest.approx(60.0, abs=1e-4)
    assert fix.altitude == pytest.approx(103.0, abs=0.01)
    assert fix.heading == pytest.approx(math.pi / 2)
    assert fix.timestamp.ToNanoseconds() == T0_NS


def test_covariance_is_east_north_up() -> None:
    # The plan's north is east, its east is south: the mixed term changes its sign.
    assert list(location_of(FUSED).position_covariance) == pytest.approx(
        [4.0, -1.0, 0.0, -1.0, 1.0, 0.0, 0.0, 0.0, 0.25]
    )


def test_unknown_heading_is_left_out() -> None:
    unknown = msgspec.structs.replace(FUSED, heading_std_rad=math.pi)
    assert not location_of(unknown).HasField("heading")


def test_unit_is_placed_once_a_second_and_only_with_an_anchor() -> None:
    topics = FoxgloveTopics()
    assert topics.of(FUSED, None) is None
    assert topics.of(FUSED, ANCHOR) is not None
    assert topics.of(msgspec.structs.replace(FUSED, t_meas_ns=T0_NS + 5), ANCHOR) is None
    assert topics.of(msgspec.structs.replace(FUSED, unit_id="ben"), ANCHOR) is not None
    assert topics.of(msgspec.structs.replace(FUSED, t_meas_ns=T0_NS + NS_PER_S), ANCHOR)


def test_alarm_is_a_log_line() -> None:
    shown = FoxgloveTopics().of(ALARM, None)
    assert shown is not None
    topic, payload = shown
    line = Log.FromString(payload)
    assert topic == "foxglove/anna/log"
    assert (line.level, line.name, line.message) == (Log.FATAL, "heat", "anna: too hot (raised)")


def test_acknowledgement_of_a_station_alarm_names_its_operator() -> None:
    acknowledged = msgspec.structs.replace(
        ALARM, unit_id="", state=AlarmState.ACKNOWLEDGED, by="chief"
    )
    shown = FoxgloveTopics().of(acknowledged, None)
    assert shown is not None
    assert shown[0] == "foxglove/station/log"
    assert Log.FromString(shown[1]).message == "station: too hot (acknowledged by chief)"
    assert Log.FromString(shown[1]).level == Log.INFO


def wall(*line: tuple[float, float]) -> bytes:
    properties = {"kind": "wall", "floor": 0}
    nowhere: dict[str, object] = {"type": "Feature", "properties": {}, "geometry": None}
    geometry = {"type": "LineString", "coordinates": line}
    feature = {"type": "Feature", "properties": properties, "geometry": geometry}
    floors = [{"floor": 0, "down_m": 0.0}]
    muster = {"frame": "site-m", "floors": floors}
    plan = {"type": "FeatureCollection", "muster": muster, "features": [feature, nowhere]}
    return msgspec.json.encode(plan)


def test_building_lies_on_the_map_below_its_people() -> None:
    plan = read_plan(wall((0.0, 0.0), (0.0, 100.0)))
    shown = FoxgloveTopics().plan(plan, ANCHOR, T0_NS)
    assert shown is not None
    topic, payload = shown
    assert topic == "foxglove/station/plan"
    drawn = msgspec.json.decode(GeoJSON.FromString(payload).geojson)
    (feature,) = drawn["features"]
    assert feature["properties"]["kind"] == "wall"
    (lon_deg, lat_deg), far = feature["geometry"]["coordinates"]
    assert (lat_deg, lon_deg) == pytest.approx((60.0, 10.0))
    fix = location_of(FUSED)  # 100 m along the same line
    assert far == pytest.approx([fix.longitude, fix.latitude], abs=1e-6)


def test_building_is_logged_on_change_and_now_and_then() -> None:
    topics, plan = FoxgloveTopics(), read_plan(wall((0.0, 0.0), (0.0, 1.0)))
    moved = replace(ANCHOR, lat_deg=61.0)
    assert topics.plan(None, ANCHOR, T0_NS) is None
    assert topics.plan(plan, None, T0_NS) is None
    assert topics.plan(plan, ANCHOR, T0_NS)
    assert topics.plan(plan, ANCHOR, T0_NS + 800 * NS_PER_S) is None
    assert topics.plan(plan, moved, T0_NS + 801 * NS_PER_S)
    assert topics.plan(plan, moved, T0_NS + 1701 * NS_PER_S)
