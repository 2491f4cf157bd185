"""Contract of every exporter."""

from __future__ import annotations

import csv
import io
import re
import weakref
import zlib
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree as ET

import fastkml
import geojson
import gpxpy
import msgspec
import pytest
from lxml import etree
from pyarrow import parquet

from base_station.exporters import EXPORTERS
from base_station.exporters.compression import gzipped
from base_station.exporters.csv_tracks import CSV
from base_station.exporters.geojson import GEOJSON
from base_station.exporters.gpx import GPX
from base_station.exporters.incident import _split
from base_station.exporters.interface import Exporter, IncidentTracks, LazyTracks, WornTrack
from base_station.exporters.kml import KML
from base_station.storage.db.known_people import FORGOTTEN, KnownPerson, person_lookup
from base_station.storage.db.models import Assignment
from base_station.storage.db.records import TrackSample
from shared.clock import NS_PER_S
from shared.errors import UserError
from shared.geo import Anchor

GX_NAMESPACE = "http://www.google.com/kml/ext/2.2"
GPX_NAMESPACE = "http://www.topografix.com/GPX/1/1"
T0_NS = 1_700_000_000 * NS_PER_S
HOSTILE = 'Ada "<&>" ;,\n=1+1 \u00e4\U0001f692 \x0b\x00\ufffe]]>'  # the last record of old logs

NO_ROSTER = person_lookup({})
anyone = pytest.mark.parametrize("exporter", EXPORTERS, ids=lambda exporter: exporter.name)


def worn_tracks(points: int = 3) -> tuple[WornTrack, ...]:
    """Tracks of two wearers, of whom one went north."""
    walked = tuple(
        TrackSample(T0_NS + n * NS_PER_S, float(n), 0.5, -1.5, 0.1, 0.1, 0.2, 0.0, None, "good")
        for n in range(points)
    )
    return WornTrack("FF-01", HOSTILE, "A", walked), WornTrack("FF-02", "", "", walked[:1])


def incident(anchor: Anchor | None = None, points: int = 3) -> IncidentTracks:
    return IncidentTracks("i-1", HOSTILE, anchor, worn_tracks(points), description=HOSTILE)


class Held(WornTrack, frozen=True, weakref=True):
    """A track whose end of life can be observed."""


def written(exporter: Exporter, of: IncidentTracks) -> bytes:
    return b"".join(exporter.export(of))


ANCHOR = Anchor(52.0, 13.0, 40.0)
MOST_TRACKS = {"parquet": 140}  # of the current row group and the next one
BYTES_A_POINT = {"parquet": 2}  # compressed; of the others 10 at least


@anyone
def test_names_fit_an_address_and_are_unique(exporter: Exporter) -> None:
    assert re.fullmatch(r"[a-z0-9_-]+", exporter.name)
    assert re.fullmatch(r"[a-z0-9.]+", exporter.suffix)
    assert "/" in exporter.media_type
    assert sum(other.name == exporter.name for other in EXPORTERS) == 1


@anyone
def test_same_incident_gives_the_same_bytes(exporter: Exporter) -> None:
    assert written(exporter, incident(ANCHOR)) == written(exporter, incident(ANCHOR)) != b""


@anyone
def test_no_point_lies_at_zero_zero_without_an_anchor(exporter: Exporter) -> None:
    if exporter.needs_anchor:
        with pytest.raises(UserError, match="anchor"):
            written(exporter, incident())
    else:
        assert written(exporter, incident())


@anyone
def test_every_unit_and_every_point_is_exported(exporter: Exporter) -> None:
    short = written(exporter, incident(ANCHOR))
    assert b"FF-01" in short
    assert b"FF-02" in short
    longest = written(exporter, incident(ANCHOR, points=50_000))
    assert len(longest) > len(short) + 49_950 * BYTES_A_POINT.get(exporter.suffix, 10)


@anyone
def test_incident_without_tracks_can_be_written(exporter: Exporter) -> None:
    empty = replace(incident(ANCHOR), tracks=())
    assert written(exporter, empty)


def valid_kml(content: bytes) -> object:
    """Validate against the schemas of the OGC and of Google's extensions, which the library
    brings.
    """
    kml = etree.fromstring(content)
    schemas = Path(fastkml.__file__).parent / "schema"
    etree.XMLSchema(etree.parse(schemas / "kml22gx.xsd")).assertValid(kml)
    return kml


def valid_geojson(content: bytes) -> object:
    collection = geojson.loads(content.decode())
    assert collection.is_valid, collection.errors()
    return collection


