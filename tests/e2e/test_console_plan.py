"""Work on the plan at the console: pins, trails, its place on the Earth.

One story in several tests: they run in the order in which they stand here.
"""

from __future__ import annotations

import re
from functools import partial
from pathlib import Path

import pytest
from PIL import Image
from playwright.sync_api import Locator, Page, expect

from tests.e2e.conftest import UNIT
from tests.e2e.console_page import (
    answer_to,
    barriers,
    click_plan,
    confirm,
    drag,
    drawn,
    menu,
    painted,
    pins,
)
from tests.e2e.enlisting import NAME
from tests.rig.waiting import until


def test_a_pin_is_set_with_a_click_dragged_and_removed(page: Page, card: Locator) -> None:
    card.get_by_role("button", name=NAME).click()
    card.get_by_role("button", name="Correct position …").click()
    form = page.get_by_role("form", name=f"Pin: {NAME}")
    click_plan(page, -150, -80)
    expect(form.get_by_label("North, m")).not_to_have_value("")
    form.get_by_label("Accuracy").select_option("4")
    form.get_by_role("button", name="Set pin").click()
    expect(form).to_have_count(0)
    (pin,) = pins(page)
    assert (pin["unit_id"], pin["std_m"], pin["by"]) == (UNIT, 2.0, "admin")
    expect(page.get_by_text("Pins 1")).to_be_visible()
    page.get_by_role("button", name="Pins 1").click()
    page.get_by_role("button", name=f"{NAME} here").click()
    drawn(page)
    moved = drag(page, (-150, -80), (-90, -40))
    kept = ("pin_id", "unit_id", "t_ms", "std_m", "floor", "note")
    assert {name: moved[name] for name in kept} == {name: pin[name] for name in kept}
    right_m, down_m = moved["east_m"] - pin["east_m"], pin["north_m"] - moved["north_m"]
    assert right_m > 0.1  # how much ground 60 pixels are depends on what is on the screen
    assert down_m == pytest.approx(right_m * 40 / 60, rel=0.1)
    expect(form.get_by_label("East, m")).to_have_value(f"{moved['east_m']:.1f}")
    confirm(form, "Remove pin")
    expect(form).to_have_count(0)
    assert pins(page) == []


def draws(page: Page, colour: str, than: int) -> bool:
    return painted(page, colour) > than + 50


def draws_no_more(page: Page, colour: str, than: int) -> bool:
    return not draws(page, colour, than)


def test_each_kind_of_trail_is_drawn_and_removed(page: Page, card: Locator) -> None:
    incident_id = answer_to(page, "incidents")[0]["incident_id"]
    trails = f"incidents/{incident_id}/trails?kind=raw"
    until(lambda: len(answer_to(page, trails)["trails"][0]["points"]) > 1, "somebody has walked")
    card.get_by_role("button", name=NAME).click()
    drawn(page)
    page.get_by_role("button", name="Trails").click()
    kinds = page.get_by_role("region", name="Trails")
    kinds.get_by_label("Live track").uncheck()  # it lies above the others
    for word, kind, colour in (
        ("Dead-reckoning only", "raw", "--quiet"),
        ("Post-processed", "smoothed", "--watch"),
    ):
        before = painted(page, colour)
        with page.expect_response(re.compile(rf"trails\?kind={kind}")) as stated:
            kinds.get_by_label(word).check()
        (trail,) = stated.value.json()["trails"]
        assert (trail["unit_id"], len(trail["points"]) > 1) == (UNIT, True)
        expect(kinds).not_to_contain_text("is worked out")
        until(partial(draws, page, colour, before), kind)
        kinds.get_by_label(word).uncheck()
        until(partial(draws_no_more, page, colour, before), f"no {kind}")
    kinds.get_by_label("Live track").check()
    kinds.get_by_role("button", name="Close").click()


def test_escape_ends_a_plan_tool(page: Page, card: Locator) -> None:
    page.get_by_role("button", name="Set common start").click()
    form = page.get_by_role("form", name="Set common start")
    expect(form).to_contain_text(NAME)
    page.keyboard.press("Escape")
    expect(form).to_have_count(0)


def test_common_position_is_set_at_the_start_or_now(page: Page, card: Locator) -> None:
    for when, is_now in (("at the start", False), ("now", True)):
        page.get_by_role("button", name="Set common start").click()
        form = page.get_by_role("form", name="Set common start")
        click_plan(page, -150, -80)
        form.get_by_label("When").select_option(label=when)
        form.get_by_role("button", name="Set start").click()
        expect(form).to_have_count(0)
        (pin,) = pins(page)
        assert pin["kind"] == "start"
        assert (abs(pin["set_ms"] - pin["t_ms"]) < 60_000) == is_now
        page.get_by_role("button", name="Pins 1").click()
        page.get_by_role("button", name=f"{NAME} here").click()
        confirm(page.get_by_role("form", name=f"Pin: {NAME}"), "Remove pin")
        expect(page.get_by_text("Pins 1")).to_have_count(0)


