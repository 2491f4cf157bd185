"""Elements of a phone's dialog stay in place while the rest of it comes in."""

from __future__ import annotations

import msgspec
import pytest
from playwright.sync_api import Route, expect

from tests.e2e import scenes
from tests.e2e.stage import Stage

KEEP_PLACES = """
(dialog) => {
  const all = [...dialog.querySelectorAll("button, input, select")];
  window.places = all.filter((one) => one.checkVisibility())
    .map((one) => [one, one.getBoundingClientRect().top]);
}
"""
MOVED = """
() => window.places
  .filter(([one, top]) => one.isConnected && Math.abs(one.getBoundingClientRect().top - top) > 1)
  .map(([one]) => one.textContent || one.name)
"""


@pytest.mark.parametrize("screen", ["phone", "phone on its side"])
@pytest.mark.parametrize("is_open", [True, False], ids=["incident", "no incident"])
def test_controls_keep_their_place_as_answers_arrive(
    stage: Stage, screen: str, is_open: bool
) -> None:
    picture = scenes.bad_minute()
    page, _ = stage.open(
        picture if is_open else msgspec.structs.replace(picture, incident=None), screen
    )
    held: list[Route] = []

    def hold(route: Route) -> None:
        held.append(route)

    entries = page.locator("#menu button")
    for number in range(entries.count()):
        page.route("**/api/v1/**", hold)
        page.locator(".menu-button").click()
        entries.nth(number).click()
        dialog = page.get_by_role("dialog")
        dialog.get_by_role("button").first.wait_for()
        page.wait_for_timeout(300)
        dialog.evaluate(KEEP_PLACES)
        high_px = dialog.evaluate("shown => shown.scrollHeight")
        page.unroute("**/api/v1/**")
        while held:
            held.pop(0).fallback()
        page.wait_for_timeout(500)
        assert page.evaluate(MOVED) == [], number
        if number == 0:  # the list of incidents: else nothing was tried
            assert dialog.evaluate("shown => shown.scrollHeight") > high_px
        page.keyboard.press("Escape")
        expect(page.locator("dialog")).to_have_count(0)