# By the file's suffix, an independent reader that checks the file against its standard.
READERS: dict[str, Callable[[bytes], object]] = {
    "gpx": lambda content: gpxpy.parse(content.decode()),
    "kml": valid_kml,
    "geojson": valid_geojson,
    "csv": lambda content: list(csv.reader(io.StringIO(content.decode()), strict=True)),
    "parquet": lambda content: parquet.read_table(io.BytesIO(content)),
}


@anyone
def test_export_can_be_read_with_any_names_of_people(exporter: Exporter) -> None:
    content = written(exporter, incident(ANCHOR))
    read = READERS.get(exporter.suffix)
    if read is None:
        pytest.skip(f"nobody here reads {exporter.suffix}")
    assert read(content) is not None
    assert zlib.decompress(b"".join(gzipped([content])), wbits=31) == content


@anyone
def test_exporter_holds_one_track_at_a_time_and_refuses_before_the_first(
    exporter: Exporter,
) -> None:
    alive: weakref.WeakSet[Held] = weakref.WeakSet()
    most = 0

    def tracks() -> Iterator[WornTrack]:
        nonlocal most
        for number in range(200):
            track = Held(f"FF-{number}", "", "", worn_tracks(1000)[0].points)
            alive.add(track)
            most = max(most, len(alive))
            yield track

    content = exporter.export(replace(incident(ANCHOR), tracks=LazyTracks(tracks)))
    assert sum(map(len, content)) > 0
    assert most <= MOST_TRACKS.get(exporter.name, 3)
    if exporter.needs_anchor:
        with pytest.raises(UserError, match="anchor"):
            exporter.begun(incident())


def test_every_format_has_the_same_millisecond() -> None:
    """That of the API and the console: rounded down."""
    late_ns = 455_999_600
    sample = msgspec.structs.replace(worn_tracks()[0].points[0], t_ns=T0_NS + late_ns)
    track = msgspec.structs.replace(worn_tracks()[0], points=(sample,))
    of = {one.name: written(one, replace(incident(ANCHOR), tracks=(track,))) for one in EXPORTERS}
    assert b"1700000000.455," in of["csv"]
    assert b'"times_ms":[1700000000455]' in of["geojson"]
    assert b"<time>2023-11-14T22:13:20.455Z</time>" in of["gpx"]
    assert b"<when>2023-11-14T22:13:20.455Z</when>" in of["kml"]
    (t_utc,) = parquet.read_table(io.BytesIO(of["parquet"]))["t_utc"].to_pylist()
    assert round(t_utc.timestamp() * 1000) == 1_700_000_000_455


@pytest.mark.parametrize("name", ["=1+1", "+1", "-1+1", "@SUM(1)", "\t=1+1", "\r=1+1"])
def test_name_does_not_become_a_formula(name: str) -> None:
    track = msgspec.structs.replace(worn_tracks()[0], person_name=name, crew=name)
    table = written(CSV, replace(incident(), tracks=(track,))).decode()
    rows = list(csv.reader(io.StringIO(table, newline="")))
    assert rows[1][1:3] == [f"'{name}"] * 2


def test_track_is_split_where_its_unit_changes_hands() -> None:
    def worn(name: str, from_s: int, until_s: int | None) -> Assignment:
        until_ns = None if until_s is None else T0_NS + until_s * NS_PER_S
        return Assignment(
            unit_id="FF-01", person_id=name[:3], person_name=name, crew="A",
            from_ns=T0_NS + from_s * NS_PER_S, until_ns=until_ns,
        )  # fmt: skip

    points = worn_tracks(8)[0].points
    hands = [worn("Ada", 1, 3), worn("Bea", 3, 5), worn("Ada", 6, None)]
    tracks = [
        (one.person_name, len(one.points)) for one in _split(NO_ROSTER, "FF-01", points, hands)
    ]
    assert tracks == [("", 1), ("Ada", 2), ("Bea", 2), ("", 1), ("Ada", 2)]
    # Assigned again with another name: from the same instant on the later assignment counts.
    again = [worn("Ada", 0, None), worn("Ada B.", 0, None)]
    assert [one.person_name for one in _split(NO_ROSTER, "FF-01", points, again)] == ["Ada B."]
    # With a new photo the person stays the same.
    photo = [worn("Ada", 0, 3), worn("Ada", 3, None)]
    assert [len(one.points) for one in _split(NO_ROSTER, "FF-01", points, photo)] == [8]


