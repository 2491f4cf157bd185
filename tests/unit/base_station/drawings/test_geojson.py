"""Ordinary GeoJSON and IMDF become plans in site metres."""

from __future__ import annotations

import io
import zipfile
from typing import Any

import msgspec
import pytest

from base_station.drawings.draft import Draft, Options
from base_station.drawings.reader import read_drawing
from base_station.site.plan import check_plan
from shared.errors import UserError

LAT, LON = 57.7, 11.97
_RING = [[LON, LAT], [LON + 4e-4, LAT], [LON + 4e-4, LAT + 2e-4], [LON, LAT + 2e-4], [LON, LAT]]


def feature(kind: str, coordinates: Any, one_id: str = "", **properties: Any) -> dict[str, Any]:
    geometry = {"type": kind, "coordinates": coordinates}
    return {"type": "Feature", "id": one_id, "properties": properties, "geometry": geometry}


def collection(*features: dict[str, Any]) -> bytes:
    return msgspec.json.encode({"type": "FeatureCollection", "features": features})


def read(content: bytes) -> tuple[Draft, dict[str, Any]]:
    draft = read_drawing(content, Options("House"))
    assert draft.plan is not None
    check_plan(msgspec.json.encode(draft.plan))
    return draft, draft.plan


def test_an_indoor_map_of_openstreetmap() -> None:
    draft, plan = read(
        b"\xef\xbb\xbf"
        + collection(
            feature("Polygon", [_RING], building="yes"),
            feature("LineString", _RING[:2], level="1"),
            feature("Polygon", [_RING], indoor="room", level="1", name="Archive"),
            feature("Point", [LON, LAT], entrance="main"),
        )
    )
    assert (draft.lat_deg, draft.lon_deg) == pytest.approx((LAT + 1e-4, LON + 2e-4))
    kinds = [(one["properties"]["kind"], one["properties"]["floor"]) for one in plan["features"]]
    assert kinds == [("outline", 0), ("wall", 1), ("room", 1)]
    (left, bottom), (right, _), (_, top) = plan["features"][0]["geometry"]["coordinates"][0][:3]
    assert right - left == pytest.approx(23.9, abs=0.1)  # 4e-4 degrees at 57.7 degrees north
    assert top - bottom == pytest.approx(22.3, abs=0.1)
    assert "1 of its features" in draft.notes[0]


def imdf(**parts: bytes) -> bytes:
    written = io.BytesIO()
    with zipfile.ZipFile(written, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in parts.items():
            archive.writestr(f"venue/{name}.geojson", content)
    return written.getvalue()


def test_imdf_has_floors_by_level() -> None:
    draft, plan = read(
        imdf(
            level=collection(feature("Polygon", [_RING], "L1", ordinal=1)),
            unit=collection(
                feature("Polygon", [_RING], level_id="L1", category="room", name={"en": "Hall"}),
                feature("Polygon", [_RING], level_id="L1", category="stairs"),
            ),
            opening=collection(feature("LineString", _RING[:2], level_id="L1")),
            amenity=b"not looked at",
        )
    )
    kinds = [(one["properties"]["kind"], one["properties"]["floor"]) for one in plan["features"]]
    assert kinds == [("outline", 1), ("room", 1), ("stairs", 1), ("door", 1)]
    assert plan["muster"]["floors"] == [{"floor": 1, "down_m": -3.2}]
    assert "no walls" in draft.notes[0]


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        (b"{", "is no JSON"),
        (b'{"type": "Topology"}', "no GeoJSON FeatureCollection"),
        (collection(feature("Point", [1, 2])), "no line and no area"),
        (collection(feature("LineString", [[400_000, 6_400_000], [400_010, 0]])), "EPSG:4326"),
        (collection(feature("LineString", [["a", 1], [1, 1]])), "no numbers"),
        (collection(feature("LineString", [[0, 0], [50, 50]])), "send one building"),
        (imdf(unit=collection()), "no level.geojson"),
        (b"PK\x03\x04", "cannot be read"),
        (b"AC1032", "save it as DXF"),
    ],
)
def test_file_that_is_no_plan_is_refused(content: bytes, reason: str) -> None:
    with pytest.raises(UserError, match=reason):
        read_drawing(content, Options())
