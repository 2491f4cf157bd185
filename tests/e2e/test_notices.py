"""A notice comes below the page, and nothing that is about to be pressed moves."""

from __future__ import annotations

from pathlib import Path

import pytest
from playwright.sync_api import Page, expect

from tests.e2e import scenes
from tests.e2e.layout_checks import flaws
from tests.e2e.stage import Stage

REFUSED = {
    "type": "about:blank",
    "title": "Conflict",
    "status": 409,
    "detail": "The log takes nothing now; try it again.",
    "code": "",
    "parameters": {},
}
BOXES = """
() => [...document.querySelectorAll(".plan :is(.zoom, .plan-tools, .floors) button")]
  .filter((one) => one.checkVisibility())
  .map((one) => [one.ariaLabel ?? one.textContent, one.getBoundingClientRect().toJSON()])
"""
MAP_PX = "() => document.querySelector('.map').clientHeight"


@pytest.mark.parametrize("screen", ["laptop", "large", "tablet", "phone", "phone on its side"])
def test_buttons_of_the_plan_stay_as_a_notice_comes_and_goes(
    stage: Stage, screen: str, tmp_path: Path
) -> None:
    page, _ = stage.open(scenes.bad_minute(), screen)
    page.route("**/acknowledge", lambda route: route.fulfill(status=409, json=REFUSED))
    if "phone" in screen:
        page.get_by_role("button", name="Plan").first.click()
    page.wait_for_timeout(500)
    before, high_px = page.evaluate(BOXES), page.evaluate(MAP_PX)
    assert {"Zoom in", "Zoom out", "Fit"} < {name for name, _ in before}
    be_refused(page)
    page.screenshot(path=tmp_path / f"{screen}.png")
    assert page.evaluate(MAP_PX) < high_px, "the notice takes its height from the plan"
    assert page.evaluate(BOXES) == before
    assert flaws(page) == []
    page.get_by_role("alert").get_by_role("button", name="OK").click()
    expect(page.locator(".notice")).to_have_count(0)
    assert page.evaluate(BOXES) == before


def be_refused(page: Page) -> None:
    page.wait_for_timeout(600)  # a press in haste is ignored
    page.get_by_role("button", name="Acknowledge").first.click()
    expect(page.locator(".notice")).to_contain_text("The log takes nothing now")
