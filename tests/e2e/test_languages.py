"""The console in German and French, and in imperial units with American floors."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from playwright.sync_api import Locator, Page, expect

from tests.e2e import scenes
from tests.e2e.console_page import barriers
from tests.e2e.language_checks import english_on
from tests.e2e.layout_checks import flaws
from tests.e2e.stage import Stage

BEYOND_PX = "shown => shown.scrollWidth - shown.clientWidth"
HEADER_PX = 62  # of one row
CUT_CHOICES = """
(dialog) => [...dialog.querySelectorAll("select")].filter((select) => {
  const whole = select.cloneNode(false);
  whole.style.cssText = "width: auto; min-width: 0; position: absolute";
  whole.append(select.selectedOptions[0].cloneNode(true));
  select.after(whole);
  const isCut = whole.offsetWidth > select.offsetWidth;
  whole.remove();
  return isCut;
}).map((select) => select.selectedOptions[0].text)
"""


def open_dialogs(page: Page) -> list[Locator]:
    """Buttons that open dialogs of the main screen, in any language: orders and menu entries."""
    orders = page.locator(".command-bar > button")
    entries = page.locator("#menu button")
    return [*orders.all(), *entries.all()]


@pytest.mark.parametrize(("locale", "language"), [("de-DE", "de"), ("fr-FR", "fr")])
def test_console_is_complete_in_the_language_of_the_browser(
    stage: Stage, tmp_path: Path, locale: str, language: str
) -> None:
    page, _ = stage.open(scenes.bad_minute(), locale=locale)
    expect(page.locator("html")).to_have_attribute("lang", language)
    page.set_viewport_size({"width": 1440, "height": 900})
    page.locator(".card").first.click()
    page.screenshot(path=tmp_path / "main.png")
    assert flaws(page) == []
    assert barriers(page) == []
    assert english_on(page, language) <= {scenes.ROLE}
    page.set_viewport_size({"width": 844, "height": 390})
    page.screenshot(path=tmp_path / "low.png")
    assert flaws(page) == []
    page.set_viewport_size({"width": 1440, "height": 900})
    for number, opens in enumerate(open_dialogs(page)):
        opens.click()
        dialog = page.get_by_role("dialog")
        dialog.wait_for()
        page.screenshot(path=tmp_path / f"dialog-{number}.png")
        assert dialog.evaluate(BEYOND_PX) <= 0
        assert flaws(page) == []
        assert barriers(page) == []
        assert english_on(page, language) <= {scenes.ROLE}
        page.keyboard.press("Escape")
        expect(page.locator("dialog")).to_have_count(0)


@pytest.mark.parametrize("locale", ["en-GB", "de-DE", "fr-FR"])
def test_texts_of_every_language_fit(stage: Stage, tmp_path: Path, locale: str) -> None:
    page, _ = stage.open(scenes.quiet(), locale=locale)
    page.set_viewport_size({"width": 1440, "height": 900})
    expect(page.locator(".header .light.good")).to_have_count(2)
    assert page.locator(".header").evaluate("shown => shown.offsetHeight") <= HEADER_PX
    page.keyboard.press("a")
    filters = page.locator(".alarm-filters")
    for width in (1440, 768, 390):
        page.set_viewport_size({"width": width, "height": 900})
        for state in ("all", "open", "resolved"):
            filters.locator("select").nth(3).select_option(state)
            assert filters.evaluate(CUT_CHOICES) == [], width
    page.close()
    page, _ = stage.open(scenes.with_sensors(), locale=locale)
    page.set_viewport_size({"width": 1440, "height": 900})
    page.locator("#menu button").nth(1).click()
    dialog = page.get_by_role("dialog")
    dialog.get_by_role("row").nth(40).wait_for()
    for width in (390, 701, 768, 1024, 1200, 1280, 1440, 1920):
        page.set_viewport_size({"width": width, "height": 900})
        page.screenshot(path=tmp_path / f"units-{width}.png")
        assert dialog.evaluate(BEYOND_PX) <= 0, width


def test_chosen_language_applies_at_once_and_is_kept(stage: Stage) -> None:
    page, _ = stage.open(scenes.quiet())
    page.locator("#menu").get_by_role("button", name="Display").click()
    page.get_by_role("radio", name="Deutsch").check()
    expect(page.get_by_role("dialog", name="Anzeige")).to_be_visible()
    expect(page.locator("html")).to_have_attribute("lang", "de")
    page.reload()
    expect(page.get_by_role("heading", level=1)).to_be_visible()
    expect(page.locator("#menu").get_by_role("button", name="Anzeige")).to_be_visible()


def test_imperial_units_and_american_floors_are_shown(stage: Stage, tmp_path: Path) -> None:
    kept = {"muster-units": "imperial", "muster-floors": "american"}
    page, _ = stage.open(scenes.bad_minute(), kept=kept)
    page.screenshot(path=tmp_path / "imperial.png")
    people = page.locator(".people-list")
    expect(people).to_contain_text(re.compile(r"±\s\d+\sft"))
    expect(people).to_contain_text("°F")
    expect(people).to_contain_text("1st floor")
    expect(page.locator(".ol-scale-line")).to_contain_text("ft")
    for metric in (re.compile(r"\d\sm\b"), "°C", "ground floor"):
        expect(people).not_to_contain_text(metric)
    assert flaws(page) == []
