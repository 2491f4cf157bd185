"""What other programs are shown of a log: places in WGS-84 and alarms as log lines."""

from __future__ import annotations

import math

import msgspec
import pytest
from foxglove_schemas_protobuf.LocationFix_pb2 import LocationFix
from foxglove_schemas_protobuf.Log_pb2 import Log

from base_station.bench.rig import said
from base_station.live.foxglove_topics import FoxgloveTopics
from shared.clock import NS_PER_S
from shared.geo import Anchor
from shared.messages import STATION_ID, AlarmChange, AlarmState, FusedPosition, Header

T0_NS = 1_700_000_000 * NS_PER_S
HEADER = Header(STATION_ID, 1, 1, 0, T0_NS + 5)
# The plan's north points due east.
ANCHOR = Anchor(60.0, 10.0, 100.0, rotation_rad=math.pi / 2)
FUSED = said.fused(
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
)


def location_of(fused: FusedPosition) -> LocationFix:
    shown = FoxgloveTopics().of(fused, ANCHOR)
    assert shown is not None
    topic, payload = shown
    assert topic == "foxglove/anna/location"
    return LocationFix.FromString(payload)


def test_a_place_is_turned_by_the_plans_rotation() -> None:
    fix = location_of(FUSED)
    assert fix.longitude > 10.0
    assert fix.latitude == pytest.approx(60.0, abs=1e-4)
    assert fix.altitude == pytest.approx(103.0, abs=0.01)
    assert fix.heading == pytest.approx(math.pi / 2)
    assert fix.timestamp.ToNanoseconds() == T0_NS


def test_the_covariance_is_east_north_up() -> None:
    # The plan's north is east, its east is south: the mixed term changes its sign.
    assert list(location_of(FUSED).position_covariance) == pytest.approx(
        [4.0, -1.0, 0.0, -1.0, 1.0, 0.0, 0.0, 0.0, 0.25]
    )


def test_an_unknown_heading_is_left_out() -> None:
    unknown = msgspec.structs.replace(FUSED, heading_std_rad=math.pi)
    assert not location_of(unknown).HasField("heading")


def test_a_unit_is_placed_once_a_second_and_only_with_an_anchor() -> None:
    topics = FoxgloveTopics()
    assert topics.of(FUSED, None) is None
    assert topics.of(FUSED, ANCHOR) is not None
    assert topics.of(msgspec.structs.replace(FUSED, t_meas_ns=T0_NS + 5), ANCHOR) is None
    assert topics.of(msgspec.structs.replace(FUSED, unit_id="ben"), ANCHOR) is not None
    assert topics.of(msgspec.structs.replace(FUSED, t_meas_ns=T0_NS + NS_PER_S), ANCHOR)


def test_an_alarm_is_a_log_line() -> None:
    shown = FoxgloveTopics().of(ALARM, None)
    assert shown is not None
    topic, payload = shown
    line = Log.FromString(payload)
    assert topic == "foxglove/anna/log"
    assert (line.level, line.name, line.message) == (Log.FATAL, "heat", "anna: too hot (raised)")


def test_who_acknowledged_the_stations_own_alarm_is_said() -> None:
    acknowledged = msgspec.structs.replace(
        ALARM, unit_id="", state=AlarmState.ACKNOWLEDGED, by="chief"
    )
    shown = FoxgloveTopics().of(acknowledged, None)
    assert shown is not None
    assert shown[0] == "foxglove/station/log"
    assert Log.FromString(shown[1]).message == "station: too hot (acknowledged by chief)"
    assert Log.FromString(shown[1]).level == Log.INFO