def test_plan_is_georeferenced_with_two_clicks(page: Page, card: Locator) -> None:
    for _ in range(2):
        page.get_by_role("button", name="Zoom out").click()
    menu(page, "Site").get_by_role("button", name="Align by two points").click()
    form = page.get_by_role("form", name="Plan location")
    click_plan(page, -150, 60)
    click_plan(page, 150, -60)
    (south_m, west_m), (north_m, east_m) = clicked_places(form)
    per_degree_m = 111_319.5  # on the equator, east
    fill_point(form, 0, 0.0, 16.0)
    fill_point(
        form, 1, 2 * (north_m - south_m) / 110_574.3, 16.0 + (east_m - west_m) / per_degree_m
    )
    form.get_by_role("button", name="Save location").click()
    expect(form.get_by_role("alert")).to_contain_text("m apart on the plan")
    fill_point(form, 1, (north_m - south_m) / 110_574.3, 16.0 + (east_m - west_m) / per_degree_m)
    form.get_by_role("button", name="Save location").click()
    expect(form).to_have_count(0)
    anchor = answer_to(page, "site/anchor")
    assert anchor["lat_deg"] * 110_574.3 == pytest.approx(-south_m, abs=0.5)
    assert (anchor["lon_deg"] - 16.0) * per_degree_m == pytest.approx(-west_m, abs=0.5)
    assert anchor["plan_rotation_rad"] == pytest.approx(0.0, abs=0.01)


def test_plan_is_georeferenced_by_an_uploaded_map(
    page: Page, card: Locator, tmp_path: Path
) -> None:
    """Two clicks on the plan and two on the map; then the map lies behind the plan."""
    picture, world = tmp_path / "ground.png", tmp_path / "ground.pgw"
    Image.new("RGB", (400, 200), (60, 110, 60)).save(picture)
    per_degree_m = 111_319.5
    pixel = 0.5 / per_degree_m  # half a metre
    world.write_text(f"{pixel}\n0\n0\n{-pixel}\n16.0\n0.0\n")
    site = menu(page, "Site")
    site.get_by_label("Picture").set_input_files(picture)
    site.get_by_label("World file").set_input_files(world)
    site.get_by_role("button", name="Set base map").click()
    expect(site.get_by_role("button", name="Remove base map")).to_be_visible()
    site.get_by_role("button", name="Align by two points").click()
    form = page.get_by_role("form", name="Plan location")
    click_plan(page, -150, 60)
    click_plan(page, 150, -60)
    (south_m, west_m), (north_m, east_m) = clicked_places(form)
    box = form.get_by_alt_text("Base map").bounding_box()
    assert box is not None
    scale = box["width"] / 200.0  # pixels a metre on the screen
    across, down = 20.0, box["height"] - 10.0
    ground = form.get_by_alt_text("Base map")
    for to_east_m, to_north_m in ((0.0, 0.0), (east_m - west_m, north_m - south_m)):
        at = {"x": across + to_east_m * scale, "y": down - to_north_m * scale}
        ground.click(position=at)  # type: ignore[arg-type]  # of Playwright's own
    form.get_by_role("button", name="Save location").click()
    page.wait_for_timeout(600)  # two presses in haste would be one
    form.get_by_role("button", name="Yes, replace location").click()
    expect(form).to_have_count(0)
    anchor = answer_to(page, "site/anchor")
    assert anchor["plan_rotation_rad"] == pytest.approx(0.0, abs=0.05)
    lon_m = (anchor["lon_deg"] - 16.0) * per_degree_m
    assert lon_m == pytest.approx(across / scale - west_m, abs=2.0)
    page.wait_for_function("document.querySelector('canvas.base-map')?.width > 0")
    assert barriers(page) == []
    confirm(menu(page, "Site"), "Remove base map")
    expect(page.get_by_role("button", name="Remove base map")).to_have_count(0)
    page.keyboard.press("Escape")


def clicked_places(form: Locator) -> list[tuple[float, float]]:
    """North and east, as the panel says them."""
    stated = form.text_content() or ""
    found = re.findall(r"([\d.]+)\s+m (north|south), ([\d.]+)\s+m (east|west)", stated)
    assert len(found) == 2
    return [
        (
            float(along) * (1 if way == "north" else -1),
            float(across) * (1 if side == "east" else -1),
        )
        for along, way, across, side in found
    ]


def fill_point(form: Locator, index: int, lat_deg: float, lon_deg: float) -> None:
    form.get_by_label("Latitude, °").nth(index).fill(f"{lat_deg:.9f}")
    form.get_by_label("Longitude, °").nth(index).fill(f"{lon_deg:.9f}")
