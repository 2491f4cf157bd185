"""Reports of the dispatch centre: EIDO and plain JSON, and their faults."""

from __future__ import annotations

import json
from datetime import UTC, datetime
from typing import Any

import pytest

from base_station.dispatch.config import DispatchConfig
from base_station.dispatch.description import description, incident_name
from base_station.dispatch.reading import read_report
from base_station.dispatch.report_parts import MOST_UNITS, MOST_WARNINGS
from shared.clock import NS_PER_S
from shared.errors import WireError
from shared.messages.station import NoteDispatch

NOW = datetime(2026, 3, 1, 13, 10, tzinfo=UTC)
NOW_NS = round(NOW.timestamp()) * NS_PER_S
PLAIN = {
    "number": "2026-1234",
    "type": "Structure fire",
    "type_code": "69D6",
    "priority": 1,
    "address": "Main St 5, Springfield",
    "position": {"lat_deg": 52.5, "lon_deg": 13.4},
    "units": ["E12", "L4", "E12"],
    "called": "2026-03-01T14:02:11+01:00",
    "dispatched": "2026-03-01T13:03:00Z",
    "updated": "2026-03-01T13:04:00.250Z",
    "remarks": "two people\non the third floor",
    "ended": False,
}
CIVIC = """  <?xml version="1.0" encoding="UTF-8"?><presence xmlns="urn:ietf:params:xml:ns:pidf"
  xmlns:gp="urn:ietf:params:xml:ns:pidf:geopriv10"><tuple><status><gp:geopriv><gp:location-info>
  <civicAddress xmlns="urn:ietf:params:xml:ns:pidf:geopriv10:civicAddr"><country>US</country>
  <A1>DE</A1><A3>Springfield</A3><RD>Main</RD><STS>Street</STS><HNO>5</HNO><FLR>3</FLR>
  </civicAddress></gp:location-info></gp:geopriv></status></tuple></presence>"""
POINT = """<presence xmlns="urn:ietf:params:xml:ns:pidf" xmlns:gml="http://www.opengis.net/gml">
  <gml:Point srsName="urn:ogc:def:crs:EPSG::4326"><gml:pos>39.74 -75.55</gml:pos></gml:Point>
  </presence>"""
SQUARE = POINT.replace("<gml:pos>39.74 -75.55</gml:pos>", "<gml:posList>{}</gml:posList>").format(
    "39 -75 39 -76 40 -76 40 -75 39 -75"
)


def read(body: Any, config: DispatchConfig | None = None) -> NoteDispatch:
    return read_report(json.dumps(body).encode(), config or DispatchConfig(), NOW_NS)