def test_tracks_have_the_names_of_the_roster() -> None:
    def worn(person_id: str, from_s: int, until_s: int) -> Assignment:
        return Assignment(
            unit_id="FF-01", person_id=person_id, person_name="", crew="", role="",
            from_ns=T0_NS + from_s * NS_PER_S, until_ns=T0_NS + until_s * NS_PER_S,
        )  # fmt: skip

    people = person_lookup({"p1": KnownPerson("Ada", "red"), "p2": FORGOTTEN})
    worn_by = [worn("p1", 0, 3), worn("p2", 3, 6), worn("p3", 6, 9)]
    tracks = list(_split(people, "FF-01", worn_tracks(8)[0].points, worn_by))
    assert [(one.person_name, one.crew) for one in tracks] == [
        ("Ada", "red"), ("(forgotten)", ""), ("person p3", ""),
    ]  # fmt: skip


@pytest.mark.parametrize(("gap_s", "north_m", "pieces"), [(60, 30, 2), (19, 30, 1), (60, 0.5, 1)])
def test_no_line_is_drawn_over_an_unknown_way(gap_s: int, north_m: float, pieces: int) -> None:
    track = worn_tracks(6)[0]
    moved = tuple(
        msgspec.structs.replace(one, t_ns=one.t_ns + gap_s * NS_PER_S, north_m=2.0 + north_m)
        for one in track.points[3:]
    )
    parted = msgspec.structs.replace(track, points=(*track.points[:3], *moved))
    of = {one.name: written(one, replace(incident(ANCHOR), tracks=(parted,))) for one in EXPORTERS}
    gpx, kml = ET.fromstring(of["gpx"]), ET.fromstring(of["kml"])
    segments = list(gpx.iter(f"{{{GPX_NAMESPACE}}}trkseg"))
    assert [len(one) for one in segments] == [6 // pieces] * pieces
    assert len(list(gpx.iter(f"{{{GPX_NAMESPACE}}}trk"))) == 1
    tracks = list(kml.iter(f"{{{GX_NAMESPACE}}}Track"))
    assert [len(one.findall(f"{{{GX_NAMESPACE}}}coord")) for one in tracks] == [
        6 // pieces
    ] * pieces
    features = msgspec.json.decode(of["geojson"])["features"]
    lines = [len(one["geometry"]["coordinates"]) for one in features]
    assert lines == [6 // pieces] * pieces
    assert [len(one["properties"]["times_ms"]) for one in features] == lines
    assert of["csv"].count(b"\r\n") == 1 + 6


def test_gpx_leads_north_with_the_wearer() -> None:
    points = list(ET.fromstring(written(GPX, incident(ANCHOR))).iter(f"{{{GPX_NAMESPACE}}}trkpt"))
    assert len(points) == 4
    assert float(points[2].get("lat", "")) > float(points[0].get("lat", ""))
    assert [child.tag.rpartition("}")[2] for child in points[0]] == ["ele", "time"]
    assert points[0][0].text == "41.50"
    assert points[0][1].text == "2023-11-14T22:13:20.000Z"


def test_kml_has_a_time_for_every_place() -> None:
    tracks = list(ET.fromstring(written(KML, incident(ANCHOR))).iter(f"{{{GX_NAMESPACE}}}Track"))
    assert len(tracks) == 2
    tags = [child.tag.rpartition("}")[2] for child in tracks[0]]
    assert tags == ["altitudeMode", *["when"] * 3, *["coord"] * 3]
    assert tracks[0][1].text == "2023-11-14T22:13:20.000Z"
    assert [float(part) for part in (tracks[0][4].text or "").split()] == pytest.approx(
        [13.0, 52.0, 41.5], abs=1e-4
    )


def test_kml_has_heights_above_ground_where_the_plan_lists_the_floor() -> None:
    placed = replace(incident(ANCHOR), ground_down_m=0.5)
    content = written(KML, placed)
    valid_kml(content)
    (walked, _) = ET.fromstring(content).iter(f"{{{GX_NAMESPACE}}}Track")
    assert walked[0].text == "relativeToGround"
    assert float((walked[4].text or "").split()[2]) == 2.0


def test_geojson_is_longitude_first() -> None:
    collection = msgspec.json.decode(written(GEOJSON, incident(ANCHOR)))
    line, point = collection["features"]
    assert line["geometry"]["coordinates"][0] == pytest.approx([13.0, 52.0, 41.5], abs=1e-4)
    assert point["geometry"]["type"] == "Point"
    assert line["properties"]["times_ms"][1] - line["properties"]["times_ms"][0] == 1000
