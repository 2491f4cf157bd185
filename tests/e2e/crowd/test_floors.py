"""Floors: marks of other floors, *All*, the building from its side, and stacked floors."""

from __future__ import annotations

import re
from pathlib import Path

from playwright.sync_api import Locator, Page, Request, expect

from tests.e2e.console_page import barriers, drawn, painted, take_picture
from tests.e2e.crowd.incident import DOWN, NAMES, Incident
from tests.e2e.layout_checks import flaws

SEVERAL = re.compile(r"\d people: (.*)")


def floor_button(page: Page, name: str) -> Locator:
    return page.get_by_role("group", name="Floor shown").get_by_role("button", name=name)


def people_on(page: Page, name: str) -> int:
    return int(floor_button(page, name).locator(".floor-people").last.inner_text().split()[0])


def members_shown(marks: Locator) -> int:
    """By single marks, and by those that count several."""
    names = [SEVERAL.search(text) for text in marks.all_text_contents()]
    return sum(1 if several is None else len(several[1].split(", ")) for several in names)


def test_floors_count_everybody_and_a_casualty_is_drawn_on_each(
    incident: Incident, tmp_path: Path
) -> None:
    page = incident.page
    for name in ("Floor 1", "Floor G", "Floors: All"):
        floor_button(page, name).click()
        expect(floor_button(page, name)).to_have_attribute("aria-pressed", "true")
        page.get_by_role("button", name="Fit").click()
        drawn(page)
        assert painted(page, "--immediate") > 0, name
        take_picture(page, tmp_path, f"{name.split()[-1]}-{incident.people}.png")
    assert people_on(page, "Floors: All") == incident.people
    assert people_on(page, "Floor 1") > incident.people // 5
    assert people_on(page, "Floor 1") + people_on(page, "Floor G") == incident.people


def test_building_from_its_side_shows_everybody_by_height(
    incident: Incident, tmp_path: Path
) -> None:
    page = incident.page
    page.keyboard.press("s")
    section = page.get_by_role("region", name="Side section")
    marks = section.locator(".section-sheet").get_by_role("button")
    expect(marks.filter(has_text=f"{NAMES[DOWN]}, in danger")).to_be_in_viewport()
    expect(marks.filter(has_text=f"{NAMES[DOWN]}, in danger")).to_contain_text("floor 1")
    assert members_shown(marks) == incident.people
    take_picture(page, tmp_path, f"section-{incident.people}.png")
    assert flaws(page) == []
    assert barriers(page) == []


def test_stacked_floors_are_loaded_when_they_are_asked_for(
    incident: Incident, tmp_path: Path
) -> None:
    page = incident.page
    if page.get_by_role("region", name="Side section").count() == 0:
        page.keyboard.press("s")
    loaded: list[str] = []

    def note(request: Request) -> None:
        loaded.append(request.url)

    page.on("request", note)
    page.get_by_role("combobox", name="Shown").select_option("stacked in 3D")
    marks = page.get_by_role("region", name="Stacked floors").locator(".section-mark")
    expect(marks.filter(has_text=f"{NAMES[DOWN]}, in danger")).to_be_in_viewport()
    page.remove_listener("request", note)
    assert [one for one in loaded if re.search(r"/assets/.*\.js$", one)]
    take_picture(page, tmp_path, f"stacked-{incident.people}.png")
    page.get_by_role("combobox", name="Shown").select_option("from the side")
    page.keyboard.press("s")
    expect(page.locator(".map")).to_be_visible()