def at(text: str) -> int:
    moment = datetime.fromisoformat(text).timestamp()
    return round(moment * 1000) * (NS_PER_S // 1000)


def eido(**change: Any) -> dict[str, Any]:
    """An EIDO of the final version, with used and unused parts."""
    body = {
        "$id": "urn:emergency:uid:incidentid:a56:bcf.example.org",
        "lastUpdateTimeStamp": "2026-03-01T13:05:00Z",
        "eidoVersion": "1.0",
        "incidentComponent": {
            "$id": "i",
            "internalIncidentId": "F26-7",
            "incidentTypeInternalCode": "69D6",
            "incidentTypeInternalText": "STRUCTURE FIRE",
            "incidentTypeCommonRegistryText": "StructureFire",
            "incidentStatusCommonRegistryText": ["Active"],
            "incidentCommonPriorityNumber": 1,
            "locationReference": [{"$ref": "where"}],
        },
        "callComponent": [
            {"callStartTimestamp": "2026-03-01T13:02:00Z"},
            {"callStartTimestamp": "2026-03-01T13:01:00Z"},
        ],
        "dispatchComponent": [{"lastUpdateTimeStamp": "2026-03-01T13:03:00Z"}],
        "emergencyResourceComponent": [
            {"emergencyResourceName": "E12", "primaryUnitStatusRegistryText": "Assigned"},
            {"emergencyResourceName": "L4"},
        ],
        "locationComponent": [
            {
                "$id": "phone",
                "locationTypeDescriptionRegistryText": "Caller",
                "locationByValue": POINT,
            },
            {"$id": "where", "locationByValue": CIVIC},
        ],
        "notesComponent": [{"notesActionComments": "<p>smoke &amp; flames</p>"}],
        "personComponent": [{"ncPersonComponent": {"personName": "Mr Caller"}}],
    }
    return body | change


def test_a_plain_report() -> None:
    report = read(PLAIN)
    assert report == NoteDispatch(
        number="2026-1234",
        source="json",
        type="Structure fire",
        type_code="69D6",
        priority="1",
        address="Main St 5, Springfield",
        lat_deg=52.5,
        lon_deg=13.4,
        units=("E12", "L4"),
        called_ns=at("2026-03-01T13:02:11Z"),
        dispatched_ns=at("2026-03-01T13:03:00Z"),
        updated_ns=at("2026-03-01T13:04:00.250Z"),
        remarks="two people on the third floor",
    )
    assert incident_name(report) == "Structure fire, Main St 5, Springfield"
    assert description(report) == (
        "Dispatch 2026-1234: Structure fire (69D6); priority 1; Main St 5, Springfield; 52.500000, "
        "13.400000; units E12 L4; called 2026-03-01 13:02:11 UTC; dispatched 2026-03-01 13:03:00 "
        "UTC; two people on the third floor"
    )


def test_a_number_is_enough() -> None:
    report = read({"number": 17})
    assert report == NoteDispatch("17", "json", updated_ns=NOW_NS)
    assert incident_name(report) == "Dispatch 17"
    assert description(report) == "Dispatch 17: nothing more is known"


def test_an_eido() -> None:
    report = read(eido())
    assert (report.number, report.source, report.priority) == ("F26-7", "eido", "1")
    assert (report.type, report.type_code) == ("STRUCTURE FIRE", "69D6")
    assert report.address == "5 Main Street, 3, Springfield"
    assert (report.lat_deg, report.lon_deg) == (39.74, -75.55)
    assert report.units == ("E12", "L4")
    assert report.called_ns == at("2026-03-01T13:01:00Z")
    assert report.dispatched_ns == at("2026-03-01T13:03:00Z")
    assert report.updated_ns == at("2026-03-01T13:05:00Z")
    assert report.remarks == "smoke & flames"
    assert not report.has_ended
    assert len(report.warnings) == 1  # the position is that of the telephone
    assert "Caller" in report.warnings[0]
    assert "Mr Caller" not in str(report)


def test_eido_of_the_first_version() -> None:
    report = read(
        {
            "LastUpdateTimeStamp": "2026-03-01T13:05:00Z",
            "EIDOVersion": "1.0",
            "incidentTrackingIdentifier": "urn:emergency:uid:incidentid:0:psap.example.org",
            "incidentComponent": [
                {
                    "incidentTypeCommonRegistryText": "VehicleFire",
                    "incidentStatusCommonRegistryText": "Closed",
                }
            ],
            "emergencyResourceComponent": {"enforcementUnitName": "M3"},
            "locationInformationComponent": [
                {"locationTypeDescriptionRegistryText": "Incident", "locationByValue": SQUARE}
            ],
        }
    )
    assert report.number == "0:psap.example.org"
    assert (report.type, report.type_code, report.units) == ("Vehicle fire", "VehicleFire", ("M3",))
    assert (report.lat_deg, report.lon_deg) == (39.5, -75.5)
    assert report.has_ended
    assert report.warnings == ()


def test_codes_are_shown_in_the_words_of_the_settings() -> None:
    config = DispatchConfig(types={"69D6": "Building fire, entrapment"})
    assert read(eido(), config).type == "Building fire, entrapment"


@pytest.mark.parametrize(
    "body",
    [
        *(b"", b"rubbish", b"\xff\xfe", b"[]", b'"2026"', b"17", b"null"),
        *(
            b"{}",
            b'{"number": ""}',
            b'{"number": null}',
            b'{"number": true}',
            b'{"number": " \\n"}',
        ),
        *(b'{"number": {}}', b'{"number": "' + b"9" * 129 + b'"}', b"[" * 100_000),
        *(b'{"eidoVersion": "1.0"}', b'{"incidentComponent": 5}', b'{"incidentComponent": [[]]}'),
    ],
)
def test_report_without_a_number_is_refused(body: bytes) -> None:
    with pytest.raises(WireError):
        read_report(body, DispatchConfig(), NOW_NS)


@pytest.mark.parametrize(
    ("change", "lost", "word"),
    [
        ({"position": {"lat_deg": 0, "lon_deg": 0}}, "lat_deg", "0, 0"),
        ({"position": {"lat_deg": 95, "lon_deg": 0}}, "lat_deg", "no place on the Earth"),
        ({"position": {"lat_deg": "52", "lon_deg": 13}}, "lat_deg", "no latitude"),
        ({"position": [52, 13]}, "lon_deg", "position"),
        ({"called": "2026-03-01T14:02:11"}, "called_ns", "zone"),
        ({"called": "yesterday"}, "called_ns", "no time"),
        ({"called": 1_700_000_000}, "called_ns", "no time"),
        ({"called": "0001-01-01T00:00:00+00:00"}, "called_ns", "no sense"),
        ({"dispatched": "2026-03-03T00:00:00Z"}, "dispatched_ns", "more than a day ahead"),
        ({"units": "E12"}, "units", "no list"),
        ({"units": [{"name": "E12"}]}, "units", "no text"),
        ({"type": ["fire"]}, "type", "no text"),
        ({"ended": "yes"}, "has_ended", "neither"),
    ],
)
def test_wrong_part_is_left_out_and_named(change: dict[str, Any], lost: str, word: str) -> None:
    report = read(PLAIN | {"type_code": ""} | change)
    assert not getattr(report, lost)
    assert report.address == PLAIN["address"]
    assert any(word in warning for warning in report.warnings)
    assert all(code.code for code in report.warning_codes)
    assert len(report.warning_codes) == len(report.warnings)


def test_future_time_of_change_does_not_keep_later_reports_out() -> None:
    assert read(PLAIN | {"updated": "2099-01-01T00:00:00Z"}).updated_ns == NOW_NS


def test_report_beyond_the_limits_is_cut_off() -> None:
    many = [f"E{number}" for number in range(10_000)]
    report = read(PLAIN | {"units": many, "address": "x" * 5000, "what": 1, "else": 2})
    assert report.units == tuple(many[:MOST_UNITS])
    assert len(report.address) == 200
    assert any("else, what" in warning for warning in report.warnings)
    noisy = read(PLAIN | {"units": [[number] for number in range(30)], "type": 3 * [[]]})
    assert len(noisy.warnings) <= MOST_WARNINGS + 1
    assert len(incident_name(report)) <= 80


@pytest.mark.parametrize(
    "location",
    [
        "no XML",
        "<presence>" * 3,
        '<!DOCTYPE x [<!ENTITY a "b">]><presence>&a;</presence>',
        '<presence xmlns:gml="g"><gml:pos>here there</gml:pos></presence>',
        POINT.replace("4326", "25832"),
        POINT.replace("39.74 -75.55", "0 0"),
        POINT.replace("39.74 -75.55", "nan nan"),
    ],
)
def test_unusable_location_is_left_out(location: str) -> None:
    report = read(eido(locationComponent=[{"locationByValue": location}]))
    assert (report.address, report.lat_deg) == ("", None)
    assert len(report.warnings) == 1


def test_location_by_reference_is_not_fetched() -> None:
    elsewhere = [{"locationByReferenceUrl": "https://lis.example.org/1"}, 5, None]
    report = read(eido(locationComponent=elsewhere))
    assert report.warnings == (
        "a location is given by an address of another server, and is not fetched",
    )
