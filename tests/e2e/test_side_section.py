"""The side section: all people by height, by keyboard, read aloud, in every theme and size."""

from __future__ import annotations

import re
from pathlib import Path

import msgspec
import pytest
from playwright.sync_api import Locator, Page, expect

from base_station.views.wire import UnitView
from tests.e2e import scenes
from tests.e2e.console_page import barriers, menu, to_plan_of_a_phone
from tests.e2e.layout_checks import flaws
from tests.e2e.played_station import PlayedStation
from tests.e2e.stage import Stage
from tests.e2e.tower_scene import member, tower

TRIES = 10  # the page takes its size first
SHOWN = {"muster-section": "on"}
WATCH_CHANGES = """
() => {
  const count = (records) => { window.changesOfSection += records.length; };
  new MutationObserver(count).observe(document.querySelector(".section"), {
    subtree: true, childList: true, attributes: true, characterData: true,
  });
}
"""


def section(page: Page) -> Locator:
    return page.get_by_role("region", name="Side section")


def on_floor(page: Page, name: str) -> Locator:
    floors = section(page).locator(".section-sheet > ul > li")
    return floors.filter(has=page.get_by_text(name, exact=True)).get_by_role("button")


@pytest.mark.parametrize(
    ("theme", "screen"),
    [("light", "phone"), ("light", "phone on its side"), ("dark", "laptop"), ("red", "large")],
)
def test_a_hundred_people_are_legible_everywhere(
    stage: Stage, tmp_path: Path, theme: str, screen: str
) -> None:
    page, _ = stage.open(tower(100), screen, kept={**SHOWN, "muster-theme": theme})
    to_plan_of_a_phone(page)
    jonas = on_floor(page, "floor 3").filter(has_text="Jonas Bergman, in danger")
    expect(jonas).to_be_in_viewport()
    page.screenshot(path=tmp_path / f"{theme}-{screen}.png")
    assert flaws(page) == []
    assert barriers(page) == []


def test_section_describes_the_floor_of_every_member(stage: Stage) -> None:
    page, _ = stage.open(tower(12), kept=SHOWN)
    expect(on_floor(page, "floor 3").filter(has_text="!JB")).to_have_count(1)
    expect(on_floor(page, "floor unknown")).to_contain_text("floor unknown, perhaps floor 2")
    expect(on_floor(page, "floor 2").filter(has_text="old")).to_contain_text("Tomas Novak")
    far = on_floor(page, "ground floor").filter(has_text="Li Na")
    expect(far).to_contain_text(re.compile(r"height 0\.0\sm ±\s1\.0\sm"))
    expect(section(page)).to_contain_text("Without a position, not shown: 1")
    expect(section(page).locator(".section-ends")).to_contain_text("north-east")
    page.get_by_role("combobox", name="Along").select_option("south to north")
    expect(section(page).locator(".section-ends")).to_contain_text(re.compile("south.*north"))


def test_press_or_keyboard_chooses_a_member(stage: Stage) -> None:
    page, _ = stage.open(tower(100))
    expect(page.locator(".map")).to_be_visible()
    page.keyboard.press("s")
    expect(section(page)).to_be_visible()
    expect(page.locator(".map")).to_be_hidden()
    jonas = section(page).get_by_role("button").filter(has_text="Jonas Bergman, in danger")
    jonas.focus()
    page.keyboard.press("Enter")
    expect(jonas).to_have_attribute("aria-pressed", "true")
    expect(page.locator(f"[data-unit='{scenes.unit_id(1)}'].chosen").first).to_be_visible()
    number = section(page).get_by_role("button").filter(has_text=re.compile(r"\d people:")).first
    names = (number.text_content() or "").split(": ")[1].split(", ")
    number.click()
    expect(number).to_have_attribute("aria-expanded", "true")
    listed = page.get_by_role("list", name="People who stand here").get_by_role("button")
    expect(listed).to_have_count(len(names))
    listed.filter(has_text=names[-1]).click()
    chosen = section(page).locator(".section-mark.chosen")
    expect(chosen).to_contain_text(names[-1])
    page.get_by_role("button", name="Beacon").click()
    expect(page.locator(".map")).to_be_visible()  # a place is wanted
    page.keyboard.press("Escape")
    expect(section(page)).to_be_visible()
    page.get_by_role("button", name="Section", exact=True).click()
    expect(page.locator(".map")).to_be_visible()
    expect(menu(page, "Display")).to_contain_text("Side section of the building")


def _from_the_future(unit: UnitView) -> UnitView:
    """Its position does not become old while a slow machine looks at it."""
    if unit.position is None:
        return unit
    t_ms = scenes.NOW_MS + scenes.MINUTE_MS
    position = msgspec.structs.replace(unit.position, t_ms=t_ms)
    return msgspec.structs.replace(unit, position=position)


def changes_while(page: Page, station: PlayedStation) -> int:
    """Count of changed elements of the section under messages that do not concern it."""
    page.evaluate("window.changesOfSection = 0")
    for _ in range(3):
        station.change()
        page.wait_for_timeout(300)
    count: int = page.evaluate("window.changesOfSection")
    return count


def test_section_is_redrawn_only_after_changes(stage: Stage) -> None:
    still = tower(12)
    units = tuple(_from_the_future(one) for one in still.units)
    page, station = stage.open(msgspec.structs.replace(still, units=units), kept=SHOWN)
    astrid = section(page).get_by_role("button").filter(has_text="Astrid Lindqvist, ")
    expect(astrid).to_contain_text("basement 1")
    page.evaluate(WATCH_CHANGES)
    assert any(changes_while(page, station) == 0 for _ in range(TRIES)), "it never rests"
    station.change(units=(_from_the_future(member(0, 1, 40.0)),))
    expect(astrid).to_contain_text(re.compile(r"floor 1, height 3\.2\sm"))


def test_section_is_shown_in_a_replay(stage: Stage) -> None:
    page, _ = stage.open(tower(12), kept=SHOWN)
    dialog = menu(page, "Incidents")
    dialog.get_by_role("button", name="Replay").first.click()
    expect(page.locator(".console.replay")).to_be_visible()
    expect(section(page).get_by_role("button").first).to_be_visible()
    expect(section(page)).not_to_contain_text("floor 4")
