"""A hundred people and more: the headcount, the search, crews, the order and lines."""

from __future__ import annotations

from pathlib import Path

from playwright.sync_api import Locator, Page, expect

from tests.e2e.console_page import press, take_picture
from tests.e2e.crowd.incident import CREW_SIZE, DOWN, NAMES, Incident, name_of
from tests.e2e.layout_checks import flaws
from tests.rig.simulated_units import unit_names

SOUGHT = 17


def headcount(page: Page, word: str) -> Locator:
    group = page.get_by_role("group", name="Headcount")
    return group.get_by_role("button").filter(has_text=word)


def count_of(page: Page, word: str) -> int:
    return int(headcount(page, word).locator("strong").inner_text())


def cards(page: Page) -> Locator:
    return page.locator(".people-list .card")


def order(page: Page) -> Locator:
    return page.get_by_role("combobox", name="Order of the list")


def test_headcount_adds_up_and_filters_the_list(incident: Incident) -> None:
    page = incident.page
    assert count_of(page, "On scene") == incident.people
    # The counts are of one moment only if they are read in one.
    counts = page.get_by_role("group", name="Headcount").locator("strong").all_inner_texts()
    assert sum(map(int, counts[1:])) == incident.people
    headcount(page, "Inside").click()
    expect(page.locator(".left-out")).to_contain_text(f"of {incident.people} shown")
    expect(cards(page)).to_have_count(count_of(page, "Inside"))
    assert count_of(page, "Inside") > incident.people // 4
    page.get_by_role("button", name="Show all").click()
    expect(cards(page)).to_have_count(incident.people)


def test_search_finds_by_name_unit_and_crew(incident: Incident) -> None:
    page = incident.page
    search = page.get_by_role("searchbox")
    unit = unit_names(SOUGHT + 1)[-1]
    found = page.locator(f".people-list [data-unit='{unit}']")
    for words in (name_of(SOUGHT), unit):
        search.fill(words)
        expect(found).to_be_in_viewport()
    search.fill("Ladder 2")
    expect(page.locator(".left-out")).to_be_visible()
    expect(page.locator(".casualties")).to_contain_text(NAMES[DOWN])
    search.press("Escape")
    expect(cards(page)).to_have_count(incident.people)


def test_crews_fold_and_names_are_sorted(incident: Incident, tmp_path: Path) -> None:
    page = incident.page
    order(page).select_option("By crew")
    crew = page.get_by_role("region", name="Ladder 3", exact=True)
    head = crew.get_by_role("heading").get_by_role("button")
    expect(head).to_contain_text(str(CREW_SIZE))
    expect(crew.locator(".card")).to_have_count(CREW_SIZE)
    head.click()
    expect(crew.locator(".card")).to_have_count(0)
    take_picture(page, tmp_path, f"crews-{incident.people}.png")
    assert flaws(page) == []
    head.click()
    order(page).select_option("By name")
    expect(cards(page).first).to_contain_text("Ada Adler")
    names = cards(page).locator(".name").all_text_contents()
    assert names == sorted(names)
    order(page).select_option("By need")
    expect(cards(page).first).to_contain_text(NAMES[DOWN])


def test_member_is_chosen_by_a_press_anywhere_on_a_line(incident: Incident) -> None:
    page = incident.page
    page.get_by_role("button", name="One line each").click()
    order(page).select_option("By name")
    third = page.locator(".card.line").nth(2)
    name = third.locator(".name").text_content() or ""
    press(third.locator(".line-words"))
    expect(page.locator(".card.chosen .name")).to_have_text(name)
    page.keyboard.press("Escape")
    order(page).select_option("By need")
    page.get_by_role("button", name="One line each").click()
