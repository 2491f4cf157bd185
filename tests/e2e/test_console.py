"""The console in a browser, at a station with a unit over the bus.

One story in several tests: they run in the order in which they stand here.
"""

from __future__ import annotations

import pytest
from playwright.sync_api import Browser, Locator, Page, expect

from tests.e2e.conftest import log_in
from tests.e2e.console_page import (
    barriers,
    close,
    menu,
    metres_north,
    press,
)
from tests.e2e.enlisting import INCIDENT, NAME
from tests.e2e.station_process import StationProcess
from tests.e2e.wearable import Wearable


def test_a_wrong_password_is_refused(chromium: Browser, station: StationProcess) -> None:
    stranger = chromium.new_page()
    stranger.goto(station.address)
    stranger.get_by_label("User").fill("admin")
    stranger.get_by_label("Password").fill("guessed")
    stranger.get_by_role("button", name="Log in").click()
    expect(stranger.get_by_role("alert")).to_contain_text("wrong")
    expect(stranger.get_by_role("region", name="People")).to_have_count(0)
    stranger.close()


def test_card_shows_name_temperature_uncertainty_and_age(page: Page, card: Locator) -> None:
    expect(card).to_contain_text(NAME)
    for words in ("Ladder 1 · Officer", "Walking", "31 °C", "83 %", "Link good", "±"):
        expect(card).to_contain_text(words)
    expect(page.get_by_role("heading", name=INCIDENT)).to_be_visible()


def test_the_responder_moves_on_card_and_plan(page: Page, card: Locator) -> None:
    card.get_by_role("button", name=NAME).click()
    page.wait_for_timeout(600)  # the plan has come to rest
    plan = page.locator(".map")
    before_m, seen = metres_north(card), plan.screenshot()
    page.wait_for_timeout(2000)
    assert metres_north(card) > before_m + 1.0
    assert plan.screenshot() != seen


def test_mayday_is_shown_acknowledged_and_resolved(
    page: Page, card: Locator, wearable: Wearable
) -> None:
    wearable.press_mayday()
    strip = page.get_by_role("region", name="Open alarms")
    alarm = strip.get_by_role("listitem").filter(has_text=f"Mayday from {NAME}")
    expect(alarm).to_contain_text("Emergency", ignore_case=True)
    expect(card).to_contain_text("Mayday")
    press(alarm.get_by_role("button", name="Acknowledge"))
    expect(alarm).to_contain_text("acknowledged by admin")
    wearable.cancel_mayday()
    press(alarm.get_by_role("button", name="Resolve"))
    asked = page.get_by_role("dialog", name="Resolve this alarm")
    asked.get_by_label("Note").fill("on the stairs")
    press(asked.get_by_role("button", name="Found and helped"))
    expect(alarm).to_have_count(0)
    strip.get_by_role("button", name="All alarms").click()
    life = page.get_by_role("dialog").get_by_role("listitem").filter(has_text="Mayday from")
    expect(life.first).to_contain_text("resolved (admin: Found and helped, on the stairs)")
    expect(life.first).to_contain_text("acknowledged (admin)")
    close(page.get_by_role("dialog"))
    card.hover()  # and stay there: a pointer that rests keeps nobody among those who are down
    expect(page.get_by_role("list", name="Members who are down")).to_have_count(0, timeout=60_000)


@pytest.mark.parametrize("scheme", ["dark", "light"])
def test_console_is_accessible(page: Page, card: Locator, scheme: str) -> None:
    page.emulate_media(color_scheme="dark" if scheme == "dark" else "light")
    assert barriers(page) == []


def test_duplicate_devices_are_marked(page: Page, card: Locator, station: StationProcess) -> None:
    name = "FF-09"
    with Wearable(name, station.bus), Wearable(name, station.bus):
        cloned = page.locator(f"[data-unit='{name}']")
        expect(cloned).to_contain_text("Duplicate unit ID: two devices")
        row = menu(page, "Units").get_by_role("row", name=name)
        expect(row).to_contain_text("two devices report under this name")
        close(page.get_by_role("dialog"))
    expect(card).not_to_contain_text("two devices")


def test_lost_station_is_marked_and_returns(
    page: Page, card: Locator, station: StationProcess
) -> None:
    expect(page.get_by_test_id("link")).to_have_text("Connected")
    station.kill()
    banner = page.get_by_role("alert").filter(has_text="Connection to the station lost")
    expect(banner).to_contain_text("is not being updated")
    expect(page.get_by_test_id("link")).to_have_text("Connection lost")
    expect(card).to_contain_text("Not updated")
    station.start()
    expect(banner).to_have_count(0, timeout=60_000)
    expect(card).to_contain_text(NAME)
    expect(card).to_contain_text("Link good")


def test_replay_station_is_not_shown_as_live(
    chromium: Browser, page: Page, station: StationProcess
) -> None:
    incidents = page.evaluate("fetch('/api/v1/incidents').then((answer) => answer.json())")
    replaying = StationProcess(station.data, replayed=incidents[0]["incident_id"])
    replaying.start()
    try:
        onlooker = chromium.new_page(viewport={"width": 1280, "height": 800})
        log_in(onlooker, replaying)
        banner = onlooker.get_by_role("region", name="Replay")
        expect(banner).to_contain_text(INCIDENT)
        expect(banner.get_by_label("Time of the incident")).to_be_visible()
        expect(banner.get_by_role("button", name="Back to live")).to_have_count(0)
        expect(onlooker.get_by_role("button", name="Units")).to_have_count(0)
        onlooker.close()
    finally:
        replaying.stop()
