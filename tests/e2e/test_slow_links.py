"""Dialogs while the station has not answered yet, and once it is there again."""

from __future__ import annotations

import pytest
from playwright.sync_api import Route, expect

from tests.e2e import scenes
from tests.e2e.console_page import menu
from tests.e2e.stage import ANSWERS, Stage

USERS = [{"username": "chief", "role": "administrator", "created_ms": 0, "sessions": 1}]


def never(_: Route) -> None:
    """An answer that is still on its way."""


def test_wearer_is_shown_before_the_list_of_people_is_loaded(stage: Stage) -> None:
    """An empty field would say that nobody does."""
    page, _ = stage.open(scenes.quiet())
    page.route("**/api/v1/people", never)
    worn_by = menu(page, "Units").get_by_label("Assign FF-01 to")
    expect(worn_by.locator("option:checked")).to_have_text("Astrid Lindqvist (Engine 1)")
    expect(worn_by).to_have_value("p0")


@pytest.mark.parametrize("name", ["People", "Incidents", "Users", "Audit log"])
def test_list_being_loaded_does_not_look_empty(stage: Stage, name: str) -> None:
    page, _ = stage.open(scenes.quiet(), answers={**ANSWERS, "/users": USERS})
    for path in ("people", "incidents*", "users", "audit*"):
        page.route(f"**/api/v1/{path}", never)
    page.wait_for_timeout(100)
    if name in ("Users", "Audit log"):
        menu(page, "Account").get_by_role("button", name=name).click()
    else:
        menu(page, name)
    asking = page.get_by_role("dialog", name=name).get_by_role("status")
    expect(asking.filter(has_text="Asking the station")).to_be_visible()


@pytest.mark.parametrize(
    ("name", "path", "row"),
    [("People", "people", "Li Na"), ("Incidents", "incidents*", scenes.INCIDENT.name)],
)
def test_failed_list_is_loaded_once_the_station_returns(
    stage: Stage, name: str, path: str, row: str
) -> None:
    """It was started again while the dialog was open; whoever looks need not close it."""
    page, station = stage.open(scenes.quiet())
    page.route(f"**/api/v1/{path}", lambda route: route.abort())
    dialog = menu(page, name)
    notice = dialog.get_by_role("alert").filter(has_text="The base station cannot be reached.")
    expect(notice).to_be_visible()
    page.unroute(f"**/api/v1/{path}")
    station.restart()
    expect(dialog.get_by_role("row", name=row).first).to_be_visible()


def test_failure_of_a_list_disappears_when_the_station_returns(stage: Stage) -> None:
    page, station = stage.open(scenes.quiet())
    page.route("**/api/v1/people", lambda route: route.abort())
    dialog = menu(page, "People")
    notice = dialog.get_by_role("alert").filter(has_text="The base station cannot be reached")
    expect(notice).to_be_visible()
    page.unroute("**/api/v1/people")
    station.restart()
    expect(notice).to_have_count(0)


def test_unknown_outcome_of_an_order_stays_shown(stage: Stage) -> None:
    """A user who looks away must find out that an evacuation may not have been sent."""
    page, station = stage.open(scenes.quiet())
    page.route("**/api/v1/commands", lambda route: route.abort())
    page.get_by_role("group", name="Commands").get_by_role("button", name="Evacuate").click()
    dialog = page.get_by_role("dialog")
    dialog.get_by_role("button", name="Evacuate now").click()
    notice = dialog.get_by_role("alert").filter(has_text="Check whether the order went out")
    expect(notice).to_be_visible()
    station.restart()
    expect(page.get_by_test_id("link")).to_have_text("Connected")
    page.wait_for_timeout(500)
    expect(notice).to_be_visible()


def test_login_without_answer_reports_no_unknown_outcome(stage: Stage) -> None:
    page, station = stage.open(scenes.quiet())
    station.end_logins()
    page.route("**/api/v1/login", lambda route: route.abort())
    page.get_by_label("User").fill("chief")
    page.get_by_label("Password").fill("what it is")
    page.get_by_role("button", name="Log in").click()
    expect(page.get_by_role("alert")).to_have_text("The base station cannot be reached.")


def test_pending_press_is_indicated_on_a_slow_link(stage: Stage) -> None:
    """Else who orders an evacuation would think that the button was missed."""
    page, _ = stage.open(scenes.quiet())
    waiting: list[Route] = []

    def hold(route: Route) -> None:
        waiting.append(route)

    page.route("**/api/v1/commands", hold)
    page.get_by_role("group", name="Commands").get_by_role("button", name="Evacuate").click()
    dialog = page.get_by_role("dialog")
    dialog.get_by_role("button", name="Evacuate now").click()
    under_way = page.get_by_role("status").filter(has_text="Sending …")
    expect(dialog.get_by_role("status").filter(has_text="Sending …")).to_be_visible()
    page.keyboard.press("Escape")
    expect(under_way).to_be_visible()
    for route in waiting:
        route.fulfill(json={"command_id": "c9"})
    expect(under_way).to_have_count(0)
