"""Orders without an answer: once the station is received again the notice shows the outcome."""

from __future__ import annotations

from pathlib import Path

from playwright.sync_api import expect

from tests.e2e import scenes
from tests.e2e.console_page import press
from tests.e2e.layout_checks import flaws
from tests.e2e.stage import Stage


def test_notice_reports_that_the_order_was_carried_out(stage: Stage) -> None:
    page, _ = stage.open(scenes.bad_minute())
    page.route("**/api/v1/alarms/*/acknowledge", lambda route: route.abort())
    done = {"action": "AcknowledgeAlarm", "t_ms": scenes.NOW_MS}
    page.route("**/api/v1/idempotency-keys/*", lambda route: route.fulfill(json=done))
    press(page.locator(".alarm").first.get_by_role("button", name="Acknowledge"))
    notice = page.locator(".notice")
    expect(notice).to_contain_text("No reply from the base station")
    expect(notice).to_contain_text("What had no answer was carried out at")
    expect(notice).not_to_contain_text("No reply")


def test_notice_on_a_phone_covers_no_button(stage: Stage) -> None:
    """The actions of the chosen card stand at the end of the list, where it would lie."""
    page, _ = stage.open(scenes.bad_minute(), "phone")
    page.route("**/api/v1/alarms/*/acknowledge", lambda route: route.abort())
    page.route("**/api/v1/idempotency-keys/*", lambda route: route.abort())
    page.locator(".card", has_text="Tomas Novak").click()
    press(page.locator(".alarm").first.get_by_role("button", name="Acknowledge"))
    notice = page.locator(".notice")
    expect(notice).to_contain_text("No reply from the base station")
    expect(page.get_by_role("group", name="For Tomas Novak")).to_be_in_viewport(ratio=1)
    assert flaws(page) == []
    notice.get_by_role("button", name="OK").click()
    expect(notice).to_have_count(0)


def test_notice_on_a_laptop_covers_no_button_of_the_plan(stage: Stage, tmp_path: Path) -> None:
    """The panel of a pin stands at the lower end of the plan, where it would lie."""
    page, _ = stage.open(scenes.quiet())
    page.route("**/api/v1/pins*", lambda route: route.abort())
    page.route("**/api/v1/idempotency-keys/*", lambda route: route.abort())
    card = page.locator(".card", has_text="Jonas Bergman")
    card.get_by_role("button", name="Jonas Bergman").click()
    card.get_by_role("button", name="Correct position …").click()
    panel = page.get_by_role("form", name="Pin: Jonas Bergman")
    panel.get_by_label("North, m").fill("1")
    panel.get_by_label("East, m").fill("2")
    panel.get_by_role("button", name="Set pin").click()
    notice = page.locator(".notice")
    expect(notice).to_contain_text("No reply from the base station")
    page.screenshot(path=tmp_path / "notice.png")
    for button in panel.get_by_role("button").all():
        button.click(trial=True)  # nothing lies over it
    assert flaws(page) == []
    notice.get_by_role("button", name="OK").click()
    expect(notice).to_have_count(0)
