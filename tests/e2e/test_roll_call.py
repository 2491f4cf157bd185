"""The roll call: a member in danger is confirmed only after a question."""

from __future__ import annotations

import re

from playwright.sync_api import expect

from tests.e2e import scenes
from tests.e2e.console_page import press
from tests.e2e.layout_checks import flaws
from tests.e2e.stage import Stage


def test_confirmation_of_all_excludes_casualties(stage: Stage) -> None:
    """One press for a crew or for all is for those who answered."""
    page, station = stage.open(scenes.bad_minute())
    page.locator(".par-clock").click()
    dialog = page.get_by_role("dialog", name="PAR status")
    down = dialog.get_by_role("listitem").filter(has_text="Jonas Bergman")
    expect(down).to_contain_text("Fall, No motion")
    assert flaws(page) == []
    dialog.get_by_role("button", name="Confirm all", exact=True).click()
    question = "In alarm: Jonas Bergman (Fall, No motion). Has everybody answered by radio?"
    expect(dialog.get_by_role("group", name=question)).to_be_visible()
    assert flaws(page) == []
    station.expect_changes()


def test_confirmation_of_a_crew_with_a_casualty_needs_a_second_press(stage: Stage) -> None:
    shown = scenes.bad_minute(7)  # two of each crew
    page, station = stage.open(shown)
    page.locator(".par-clock").click()
    crews = page.get_by_role("dialog").get_by_role("region")
    calm = crews.filter(has_text="Engine 1").get_by_role("button", name="confirm all")
    press(calm)
    station.expect_changes("/check-ins")
    confirm_crew = crews.filter(has_text="Jonas Bergman")
    ticks = crews.get_by_text(re.compile("confirm all"))
    assert {"Engine 1: confirm all", "Engine 2: confirm all"} <= set(ticks.all_inner_texts())
    confirm_crew.get_by_role("button", name="Engine 2: confirm all").click()
    expect(confirm_crew).to_contain_text(
        "In alarm: Jonas Bergman (Fall, No motion). Have all answered by radio?"
    )
    station.expect_changes("/check-ins")
    page.wait_for_timeout(600)
    confirm_crew.get_by_role("button", name="Yes, answered by radio").click()
    station.expect_changes("/check-ins", "/check-ins")
