"""Orders without an answer: once the station is received again the notice shows the outcome."""

from __future__ import annotations

from playwright.sync_api import expect

from tests.e2e import scenes
from tests.e2e.console_page import press
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
