"""Alarms of many at once: one row for a flood, casualties in sight, arrows, and the list."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Locator, Page, expect

from tests.e2e.console_page import close, drawn, press, strip, take_picture
from tests.e2e.crowd.incident import DOWN, NAMES, Incident
from tests.e2e.layout_checks import flaws

SIZES = ((1920, 1080), (390, 844), (844, 390))
CALLERS = 4  # of the crowd, besides the one who is down
OTHERS = 2  # people whose units are not of the crowd


@pytest.fixture(scope="module", autouse=True)
def silent(incident: Incident) -> Iterator[None]:
    """All of the crowd lose their link at one time."""
    incident.crowd.be_silent()
    yield
    incident.crowd.speak()


def casualties(page: Page) -> Locator:
    return page.get_by_role("list", name="Members who are down").get_by_role("button")


def rows(page: Page) -> Locator:
    return strip(page).get_by_role("listitem")


def test_flood_is_one_row_with_one_acknowledgement(incident: Incident, tmp_path: Path) -> None:
    page = incident.page
    count = incident.people - OTHERS
    flood = rows(page).filter(has_text=f"{count} units lost their link at")
    expect(flood).to_be_visible()
    expect(rows(page).first).to_contain_text(f"Mayday from {NAMES[DOWN]}")
    take_picture(page, tmp_path, f"flood-{incident.people}.png")
    assert flaws(page) == []
    press(flood.get_by_role("button", name="Acknowledge"))
    expect(flood).to_contain_text("acknowledged by admin")
    expect(flood.get_by_role("button")).to_have_count(1)  # its text: nothing is left to press


def test_casualties_stay_in_sight_and_no_button_moves(incident: Incident, tmp_path: Path) -> None:
    page = incident.page
    expect(casualties(page)).to_have_count(1)
    evacuate = page.get_by_role("group", name="Commands").get_by_role("button", name="Evacuate")
    before = evacuate.bounding_box()
    incident.crowd.press_maydays(CALLERS)
    expect(casualties(page)).to_have_count(CALLERS + 1)
    assert evacuate.bounding_box() == before
    more = strip(page).get_by_role("button", name="more")
    expect(more).to_be_visible()
    for width, height in SIZES:
        page.set_viewport_size({"width": width, "height": height})
        page.locator(".people-list").evaluate("one => one.scrollTo(0, one.scrollHeight)")
        for place in range(CALLERS + 1):
            expect(casualties(page).nth(place)).to_be_in_viewport(ratio=0.95)
        take_picture(page, tmp_path, f"down-{width}-{incident.people}.png")
        assert flaws(page) == [], width


def test_alarms_without_room_are_one_press_away(incident: Incident, tmp_path: Path) -> None:
    page = incident.page
    shown = rows(page).count()
    strip(page).get_by_role("button", name="more").click()
    expect(rows(page).nth(incident.people - 1)).to_be_attached()  # one by one
    take_picture(page, tmp_path, f"one-by-one-{incident.people}.png")
    page.keyboard.press("Escape")
    expect(rows(page)).to_have_count(shown)


def test_arrow_leads_to_a_casualty_outside_the_view(incident: Incident) -> None:
    page = incident.page
    for _ in range(3):
        page.get_by_role("button", name="Zoom in").click()
        drawn(page)
    arrows = page.get_by_role("list", name="In danger, outside the view").get_by_role("button")
    arrow = arrows.first
    name = arrow.get_attribute("title")
    arrow.click()
    expect(arrows.filter(has_text=f"Show {name}")).to_have_count(0)
    expect(page.locator(".card.chosen .name")).to_be_in_viewport()
    page.get_by_role("button", name="Fit").click()


def test_list_of_all_alarms_is_filtered(incident: Incident, tmp_path: Path) -> None:
    page = incident.page
    page.keyboard.press("a")
    dialog = page.get_by_role("dialog", name="Alarms")

    def choose(label: str, option: str, words: str) -> None:
        dialog.get_by_role("combobox", name=label).select_option(option)
        expect(dialog.get_by_role("status").filter(has_text=words)).to_be_visible()

    choose("Kind", "Mayday", f"{CALLERS + 1} of ")
    choose("Member", NAMES[DOWN], "1 of ")
    life = dialog.locator(".alarm-life")
    expect(life).to_contain_text(f"Mayday from {NAMES[DOWN]}")
    dialog.get_by_role("button", name="Show all").click()
    choose("Kind", "Link lost", f"{incident.people - OTHERS} of ")
    take_picture(page, tmp_path, f"alarms-{incident.people}.png")
    assert flaws(page) == []
    close(dialog)
