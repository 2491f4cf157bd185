"""A picture of the ground: uploaded by an administrator, re-encoded, and placed on the Earth."""

from __future__ import annotations

import io

import pytest
from PIL import Image

from base_station.accounts.principals import Role
from base_station.site.base_map import corners_of
from shared.errors import ConfigError
from tests.rig.in_process_station import InProcessStation

# A degree of latitude is 111 km: 200 by 100 pixels of a metre, north up.
WORLD = (1.6e-5, 0.0, 0.0, -9e-6, 4.0, 52.0)


def picture(form: str = "PNG", size: tuple[int, int] = (200, 100)) -> bytes:
    written = io.BytesIO()
    Image.new("RGB", size, (40, 90, 40)).save(written, form)
    return written.getvalue()


def address(world: tuple[float, ...] = WORLD, crs: str = "EPSG:4326") -> str:
    numbers = "&".join(f"world={value}" for value in world)
    return f"/site/base-map?{numbers}&crs={crs}"


PNG = {"Content-Type": "image/png"}


async def test_map_is_set_read_and_removed(station: InProcessStation) -> None:
    async with station.client(Role.ADMINISTRATOR) as admin:
        assert (await admin.get("/site/base-map")).json() is None
        answer = await admin.put(address(), content=picture(), headers=PNG)
        assert answer.status_code == 200, answer.text
        reported = answer.json()
        assert reported["upper_left"] == pytest.approx([52.0 + 4.5e-6, 4.0 - 8e-6])
        assert reported["upper_right"] == pytest.approx([52.0 + 4.5e-6, 4.0 + 199.5 * 1.6e-5])
        assert reported["lower_left"] == pytest.approx([52.0 - 99.5 * 9e-6, 4.0 - 8e-6])
        assert (await admin.get("/site/base-map")).json() == reported
        image = await admin.get(reported["image_url"].removeprefix("/api/v1"))
        assert image.headers["content-type"] == "image/webp"
        assert image.headers["x-content-type-options"] == "nosniff"
        assert image.headers["cache-control"] == "private, max-age=86400"
        assert Image.open(io.BytesIO(image.content)).size == (200, 100)
        assert (await admin.delete("/site/base-map")).status_code == 204
        assert (await admin.delete("/site/base-map")).status_code == 404
        gone = await admin.get(reported["image_url"].removeprefix("/api/v1"))
        assert gone.status_code == 404


async def test_large_map_is_scaled_down_with_unchanged_corners(station: InProcessStation) -> None:
    world = (8e-6, 0.0, 0.0, -4.5e-6, 4.0, 52.0)
    async with station.client(Role.ADMINISTRATOR) as admin:
        answer = await admin.put(address(world), content=picture("JPEG", (8192, 4096)), headers=PNG)
        reported = answer.json()
        corners = corners_of(world, "EPSG:4326", 8192, 4096)
        for name in ("upper_left", "upper_right", "lower_left"):
            assert reported[name] == pytest.approx(getattr(corners, name), abs=1e-9)
        image = await admin.get(reported["image_url"].removeprefix("/api/v1"))
        assert max(Image.open(io.BytesIO(image.content)).size) == 4096


@pytest.mark.parametrize(
    ("content", "world", "why"),
    [
        (b"<svg onload='x'/>", WORLD, "cannot be read"),
        (picture("GIF"), WORLD, "cannot be read"),
        (picture()[:60], WORLD, "cannot be read"),
        (picture(), (1.0, 0.0, 0.0, -1.0, 500_000.0, 5_700_000.0), "nowhere on the Earth"),
        (picture(), (1e-3, 0.0, 0.0, -1e-3, 4.0, 52.0), "make sense"),
        (picture(), (1.6e-5, 0.0, 1.6e-5, 0.0, 4.0, 52.0), "a line"),
    ],
)
async def test_invalid_map_is_refused_with_a_reason(
    station: InProcessStation, content: bytes, world: tuple[float, ...], why: str
) -> None:
    async with station.client(Role.ADMINISTRATOR) as admin:
        answer = await admin.put(address(world), content=content, headers=PNG)
        assert answer.status_code == 422
        assert why in answer.json()["detail"]
        assert (await admin.get("/site/base-map")).json() is None


@pytest.mark.parametrize("world", [WORLD[:5], (*WORLD, 1.0)])
async def test_a_world_file_has_six_numbers(
    station: InProcessStation, world: tuple[float, ...]
) -> None:
    async with station.client(Role.ADMINISTRATOR) as admin:
        answer = await admin.put(address(world), content=picture(), headers=PNG)
        assert answer.status_code == 422


async def test_map_is_set_by_administrators_only(station: InProcessStation) -> None:
    async with station.client(Role.COMMANDER) as commander:
        answer = await commander.put(address(), content=picture(), headers=PNG)
        assert answer.status_code == 403
        assert (await commander.delete("/site/base-map")).status_code == 403
        assert (await commander.get("/site/base-map")).status_code == 200


async def test_map_of_a_survey_is_placed_in_its_utm_zone(station: InProcessStation) -> None:
    world = (0.2, 0.0, 0.0, -0.2, 500_000.1, 5_761_038.1)  # on the meridian, 9 degrees east
    async with station.client(Role.ADMINISTRATOR) as admin:
        answer = await admin.put(address(world, "EPSG:25832"), content=picture(), headers=PNG)
        assert answer.status_code == 200, answer.text
        assert answer.json()["upper_left"] == pytest.approx([52.0, 9.0], abs=1e-5)
        for crs in ("EPSG:31467", "UTM 32"):
            answer = await admin.put(address(world, crs), content=picture(), headers=PNG)
            assert answer.status_code == 422
            assert "UTM zone" in answer.json()["detail"]


def test_web_mercator_metres_are_converted() -> None:
    x, y = 445_277.963, 6_800_125.454  # 4 degrees east, 52 degrees north
    corners = corners_of((1.0, 0.0, 0.0, -1.0, x, y), "EPSG:3857", 200, 100)
    assert corners.upper_left == pytest.approx((52.0, 4.0), abs=1e-5)
    assert corners.lower_left[0] < corners.upper_left[0]


def test_invalid_numbers_of_a_world_file_are_refused() -> None:
    for value in (float("nan"), float("inf"), 1e300):
        with pytest.raises(ConfigError):
            corners_of((1.6e-5, 0.0, 0.0, -9e-6, 4.0, value), "EPSG:4326", 200, 100)
