"""Replay in a page of the console."""

from __future__ import annotations

from playwright.sync_api import Locator, Page, expect

from tests.e2e import scenes
from tests.e2e.console_page import menu


def begin_replay(page: Page) -> Locator:
    """Beside what is live."""
    menu(page, "Incidents").get_by_role("button", name=f"Replay {scenes.INCIDENT.name}").click()
    banner = page.get_by_role("region", name="Replay")
    expect(banner).to_contain_text("Recorded, not live")
    return banner
