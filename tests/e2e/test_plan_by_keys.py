"""From the list of people to the plan and back, and through its panels, by keys alone."""

from __future__ import annotations

import msgspec
import pytest
from playwright.sync_api import Page, expect

from tests.e2e import scenes
from tests.e2e.layout_checks import flaws
from tests.e2e.stage import Stage

TO_PLAN = "To this person on the plan"


@pytest.mark.parametrize("screen", ["laptop", "phone"])
def test_two_keys_lead_from_a_member_in_the_list_to_the_plan(stage: Stage, screen: str) -> None:
    """The plan stands behind the cards of all others."""
    page, _ = stage.open(scenes.bad_minute(), screen)
    head = page.locator(".card").nth(2).get_by_role("button").first
    head.press("Enter")
    page.keyboard.press("Tab")
    expect(page.get_by_role("button", name=TO_PLAN)).to_be_focused()
    assert flaws(page) == []
    page.keyboard.press("Enter")
    plan = page.get_by_role("application")
    expect(plan).to_be_focused()
    expect(plan).to_be_in_viewport()
    page.keyboard.press("Escape")
    expect(head).to_be_focused()
    expect(head).to_be_in_viewport()


def test_chosen_card_of_a_replay_offers_the_plan_by_keyboard(stage: Stage) -> None:
    page, _ = stage.open(scenes.past())
    expect(page.get_by_role("button", name=TO_PLAN)).to_have_count(0)
    page.locator(".card").first.get_by_role("button").first.press("Enter")
    expect(page.get_by_role("button", name=TO_PLAN)).to_have_count(1)


def test_escape_on_the_plan_ends_a_tool_first(stage: Stage) -> None:
    page, _ = stage.open(scenes.bad_minute())
    page.locator(".card").first.get_by_role("button").first.press("Enter")
    page.get_by_role("button", name="Beacon", exact=True).press("Enter")
    plan = page.get_by_role("application")
    plan.focus()
    page.keyboard.press("Escape")
    expect(page.get_by_role("form")).to_have_count(0)
    expect(plan).to_be_focused()


def open_site(page: Page, screen: str) -> None:
    if screen == "phone":
        page.get_by_role("button", name="Menu").press("Enter")
    page.get_by_role("navigation").get_by_role("button", name="Site").press("Enter")


@pytest.mark.parametrize(("screen", "opener"), [("laptop", "Site"), ("phone", "Menu")])
def test_focus_returns_after_georeferencing(stage: Stage, screen: str, opener: str) -> None:
    page, _ = stage.open(scenes.quiet(), screen)
    open_site(page, screen)
    page.get_by_role("dialog").get_by_role("button", name="Align by two points").press("Enter")
    panel = page.get_by_role("form", name="Plan location")
    expect(panel).to_be_focused()
    page.keyboard.press("Escape")
    expect(panel).to_have_count(0)
    expect(page.get_by_role("button", name=opener, exact=True)).to_be_focused()


def test_clicked_point_is_announced(stage: Stage) -> None:
    page, _ = stage.open(msgspec.structs.replace(scenes.quiet(), plan=None))
    open_site(page, "laptop")
    page.get_by_role("dialog").get_by_role("button", name="Align by two points").press("Enter")
    panel = page.get_by_role("form", name="Plan location")
    page.locator(".map").click(position={"x": 10, "y": 60})
    expect(panel).to_contain_text("First point: ")
    expect(panel.get_by_role("group").first).to_contain_text("m west")
