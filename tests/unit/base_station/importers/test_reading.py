"""Files from elsewhere: what is read of them, and the reasons of refusals."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from base_station.importers.interface import MOST_BYTES, ImportOptions
from base_station.importers.process import content_of
from base_station.importers.reading import read_import
from base_station.storage.imports import ImportedContent
from shared.clock import NS_PER_S
from shared.coded_text import TextCode
from shared.errors import UserError
from shared.mcap_log import SegmentWriter
from shared.messages.station import OpenIncident, SetAnchor
from tests.rig.imported_files import (
    exif_time,
    in_ns,
    line,
    records_with_fused,
    write_gpx,
    write_kml,
    write_photo,
)
from tests.rig.station_script import Script

T_S = 1_700_000_010
BOMB = (
    '<?xml version="1.0"?><!DOCTYPE gpx [<!ENTITY a "aaaa"><!ENTITY b "&a;&a;&a;&a;">]>'
    "<gpx><trk><name>&b;</name></trk></gpx>"
)


def read(path: Path, shift_s: float = 0.0, utc_offset_h: float | None = None) -> ImportedContent:
    return read_import(path, ImportOptions(path.name, "i1", shift_s, utc_offset_h))


def refusal(path: Path) -> str:
    with pytest.raises(UserError) as refused:
        read(path)
    return str(refused.value)


def test_gpx_track_is_read_with_its_shift(tmp_path: Path) -> None:
    path = write_gpx(tmp_path / "drone.gpx", "Drone", line(T_S, 60))
    content = read(path, shift_s=-7.5)
    (track,) = content.tracks
    assert (content.format, track.name, len(track.points)) == ("gpx", "Drone", 60)
    first = track.points[0]
    assert first.t_ns == in_ns(T_S) - 7_500_000_000
    assert (first.lat_deg, first.lon_deg, first.height_m) == (52.0, 4.0, 12.5)
    assert content.warnings == ()


def test_torn_gpx_file_is_read_up_to_the_tear(tmp_path: Path) -> None:
    path = write_gpx(tmp_path / "torn.gpx", "Drone", line(T_S, 60))
    content = path.read_bytes()
    path.write_bytes(content[: len(content) // 2])
    torn = read(path)
    assert 20 < len(torn.tracks[0].points) < 40
    assert "what stands behind is lost" in torn.warnings[0]


def test_routes_and_waypoints_in_utf_16_are_read_and_a_time_without_a_zone_is_not(
    tmp_path: Path,
) -> None:
    path = tmp_path / "a.gpx"
    place = 'lat="52" lon="4"'
    path.write_text(
        '<?xml version="1.0" encoding="UTF-16"?><g:gpx xmlns:g="x"><g:wpt '
        f"{place}><g:time>2026-01-01T10:00:00Z</g:time><g:name>Ladder</g:name></g:wpt>"
        f"<g:rte><g:rtept {place}><g:time>2026-01-01T11:00:00+01:00</g:time></g:rtept>"
        f"<g:rtept {place}><g:time>2026-01-01T11:00:00</g:time></g:rtept>"
        '<g:rtept lat="91" lon="4"><g:time>2026-01-01T11:00:00Z</g:time></g:rtept></g:rte></g:gpx>',
        "utf-16",
    )
    content = read(path)
    assert [track.name for track in content.tracks] == ["Ladder", "rte 2"]
    assert [track.points[0].t_ns for track in content.tracks] == [1_767_261_600 * NS_PER_S] * 2
    assert content.warnings == ("2 points without a place or a time are left out",)
    assert content.summary.warning_codes == (
        TextCode("import-points-left-out", numbers={"count": 2.0}),
    )


def test_tracks_and_timed_places_of_kml_are_read_and_lines_are_left_out(tmp_path: Path) -> None:
    content = read(write_kml(tmp_path / "car.kml", "Car", line(T_S, 30)))
    assert [(one.name, len(one.points)) for one in content.tracks] == [("Car", 30), ("Hydrant", 1)]
    assert content.tracks[0].points[0].lat_deg == 52.0
    assert content.warnings == ("2 places without a time are left out",)


@pytest.mark.parametrize(
    ("taken", "zone", "fix_s", "offset_h", "warned"),
    [
        (exif_time(T_S, 2), "+02:00", None, None, False),
        (exif_time(T_S, 2), "", None, 2.0, False),
        (exif_time(T_S, 2), "+02:00", T_S - 900, 5.0, False),  # its own statement comes first
        (exif_time(T_S, 2), "no", T_S, None, True),
        ("", "", T_S, None, True),
    ],
)
def test_photograph_is_placed_by_its_exif_data(
    tmp_path: Path, taken: str, zone: str, fix_s: int | None, offset_h: float | None, warned: bool
) -> None:
    path = write_photo(tmp_path / "door.jpg", (-33.5, -70.25), taken, zone, fix_s)
    content = read(path, utc_offset_h=offset_h)
    (point,) = content.tracks[0].points
    assert point.t_ns == in_ns(T_S)
    assert (point.lat_deg, point.lon_deg) == pytest.approx((-33.5, -70.25), abs=1e-6)
    assert content.picture is not None
    assert content.picture.startswith(b"\xff\xd8")
    assert len(content.picture) < path.stat().st_size
    assert b"Exif" not in content.picture
    assert bool(content.warnings) == warned


def test_unusable_file_is_refused_with_what_to_do(tmp_path: Path) -> None:
    place = (52.0, 4.0)
    refusals = {
        write_photo(tmp_path / "a.jpg", None, exif_time(T_S), "+00:00"): "take the original file",
        write_photo(tmp_path / "b.jpg", place): "do not say when",
        write_photo(tmp_path / "c.jpg", place, exif_time(T_S)): "--utc-offset-h",
        write_gpx(tmp_path / "d.gpx", "x", line(T_S, 9), is_timed=False): "with times",
        write_gpx(tmp_path / "e.gpx", "x", []): "no point of it",
    }
    contents = {
        "bomb.gpx": (BOMB.encode(), "entities"),
        "deep.kml": (b"<kml>" + b"<Folder>" * 200, "deep"),
        "a.kmz": (b"PK\x03\x04....", "unpack it"),
        "a.gpx.gz": (b"\x1f\x8b......", "unpack it"),
        "a.heic": (b"\0\0\0\x18ftypheic....", "JPEG"),
        "half.jpg": (b"\xff\xd8\xff\xe1....", "no picture"),
        "empty": (b"", "nothing that can be brought in"),
        "a.svg": (b"<svg/>", "nothing that can be brought in"),
        "foreign.mcap": (b"\x89MCAP0\r\n" + bytes(64), "nothing in it is of Muster"),
    }
    for name, (content, words) in contents.items():
        path = tmp_path / name
        path.write_bytes(content)
        refusals[path] = words
    for path, words in refusals.items():
        assert words in refusal(path), path.name


def test_file_that_is_too_large_is_not_read(tmp_path: Path) -> None:
    path = tmp_path / "large.gpx"
    with path.open("wb") as file:
        file.truncate(MOST_BYTES + 1)
    assert "at most 512" in refusal(path)


def test_parts_of_a_log_and_recordings_of_units_are_refused(tmp_path: Path) -> None:
    script = Script()
    script.register("FF-01")
    for number in range(2):
        script.act(OpenIncident(f"i{number}", "", beside_others=True))
    for name, records, words in (
        ("log", script.records, "a part of a station's log"),
        ("unit", [(1, "muster/v1/FF-01/raw/x", b"")], "a recording of a unit"),
    ):
        writer = SegmentWriter(tmp_path / name)
        for record in records:
            writer.write(*record)
        writer.close()
        (path,) = (tmp_path / name).glob("*.mcap")
        assert words in refusal(path)


def test_torn_incident_is_read_without_names(tmp_path: Path) -> None:
    script = Script()
    script.register("FF-01")
    script.act(SetAnchor(52.0, 4.0, 0.0, 0.0))
    script.act(OpenIncident("north-1", "Mill Lane"))
    for second in range(30):
        script.now_s += 1.0
        script.position("FF-01", float(second), 0.0, distance_m=float(second))
        script.tick()
    writer = SegmentWriter(tmp_path / "log")
    for record in records_with_fused(script):
        writer.write(*record)
    writer.close()
    (path,) = (tmp_path / "log").glob("*.mcap")
    content = read(path)
    assert [track.name for track in content.tracks] == ["FF-01, Mill Lane"]
    assert len(content.tracks[0].points) >= 28
    assert "not complete" in content.warnings[0]


@pytest.mark.slow
def test_file_is_read_in_a_process_of_its_own(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = write_gpx(tmp_path / "drone.gpx", "Drone", line(T_S, 60))
    options = ImportOptions("drone.gpx", "i1")
    assert content_of(path, options) == read(path)
    path.write_text(BOMB)
    with pytest.raises(UserError, match="entities"):
        content_of(path, options)
    monkeypatch.setattr(sys, "executable", "/bin/false")
    with pytest.raises(UserError, match="may be damaged"):
        content_of(path, options)
    monkeypatch.setattr(
        subprocess, "run", lambda *_, **__: (_ for _ in ()).throw(subprocess.TimeoutExpired("x", 1))
    )
    with pytest.raises(UserError, match="too long"):
        content_of(path, options)
