"""Cursor-on-Target events: by the schema, in TAK's terms, without unknown values."""

from __future__ import annotations

import math
from typing import Any
from xml.etree import ElementTree as ET

import msgspec
import pytest

from base_station.forwarders.tak.cot import (
    CotEvents,
    GeodeticPlace,
    GroundMotion,
    cot_time,
    how_of,
    motion_between,
    place_of,
    stale_ms,
)
from base_station.views.wire import AnchorView, PersonView, PositionView, UnitView
from tests.rig.cot_schema import check_event
from tests.rig.tak_scene import ANCHOR, Scene

STILL = GroundMotion(0.0, 0.0)


def position(**changes: Any) -> PositionView:
    found = Scene().unit().position
    assert found is not None
    return msgspec.structs.replace(found, **changes)


def placed(position: PositionView) -> GeodeticPlace:
    place = place_of(position, ANCHOR)
    assert place is not None
    return place


def person_event(unit: UnitView, *, names: bool = True) -> ET.Element:
    assert unit.position is not None
    events = CotEvents("muster", "Red", names=names)
    return check_event(events.person(unit, unit.position, placed(unit.position), STILL))


def detail(event: ET.Element, tag: str) -> ET.Element:
    found = event.find(f"detail/{tag}")
    assert found is not None, tag
    return found


def test_person_is_placed_by_anchor_and_frame() -> None:
    turned = AnchorView(52.5, 13.4, 40.0, math.pi / 2.0)  # the plan's north is east
    place = place_of(position(north_m=1000.0, east_m=0.0, down_m=-9.0), turned)
    assert place is not None
    assert place.lat_deg == pytest.approx(52.5, abs=1e-4)
    metres_per_deg = 111_320.0 * math.cos(math.radians(52.5))
    assert (place.lon_deg - 13.4) * metres_per_deg == pytest.approx(1000.0, rel=0.01)
    assert place.hae_m == pytest.approx(49.0, abs=0.2)


def test_circle_holds_the_95_percent_region() -> None:
    place = placed(position(ellipse_major_m=7.5, ellipse_minor_m=2.0, std_down_m=1.0))
    assert place.ce_m == 7.5
    assert place.le_m == pytest.approx(1.96)
    event = check_event(CotEvents("m", "Red", names=True).ping(ANCHOR, 0))
    assert event[0].get("le") == "9999999.0"


@pytest.mark.parametrize("anchor", [None, AnchorView(0.0, 0.0, 0.0, 0.0)])
def test_without_an_anchor_there_is_no_place(anchor: AnchorView | None) -> None:
    assert place_of(position(), anchor) is None


@pytest.mark.parametrize("name", ["north_m", "down_m", "ellipse_major_m"])
def test_value_that_is_no_number_is_no_place(name: str) -> None:
    assert place_of(position(**{name: math.nan}), ANCHOR) is None


def test_unknown_height_error_has_the_value_of_the_schema() -> None:
    unit = Scene().unit(position=position(std_down_m=math.inf))
    assert person_event(unit)[0].get("le") == "9999999.0"


@pytest.mark.parametrize(
    ("since_gps_s", "how"), [(None, "m-p"), (0.0, "m-f"), (10.0, "m-f"), (11.0, "m-p")]
)
def test_how_distinguishes_fused_from_dead_reckoned(since_gps_s: float | None, how: str) -> None:
    assert how_of(position(since_gps_s=since_gps_s)) == how


def test_position_is_stale_ten_seconds_after_its_measurement() -> None:
    at = position(t_ms=1_700_000_000_250)
    assert stale_ms(at) == at.t_ms + 10_000
    event = person_event(Scene().unit(position=at))
    assert event.get("time") == event.get("start") == "2023-11-14T22:13:20.250Z"
    assert event.get("stale") == "2023-11-14T22:13:30.250Z"
    assert cot_time(5) == "1970-01-01T00:00:00.005Z"


def test_event_states_name_and_state_of_the_person() -> None:
    unit = Scene().unit(
        person=PersonView("p1", "Ada <Chief> & Co", "A", "", None),
        position=position(floor=2, floor_probability=0.9),
        inside_since_ms=1,
        link="stale",
    )
    event = person_event(unit)
    assert event.get("uid") == "muster.FF-01"
    assert event.get("type") == "a-f-G-U-C"
    assert detail(event, "contact").get("callsign") == "Ada <Chief> & Co"
    assert detail(event, "__group").attrib == {"name": "Red", "role": "Team Member"}
    assert detail(event, "takv").get("device") == "Muster"
    words = detail(event, "remarks").text or ""
    for word in ("crew A", "floor 2 (90 %)", "inside", "link stale", "unit FF-01"):
        assert word in words


def test_event_without_names_has_the_label_of_the_unit() -> None:
    unit = Scene().unit(person=PersonView("p1", "Ada", "A", "", None), label="FF 1")
    event = person_event(unit, names=False)
    assert detail(event, "contact").get("callsign") == "FF 1"
    assert "Ada" not in ET.tostring(event, encoding="unicode")


def test_characters_that_xml_forbids_are_replaced() -> None:
    unit = Scene().unit(person=PersonView("p1", "A\x00da\x1b", "", "", None))
    assert detail(person_event(unit), "contact").get("callsign") == "A\ufffdda\ufffd"


def test_emergency_is_raised_and_cancelled_under_one_uid() -> None:
    unit = Scene().unit()
    assert unit.position is not None
    events = CotEvents("muster", "Red", names=True)
    place = placed(unit.position)
    raised = check_event(events.emergency(unit, unit.position, place, ("mayday",), 5_000))
    over = check_event(events.emergency_cancelled(unit, unit.position, place, 6_000))
    assert raised.get("uid") == over.get("uid") == "muster.FF-01-9-1-1"
    assert (raised.get("type"), over.get("type")) == ("b-a-o-tbl", "b-a-o-can")
    assert detail(raised, "emergency").get("type") == "911 Alert"
    assert detail(over, "emergency").get("cancel") == "true"
    assert detail(raised, "link").get("uid") == "muster.FF-01"
    assert "mayday" in (detail(raised, "remarks").text or "")


def test_trail_is_a_line_from_the_oldest_place_to_the_newest() -> None:
    unit = Scene().unit()
    assert unit.position is not None
    places = [GeodeticPlace(52.0 + step * 1e-4, 13.0, None, 1.0, 1.0) for step in range(3)]
    event = check_event(CotEvents("m", "Red", names=True).way(unit, unit.position, places))
    points = [one.get("point") for one in event.findall("detail/link")]
    assert points[0] == "52.0000000,13.0000000,9999999.0"
    assert points[-1] == "52.0002000,13.0000000,9999999.0"
    assert event[0].get("lat") == "52.0002000"


def test_speed_and_course_come_from_two_positions() -> None:
    earlier = placed(position(north_m=0.0, east_m=0.0))
    at = position(north_m=0.0, east_m=3.0)
    before = at.t_ms - 2000, earlier
    motion = motion_between(before, at, placed(at), 0.0)
    assert motion.speed_mps == pytest.approx(1.5, rel=0.01)
    assert motion.course_deg == pytest.approx(90.0, abs=0.5)


def test_course_at_rest_is_the_heading_of_the_wearer() -> None:
    at = position(heading_rad=math.pi / 2.0, heading_std_rad=0.1)
    assert motion_between(None, at, placed(at), math.pi / 2.0) == GroundMotion(0.0, 180.0)
    unknown = position(heading_rad=1.0, heading_std_rad=math.pi)
    assert motion_between(None, unknown, placed(unknown), 0.0) == GroundMotion(0.0, 0.0)
