"""A hundred people: the headcount, the search, crews that fold, and one line each."""

from __future__ import annotations

import re
from collections.abc import Callable

import pytest
from playwright.sync_api import Locator, Page, expect

from base_station.views.wire import Snapshot
from tests.e2e import scenes
from tests.e2e.console_page import barriers, close, command, press
from tests.e2e.layout_checks import flaws
from tests.e2e.stage import Stage

SIZES = ((1920, 1080), (1366, 768), (1024, 768), (390, 844))
LEAST_LINES = 60  # on a screen of 1920 by 1080
LEAST_WORDS_PX = 60  # of the alarm or the place in a line
BEYOND_PX = "one => one.scrollWidth - one.clientWidth"


def headcount(page: Page) -> Locator:
    return page.get_by_role("group", name="Headcount").get_by_role("button")


def search(page: Page) -> Locator:
    return page.get_by_role("searchbox", name="Search by name, unit or crew")


def cards(page: Page) -> Locator:
    return page.locator(".people-list .card")


@pytest.mark.parametrize("count", [40, 200])
def test_headcount_adds_up_and_each_count_filters_the_list(stage: Stage, count: int) -> None:
    page, _ = stage.open(scenes.mixed(count))
    counts = dict.fromkeys(("On scene", "Inside", "Outside", "Rehab", "Not located"), 0)
    for word in (*counts, "Never heard"):
        text = headcount(page).filter(has_text=word).locator("strong").inner_text()
        counts[word] = int(text)
    assert counts["On scene"] == count == sum(counts.values()) - counts["On scene"]
    assert (counts["Rehab"], counts["Not located"], counts["Never heard"]) == (1, 2, 3)
    for word in ("Rehab", "Not located", "Never heard"):
        one = headcount(page).filter(has_text=word)
        one.click()
        expect(one).to_have_attribute("aria-pressed", "true")
        expect(cards(page)).to_have_count(counts[word])
        expect(page.locator(".left-out")).to_contain_text(f"{counts[word]} of {count} shown")
    page.get_by_role("button", name="Show all").click()
    expect(cards(page)).to_have_count(count)


def test_slash_focuses_the_search_by_name_unit_and_crew(stage: Stage) -> None:
    page, _ = stage.open(scenes.mixed())
    page.keyboard.press("/")
    expect(search(page)).to_be_focused()
    for words, found in (("okafor", 5), ("FF-07", 1), ("rescue 3", 8), ("okafor rescue", 1)):
        search(page).fill(words)
        expect(cards(page)).to_have_count(found)
    search(page).press("Escape")
    expect(cards(page)).to_have_count(40)
    dialog = command(page, "Message")
    text = dialog.get_by_role("textbox")
    text.focus()
    page.keyboard.type("in/out")
    expect(text).to_have_value("in/out")
    close(dialog)


def test_chosen_member_and_casualties_are_listed_in_every_search(stage: Stage) -> None:
    page, _ = stage.open(scenes.mixed())
    search(page).fill("ladder")
    expect(page.locator(".casualties")).to_contain_text("Jonas Bergman")
    page.wait_for_timeout(600)
    page.locator(".casualties button").click()
    expect(page.locator(".card.chosen .name")).to_have_text("Jonas Bergman")


def test_search_on_a_phone_opens_on_request(stage: Stage) -> None:
    page, _ = stage.open(scenes.mixed(), "phone")
    expect(search(page)).to_be_hidden()
    page.get_by_role("button", name="Find", exact=True).click()
    search(page).fill("ff-07")
    expect(cards(page)).to_have_count(1)
    assert flaws(page) == []


