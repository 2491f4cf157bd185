"""Dialogs of the console's menu: users, units, people, and closed incidents.

One story in several tests: they run in the order in which they stand here.
"""

from __future__ import annotations

import re

import pytest
from playwright.sync_api import Locator, Page, Route, expect

from tests.e2e.conftest import UNIT
from tests.e2e.console_page import (
    answer_to,
    barriers,
    close,
    confirm,
    menu,
    metres_north,
    press,
)
from tests.e2e.enlisting import INCIDENT, NAME
from tests.e2e.wearable import Wearable


def test_user_is_added_and_the_audit_names_the_administrator(page: Page, card: Locator) -> None:
    account = menu(page, "Account")
    account.get_by_role("button", name="Users").click()
    dialog = page.get_by_role("dialog", name="Users")
    dialog.get_by_label("Name", exact=True).fill("mia")
    dialog.get_by_label("Password, at least 10 characters").fill("long enough for mia")
    dialog.get_by_role("button", name="Add user").click()
    expect(dialog.get_by_label("Role of mia")).to_have_value("viewer")
    dialog.get_by_label("Role of mia").select_option("commander")
    close(dialog)
    menu(page, "Account").get_by_role("button", name="Audit log").click()
    audit = page.get_by_role("dialog", name="Audit log")
    expect(audit.get_by_role("row", name="Changed user mia: commander")).to_be_visible()
    expect(audit.get_by_role("row", name="Open incident")).to_be_visible()
    close(audit)


def test_units_are_managed_in_their_dialog(page: Page, card: Locator, wearable: Wearable) -> None:
    wearable.describe("led")
    press(card.get_by_role("button").first)
    sensors = card.locator(".fact", has_text="Sensors")
    expect(sensors).to_contain_text("left foot (laces), lower back (recognised)")
    expect(sensors).to_contain_text("position from foot and trunk")
    dialog = menu(page, "Units")
    row = dialog.get_by_role("row", name=UNIT)
    expect(row.get_by_role("list")).to_contain_text(
        "lower back (recognised)position from foot and trunk"
    )
    expect(row).to_contain_text("1 min 15 s behind ± 3 ms")
    row.get_by_role("button", name=f"Download recording of {UNIT}").click()
    expect(row).to_contain_text("waiting")
    close(dialog)
    page.get_by_role("button", name="Station health").click()
    health = page.get_by_role("dialog")
    pull = health.get_by_role("region", name="Raw recordings").get_by_role("listitem")
    expect(pull).to_contain_text(f"{UNIT}waiting")
    assert barriers(page) == []
    pull.get_by_role("button", name=f"Stop the recording of {UNIT}").click()
    expect(pull).to_contain_text("stopped by a person")
    close(health)


@pytest.mark.parametrize("name", ["Incidents", "Units", "People", "Site", "Account"])
def test_dialogs_are_accessible(page: Page, card: Locator, name: str) -> None:
    dialog = menu(page, name)
    assert barriers(page) == []
    close(dialog)


def test_assessment_of_positions_is_accessible(page: Page, card: Locator) -> None:
    menu(page, "Incidents").get_by_role("button", name="Accuracy report").click()
    dialog = page.get_by_role("dialog", name=INCIDENT)
    errors = dialog.get_by_role("table", name="ISO/IEC 18305")
    expect(errors.get_by_role("rowheader", name=f"{NAME} ({UNIT})")).to_be_visible()
    everybody = errors.get_by_role("row", name="Everybody")
    expect(everybody).to_contain_text(re.compile(r"Estimated live(\d+\.\d\sm){4}"))
    assert barriers(page) == []
    dialog.get_by_role("button", name="All incidents").click()
    close(page.get_by_role("dialog", name="Incidents"))


def test_a_past_incident_is_replayed(page: Page, card: Locator) -> None:
    dialog = menu(page, "Incidents")
    confirm(dialog, "Close this incident")
    expect(dialog.get_by_label("Name of the new incident")).to_be_visible()
    dialog.get_by_role("button", name=f"Replay {INCIDENT}").click()
    banner = page.get_by_role("region", name="Replay")
    expect(banner).to_contain_text("Recorded, not live")
    expect(card).to_contain_text(NAME)
    banner.get_by_label("Time of the incident").press("End")
    resolved = page.get_by_role("region", name="Open alarms").get_by_role("listitem")
    expect(resolved).to_have_count(0)
    in_the_past_m = metres_north(card)
    banner.get_by_role("button", name="Back to live").click()
    expect(banner).to_have_count(0)
    expect(card).to_contain_text("Link good")
    assert metres_north(card) > in_the_past_m


def test_replay_ends_after_its_pending_requests(page: Page, card: Locator) -> None:
    dialog = menu(page, "Incidents")
    dialog.get_by_role("button", name=f"Replay {INCIDENT}").click()
    banner = page.get_by_role("region", name="Replay")
    slow: list[Route] = []
    page.route(
        "**/api/v1/replays/*",
        lambda route: slow.append(route) if route.request.method == "POST" else route.continue_(),
    )
    banner.get_by_role("button", name="Pause").click()
    banner.get_by_role("button", name="Back to live").click()
    expect(banner).to_have_count(0)
    with page.expect_response(lambda answer: answer.request.method == "DELETE") as ended:
        slow[0].continue_()
    assert ended.value.status == 204
    page.unroute_all()
    expect(page.get_by_text("There is no such replay")).to_have_count(0)


def test_person_is_erased_after_the_name_is_typed(
    page: Page, card: Locator, complaints: list[str]
) -> None:
    name = "Bo Stein"
    dialog = menu(page, "People")
    dialog.get_by_label("Name", exact=True).fill(name)
    dialog.get_by_role("button", name="Add person").click()
    row = dialog.get_by_role("row", name=name)
    row.get_by_role("button", name=f"Delete data … {name}").click()
    row.get_by_label(f"Type “{name}” to confirm").fill("Bo")
    row.get_by_role("button", name="Delete permanently").click()
    notice = page.get_by_text("The name is another")
    expect(notice).to_have_count(1)
    assert "422" in complaints.pop()  # the browser notes the refusal, as it should
    row.get_by_label(f"Type “{name}” to confirm").fill(name)
    row.get_by_role("button", name="Delete permanently").click()
    expect(row).to_have_count(0)
    expect(dialog.get_by_role("row", name=NAME)).to_be_visible()
    close(dialog)
    page.get_by_role("alert").get_by_role("button", name="OK").click()
    assert name not in str(answer_to(page, "audit?limit=1000"))
