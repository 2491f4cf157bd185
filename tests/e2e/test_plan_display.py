"""The plan: whom it names, which floor it shows, and what its tools take no more."""

from __future__ import annotations

from collections.abc import Callable

import msgspec
import pytest
from playwright.sync_api import expect

from base_station.views.wire import Snapshot
from tests.e2e import scenes
from tests.e2e.console_page import PLAN_MOVES_MS, painted, painted_at_edges, press
from tests.e2e.stage import Stage


@pytest.mark.parametrize("screen", ["laptop", "tablet", "phone"])
@pytest.mark.parametrize("scene", [scenes.at_the_edges, scenes.pins_at_the_edges])
def test_name_at_the_edge_of_the_plan_is_complete(
    stage: Stage, scene: Callable[[], Snapshot], screen: str
) -> None:
    page, _ = stage.open(scene(), screen)
    if screen == "phone":
        page.get_by_role("button", name="Plan").first.click()
    page.wait_for_timeout(1500)  # the plan has come to rest
    edges = painted_at_edges(page, "--text")
    assert edges == {"left": 0, "right": 0, "top": 0, "bottom": 0}


def test_floor_shows_its_number_of_endangered_members(stage: Stage) -> None:
    page, _ = stage.open(scenes.crowd())
    floors = page.get_by_role("group", name="Floor shown").get_by_role("button")
    expect(floors.nth(0)).to_have_accessible_name("Floor 1, 1 in danger, of 20 people")
    expect(floors.nth(1)).to_have_accessible_name("Floor G, 20 people")


def test_zoom_by_keyboard_is_kept_until_reset(stage: Stage) -> None:
    page, station = stage.open(scenes.quiet())
    scale = page.locator(".ol-scale-line-inner")
    expect(scale).to_have_text("10 m")
    page.get_by_role("application", name="Plan of the site").focus()
    for _ in range(3):
        page.keyboard.press("+")
        page.wait_for_timeout(400)
    close_up = scale.inner_text()
    station.change(now_ms=scenes.NOW_MS + 1000)
    page.wait_for_timeout(1500)
    assert scale.inner_text() == close_up != "10 m"
    page.get_by_role("button", name="Fit").click()
    expect(scale).to_have_text("10 m")


# Collects each scale that the plan comes to.
_WATCH_SCALES = """
window.scales = [];
new MutationObserver(() => {
  const scale = document.querySelector(".ol-scale-line-inner").style.width;
  if (scale !== window.scales.at(-1)) window.scales.push(scale);
}).observe(document.querySelector(".ol-scale-line"), { subtree: true, attributes: true });
"""
_GROUND = "document.querySelector('.map canvas:not(.people-canvas)').toDataURL()"


def test_choosing_a_member_moves_the_plan_at_once_and_only_where_it_must(stage: Stage) -> None:
    """Each step of a glide would draw the whole map."""
    page, _ = stage.open(msgspec.structs.replace(scenes.quiet(), plan=None), "large")
    for _ in range(4):
        page.get_by_role("button", name="Zoom out").click()
        page.wait_for_timeout(400)
    far = page.evaluate(_GROUND)
    page.evaluate(_WATCH_SCALES)
    press(page.locator(".card-head").nth(0))
    page.wait_for_timeout(PLAN_MOVES_MS)
    assert len(page.evaluate("window.scales")) == 1
    near = page.evaluate(_GROUND)
    assert near != far
    mira = page.locator(".card").filter(has_text="Mira Okafor")  # some metres away: seen already
    press(mira.locator(".card-head"))
    page.wait_for_timeout(PLAN_MOVES_MS)
    expect(page.locator(".card.chosen")).to_contain_text("Mira Okafor")
    assert page.evaluate(_GROUND) == near
    assert len(page.evaluate("window.scales")) == 1


def test_unavailable_plan_tool_takes_no_clicks(stage: Stage) -> None:
    page, station = stage.open(scenes.bad_minute())
    page.get_by_role("button", name="Pins 2").click()
    page.get_by_role("button", name="Astrid Lindqvist here").click()
    expect(page.locator(".map.placing")).to_have_count(1)
    station.change(pins=())  # somebody else has removed it
    expect(page.get_by_role("form")).to_have_count(0)
    expect(page.locator(".map.placing")).to_have_count(0)


def test_conflicting_pins_are_first_and_show_their_floors(stage: Stage) -> None:
    """Two of the same minute are told apart."""
    pins = tuple(
        msgspec.structs.replace(
            scenes.pin(state, 0, state, 3.0, "3 m above" if floor else ""), floor=floor
        )
        for state, floor in (("used", 0), ("waiting", None), ("conflict", 1))
    )
    page, _ = stage.open(msgspec.structs.replace(scenes.quiet(), pins=pins))
    page.get_by_role("button", name="Pins 3").click()
    rows = page.get_by_role("region", name="Pins").get_by_role("listitem")
    expect(rows).to_have_count(3)
    expect(rows.nth(0)).to_contain_text("Astrid Lindqvist here, floor 1")
    expect(rows.nth(0)).to_contain_text("in conflict")
    expect(rows.nth(1)).to_contain_text("Astrid Lindqvist here, ground floor")
    expect(rows.nth(2)).to_contain_text("waits")
    rows.nth(0).get_by_role("button").click()
    expect(page.get_by_role("form", name="Pin: ")).to_contain_text("3 m above. Set by")


def test_selected_pin_stays_on_its_floor(stage: Stage) -> None:
    """Whichever floor is shown, and where nobody is on its own."""
    pins = tuple(
        msgspec.structs.replace(scenes.pin(str(index), index, "used", 3.0, ""), floor=floor)
        for index, floor in enumerate((None, 4))
    )
    page, _ = stage.open(msgspec.structs.replace(scenes.quiet(), pins=pins))
    for name, floor in (("Astrid Lindqvist", ""), ("Jonas Bergman", "4")):
        page.get_by_role("button", name="Pins 2").click()
        page.get_by_role("button", name=f"{name} here").click()
        expect(page.get_by_role("combobox", name="Floor")).to_have_value(floor)


def test_marks_of_other_floors_are_hollow(stage: Stage) -> None:
    """Drawn as those on the floor shown, casualties were looked for on the wrong one."""
    page, _ = stage.open(scenes.bad_minute())
    floors = page.get_by_role("group", name="Floor shown")
    red = {}
    for floor in ("Floor 1", "Floor G"):
        floors.get_by_role("button", name=floor).click()
        page.wait_for_timeout(800)
        red[floor] = painted(page, "--immediate")
    assert 0 < red["Floor G"] < 0.8 * red["Floor 1"], red