def test_crews_fold_with_their_counts(stage: Stage) -> None:
    page, _ = stage.open(scenes.mixed())
    page.get_by_role("combobox", name="Order of the list").select_option("By crew")
    crew = page.get_by_role("region", name="Engine 2")
    head = crew.get_by_role("heading").get_by_role("button")
    expect(head).to_contain_text("8")
    expect(head).to_contain_text("1 down")
    expect(crew.locator(".card")).to_have_count(8)
    head.click()
    expect(crew.locator(".card")).to_have_count(0)
    expect(head).to_have_attribute("aria-expanded", "false")
    press(page.locator(".casualties button"))  # of this crew
    expect(crew.locator(".card.chosen")).to_contain_text("Jonas Bergman")
    assert flaws(page) == []
    page.get_by_role("combobox", name="Order of the list").select_option("By name")
    expect(cards(page).first).to_contain_text("Astrid Lindqvist")
    page.reload()
    expect(page.get_by_role("combobox", name="Order of the list")).to_have_value("name")


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_sixty_people_fit_one_screen_in_compact_lines(stage: Stage, scheme: str) -> None:
    page, _ = stage.open(scenes.mixed(200), "large")
    page.emulate_media(color_scheme="dark" if scheme == "dark" else "light")
    page.get_by_role("button", name="One line each").click()
    expect(cards(page).nth(1)).to_have_class(re.compile(r"\bline\b"))
    seen = cards(page).evaluate_all(
        """all => {
          const list = document.querySelector(".people-list").getBoundingClientRect();
          return all.map(one => one.getBoundingClientRect())
            .filter(box => box.top >= list.top && box.bottom <= list.bottom).length;
        }"""
    )
    assert seen >= LEAST_LINES
    assert barriers(page) == []


def test_lines_fit_every_screen(stage: Stage) -> None:
    page, _ = stage.open(scenes.mixed())
    page.get_by_role("button", name="One line each").click()
    for width, height in SIZES:
        page.set_viewport_size({"width": width, "height": height})
        assert flaws(page) == [], (width, height)
    cards(page).nth(8).click()
    expect(page.locator(".card.chosen")).to_contain_text("Position")


@pytest.mark.parametrize("locale", ["en-GB", "de-DE", "fr-FR"])
@pytest.mark.parametrize("scene", [scenes.par_requested, scenes.overdue])
def test_line_has_name_and_words_beside_a_par_that_is_due(
    stage: Stage, scene: Callable[[], Snapshot], locale: str
) -> None:
    page, _ = stage.open(scene(), locale=locale, kept={"muster-list-density": "lines"})
    page.set_viewport_size({"width": 1280, "height": 800})
    line = page.locator(".card.line", has_text=scenes.NAMES[0])
    mark = line.locator(".par-mark")
    expect(mark).to_have_text(re.compile(r"^PAR (\+\d+:\d+|\d+\s(min|s))"))
    assert mark.evaluate(BEYOND_PX) <= 0
    assert line.locator(".name").evaluate(BEYOND_PX) <= 0
    words = line.locator(".line-words")
    assert words.evaluate("one => one.clientWidth") >= LEAST_WORDS_PX
    assert line.locator(".card-head").evaluate(BEYOND_PX) <= 0


def test_press_anywhere_on_a_card_chooses_it_except_on_buttons(stage: Stage) -> None:
    page, station = stage.open(scenes.bad_minute())
    heat = page.locator(".card", has_text="Mira Okafor")
    heat.locator(".facts").click()
    expect(heat).to_have_class(re.compile("chosen"))
    stranger = page.locator(".card", has_text="Unregistered unit")
    stranger.get_by_role("button", name="Register").click()
    station.expect_changes("/units")
    expect(stranger).not_to_have_class(re.compile("chosen"))


def test_press_directly_after_a_card_moved_is_ignored(stage: Stage) -> None:
    """It was meant for who stood there before."""
    page, station = stage.open(scenes.quiet())
    second = page.locator(".card").nth(1)
    expect(second).to_contain_text("Elena Rossi")
    page.clock.pause_at(page.evaluate("Date.now() + 1000"))
    fall = scenes.alarm(3, "fall", 1, "Tomas Novak may have fallen", 0)
    down = scenes.with_alarms(station.picture.units[3], fall)
    station.change(alarms=(fall,), units=(down,))
    page.clock.run_for(100)
    expect(second).to_contain_text("Astrid Lindqvist")
    second.click()
    page.clock.run_for(700)
    expect(page.locator(".card.chosen")).to_have_count(0)
    second.click()
    expect(page.locator(".card.chosen .name")).to_have_text("Astrid Lindqvist")
