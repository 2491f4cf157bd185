"""Stacked floors in three dimensions: loaded on demand, turned by keys, marks of the section."""

from __future__ import annotations

import re
from collections.abc import Callable
from io import BytesIO
from pathlib import Path

import pytest
from PIL import Image
from playwright.sync_api import Locator, Page, Request, expect

from tests.e2e import scenes
from tests.e2e.console_page import barriers, to_plan_of_a_phone
from tests.e2e.layout_checks import flaws
from tests.e2e.stage import Stage
from tests.e2e.tower_scene import tower
from tests.rig.pacing import wait_until

SHOWN = {"muster-section": "on", "muster-section-view": "stacked"}
NO_WEBGL = """
() => { HTMLCanvasElement.prototype.getContext = new Proxy(HTMLCanvasElement.prototype.getContext, {
  apply: (get, canvas, [kind, ...more]) =>
    kind.startsWith("webgl") ? null : Reflect.apply(get, canvas, [kind, ...more]),
}); }
"""
DRAWING_ALONE = ".stack-view > :not(canvas) { visibility: hidden }"


def stack(page: Page) -> Locator:
    return page.get_by_role("region", name="Stacked floors")


def drawing(page: Page) -> Locator:
    return stack(page).get_by_role("application")


def marks(page: Page) -> Locator:
    return stack(page).locator(".section-mark")


def is_drawn(page: Page) -> bool:
    picture = Image.open(BytesIO(drawing(page).screenshot(style=DRAWING_ALONE)))
    return len(picture.convert("RGB").getcolors(1 << 24) or ()) > 1


def places(page: Page) -> list[str | None]:
    return [one.get_attribute("style") for one in marks(page).all()]


@pytest.mark.parametrize(
    ("theme", "screen"),
    [("light", "phone"), ("light", "phone on its side"), ("dark", "laptop"), ("red", "large")],
)
def test_a_hundred_people_are_legible_everywhere(
    stage: Stage, tmp_path: Path, theme: str, screen: str
) -> None:
    page, _ = stage.open(tower(100), screen, kept={**SHOWN, "muster-theme": theme})
    to_plan_of_a_phone(page)
    jonas = marks(page).filter(has_text="Jonas Bergman, in danger")
    expect(jonas).to_be_in_viewport()
    page.screenshot(path=tmp_path / f"{theme}-{screen}.png")
    assert flaws(page) == []
    assert barriers(page) == []


def test_stacked_view_is_loaded_on_demand(stage: Stage) -> None:
    page, _ = stage.open(tower(12), kept={"muster-section": "on"})
    expect(page.get_by_role("region", name="Side section")).to_be_visible()
    loaded: list[str] = []

    def note(request: Request) -> None:
        loaded.append(request.url)

    page.on("request", note)
    page.get_by_role("combobox", name="Shown").select_option("stacked in 3D")
    expect(marks(page).first).to_be_visible()
    assert [one for one in loaded if re.search(r"/assets/.*\.js$", one)]
    assert is_drawn(page)
    page.get_by_role("combobox", name="Shown").select_option("from the side")
    expect(page.get_by_role("region", name="Side section")).to_be_visible()


@pytest.mark.parametrize(
    "turn",
    [
        lambda page: page.keyboard.press("ArrowLeft"),
        lambda page: page.keyboard.press("ArrowUp"),
        lambda page: page.keyboard.press("+"),
        lambda page: page.mouse.wheel(0, 300),
        lambda page: page.get_by_role("combobox", name="Heights").select_option(index=2),
    ],
    ids=["arrow left", "arrow up", "plus", "wheel", "heights"],
)
def test_marks_follow_the_rotation(stage: Stage, turn: Callable[[Page], None]) -> None:
    page, _ = stage.open(tower(12), kept=SHOWN)
    expect(marks(page).first).to_be_visible()
    before = places(page)
    drawing(page).focus()
    drawing(page).hover(position={"x": 20, "y": 20})
    turn(page)
    wait_until("the marks have moved", lambda: places(page) != before)


def test_press_chooses_a_member(stage: Stage) -> None:
    page, _ = stage.open(tower(12), kept=SHOWN)
    mark = marks(page).filter(has_text="Jonas Bergman, in danger")
    mark.focus()
    page.keyboard.press("Enter")
    expect(mark).to_have_attribute("aria-pressed", "true")
    expect(page.locator(f"[data-unit='{scenes.unit_id(1)}'].chosen").first).to_be_visible()


def test_building_without_a_plan_shows_learnt_floors(stage: Stage) -> None:
    page, _ = stage.open(tower(12, with_plan=False), kept=SHOWN)
    floors = stack(page).locator(".stack-view > ul > li")
    expect(floors.filter(has_text="floor 3")).to_contain_text("Jonas Bergman, in danger")
    assert is_drawn(page)


def test_browser_without_webgl_is_referred_to_the_side_section(stage: Stage) -> None:
    page, _ = stage.open(tower(12), kept={"muster-section": "on"})
    page.evaluate(NO_WEBGL)
    page.get_by_role("combobox", name="Shown").select_option("stacked in 3D")
    expect(stack(page).get_by_role("status")).to_contain_text("WebGL")
    page.get_by_role("combobox", name="Shown").select_option("from the side")
    expect(page.get_by_role("region", name="Side section")).to_be_visible()
