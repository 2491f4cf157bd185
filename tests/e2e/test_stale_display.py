"""A station that is not heard, or lets nobody look on: what is old looks so."""

from __future__ import annotations

import re
from datetime import UTC, datetime, timedelta

from playwright.sync_api import expect

from tests.e2e import scenes
from tests.e2e.console_page import barriers
from tests.e2e.layout_checks import flaws
from tests.e2e.stage import Stage


def test_data_is_shown_as_old_without_the_station(stage: Stage) -> None:
    page, station = stage.open(scenes.bad_minute())
    expect(page).to_have_title("(4!) Muster")
    station.fall_silent()
    banner = page.get_by_role("alert").filter(has_text="Connection to the station lost")
    expect(banner).to_contain_text("is not being updated")
    expect(page).to_have_title(re.compile("NO CONNECTION"))
    expect(page.locator(".card").first).to_contain_text("Not updated")
    assert flaws(page) == []
    assert barriers(page) == []


def test_state_from_before_a_sleep_shows_its_time(stage: Stage) -> None:
    """Whatever time has gone by unheard."""
    page, station = stage.open(scenes.quiet())
    page.clock.pause_at(datetime.now(UTC) + timedelta(seconds=1))
    station.change()
    station.hang()
    page.clock.fast_forward(30 * scenes.MINUTE_MS)
    page.wait_for_timeout(600)  # the page's own clock has gone on
    page.clock.run_for(6_000)  # the message is confirmed, the station asked, and not heard
    banner = page.get_by_role("alert").filter(has_text="Connection to the station lost")
    received = page.evaluate(f"new Date({scenes.NOW_MS}).toTimeString().slice(0, 8)")
    expect(banner).to_contain_text(f"This picture is from {received} ")


def test_state_from_before_a_sleep_is_shown_as_old_at_once(stage: Stage) -> None:
    """On many machines the steady clock stands in a sleep, and only the time of day goes on."""
    page, station = stage.open(scenes.quiet())
    station.change()
    station.hang()
    page.evaluate("const day = Date.now; Date.now = () => day() + 3_600_000")
    expect(page.locator(".card").first).to_contain_text("Not updated")
    expect(page.locator(".card").first).to_contain_text("1 h 00 min old")


def test_ended_login_is_reported(stage: Stage) -> None:
    page, station = stage.open(scenes.quiet())
    station.end_logins()
    expect(page.get_by_role("status").filter(has_text="This login has ended")).to_be_visible()
    expect(page.get_by_role("button", name="Log in")).to_be_visible()
    expect(page).to_have_title("Muster")
