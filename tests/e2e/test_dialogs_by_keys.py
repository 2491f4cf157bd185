"""Dialogs by keys: initial focus, focus inside, and focus after closing."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import msgspec
import pytest
from playwright.sync_api import Locator, Page, expect

from tests.e2e import scenes
from tests.e2e.stage import ANSWERS, PAST, Stage

USERS = [{"username": "chief", "role": "administrator", "created_ms": 0, "sessions": 1}]
ALL = {**ANSWERS, "/users": USERS, f"{PAST}/assessment": scenes.ASSESSMENT}
BASE_MAP = {
    "image_url": "/icon.svg",
    **{
        corner: {"lat_deg": 56.0, "lon_deg": 9.0}
        for corner in ("upper_left", "upper_right", "lower_left")
    },
}
TABS = 80  # more than any of these dialogs has to go to


def entry(page: Page, name: str) -> Locator:
    """Entry of the menu."""
    return page.get_by_role("navigation").get_by_role("button", name=name)


def order(page: Page, name: str) -> Locator:
    commands = page.get_by_role("group", name="Commands")
    return commands.get_by_role("button", name=name, exact=True)


def roll_call(page: Page, _name: str) -> Locator:
    return page.locator(".par-clock")


OPENERS: list[tuple[Callable[[Page, str], Locator], str]] = [
    *((entry, name) for name in ("Incidents", "Units", "People", "Site", "Account")),
    *((order, name) for name in ("Evacuate", "PAR", "Message")),
    (roll_call, ""),
]


@pytest.mark.parametrize(("find", "name"), OPENERS)
def test_focus_stays_in_a_dialog_and_escape_returns_it(
    stage: Stage, find: Callable[[Page, str], Locator], name: str
) -> None:
    page, _ = stage.open(scenes.bad_minute(), answers=ALL)
    opener = find(page, name)
    opener.press("Enter")
    page.get_by_role("dialog").wait_for()
    outside = "document.activeElement.closest('dialog, body').tagName"
    behind = "!document.activeElement.matches('body, dialog, dialog *')"
    assert page.evaluate(outside) == "DIALOG", "it begins in the dialog"
    for _ in range(TABS):
        page.keyboard.press("Tab")
        assert not page.evaluate(behind)
    page.keyboard.press("Escape")
    expect(page.get_by_role("dialog")).to_have_count(0)
    expect(opener).to_be_focused()


NO_INCIDENT = msgspec.structs.replace(scenes.quiet(), incident=None)


FORMS: dict[str, Callable[[Locator], Locator]] = {
    "Message": lambda dialog: dialog.get_by_label("Message", exact=True),
    "Evacuate": lambda dialog: dialog.get_by_role("combobox"),
    "PAR": lambda dialog: dialog.get_by_role("combobox"),
    "Incidents": lambda dialog: dialog.get_by_label("Name of the new incident"),
    "People": lambda dialog: dialog.get_by_label("Name", exact=True),
}


@pytest.mark.parametrize("name", FORMS)
def test_opened_form_has_the_focus(stage: Stage, name: str) -> None:
    page, _ = stage.open(NO_INCIDENT, answers=ALL)
    page.get_by_role("button", name=name, exact=True).press("Enter")
    expect(FORMS[name](page.get_by_role("dialog"))).to_be_focused()


@pytest.mark.parametrize(
    ("opener", "leads_to"),
    [("Account", "Users"), ("Account", "Audit log"), ("Incidents", "Accuracy report")],
)
def test_focus_returns_from_a_second_dialog_to_the_first_button(
    stage: Stage, opener: str, leads_to: str
) -> None:
    page, _ = stage.open(scenes.quiet(), answers=ALL)
    entry(page, opener).press("Enter")
    page.get_by_role("dialog").get_by_role("button", name=leads_to).press("Enter")
    page.get_by_role("dialog", name=leads_to).wait_for()
    page.keyboard.press("Escape")
    expect(page.get_by_role("dialog")).to_have_count(0)
    expect(entry(page, opener)).to_be_focused()


def test_focus_returns_to_the_menu_button(stage: Stage) -> None:
    page, _ = stage.open(scenes.quiet(), "tablet", ALL)
    button = page.get_by_role("button", name="Menu")
    button.press("Enter")
    entry(page, "Units").press("Enter")
    page.get_by_role("dialog").wait_for()
    page.keyboard.press("Escape")
    expect(button).to_be_focused()


def test_menu_closes_with_escape_and_with_a_press_outside(
    stage: Stage,
) -> None:
    page, _ = stage.open(scenes.bad_minute(), "tablet", ALL)
    button, units = page.get_by_role("button", name="Menu"), entry(page, "Units")
    button.press("Enter")
    expect(units).to_be_visible()
    page.keyboard.press("Tab")
    page.keyboard.press("Escape")
    expect(units).to_be_hidden()
    expect(button).to_be_focused()
    button.click()
    expect(units).to_be_visible()
    page.get_by_role("heading", level=1).click()
    expect(units).to_be_hidden()


def test_dialog_shows_that_the_station_is_not_received(stage: Stage) -> None:
    """The red banner stands behind it, and who ticks people off would not see it."""
    page, station = stage.open(scenes.bad_minute(), answers=ALL)
    page.locator(".par-clock").press("Enter")
    dialog = page.get_by_role("dialog")
    expect(dialog).not_to_contain_text("Connection to the station lost")
    station.fall_silent()
    lost = dialog.get_by_role("alert").filter(has_text="Connection to the station lost")
    expect(lost).to_contain_text(re.compile(r"\d\ss ago"))


def test_changed_times_are_confirmed(stage: Stage) -> None:
    page, _ = stage.open(scenes.quiet(), answers=ALL)
    entry(page, "Incidents").click()
    dialog = page.get_by_role("dialog")
    rest = dialog.get_by_label("Work limit, min")
    rest.fill("30")
    dialog.get_by_role("button", name="Save times").click()
    done = dialog.get_by_role("status").filter(has_text="The times are changed.")
    expect(done).to_be_visible()
    rest.fill("31")
    expect(done).to_have_count(0)


def test_refused_times_are_not_confirmed(stage: Stage) -> None:
    page, _ = stage.open(scenes.quiet(), answers=ALL)
    refusal = {"detail": "It is closed."}
    page.route("**/accountability", lambda route: route.fulfill(status=409, json=refusal))
    entry(page, "Incidents").click()
    dialog = page.get_by_role("dialog")
    dialog.get_by_role("button", name="Save times").click()
    expect(dialog.get_by_role("alert").filter(has_text="It is closed.")).to_be_visible()
    expect(dialog.get_by_text("The times are changed.")).to_have_count(0)


def test_new_password_of_a_user_is_confirmed(stage: Stage) -> None:
    page, _ = stage.open(scenes.quiet(), answers=ALL)
    entry(page, "Account").click()
    page.get_by_role("button", name="Users").click()
    dialog = page.get_by_role("dialog", name="Users")
    row = dialog.get_by_role("row", name="chief")
    row.get_by_label("New password of chief").fill("a longer password")
    row.get_by_role("button", name="Set").click()
    expect(row.get_by_role("status")).to_have_text("Set.")
    expect(row.get_by_label("New password of chief")).to_have_value("")


def change_own_password(page: Page) -> None:
    entry(page, "Account").click()
    dialog = page.get_by_role("dialog")
    dialog.get_by_label("Old password").fill("what it was")
    dialog.get_by_label("New password, at least 10 characters").fill("what it will be")
    dialog.get_by_role("button", name="Change password").click()


def test_wrong_old_password_is_refused_and_the_console_continues(stage: Stage) -> None:
    page, _ = stage.open(scenes.bad_minute(), answers=ALL)
    refusal = {"detail": "The old password is wrong."}
    page.route("**/me/password", lambda route: route.fulfill(status=403, json=refusal))
    change_own_password(page)
    dialog = page.get_by_role("dialog")
    reported = dialog.get_by_role("alert").filter(has_text="The old password is wrong.")
    expect(reported).to_be_visible()
    expect(page.get_by_role("region", name="Open alarms")).to_be_visible()


def test_login_form_reports_the_new_password_and_has_the_focus(stage: Stage) -> None:
    page, _ = stage.open(scenes.quiet(), answers=ALL)
    change_own_password(page)
    expect(page.get_by_role("status").filter(has_text="The password is changed.")).to_be_visible()
    expect(page.get_by_label("User")).to_be_focused()


@pytest.mark.parametrize(
    ("asks", "field"),
    [("Change Li Na", "Name"), ("Delete data … Li Na", "Type “Li Na” to confirm")],
)
def test_inline_form_takes_and_returns_the_focus(stage: Stage, asks: str, field: str) -> None:
    page, _ = stage.open(scenes.quiet(), answers=ALL)
    entry(page, "People").press("Enter")
    dialog = page.get_by_role("dialog")
    button = dialog.get_by_role("button", name=asks, exact=True)
    button.press("Enter")
    expect(dialog.get_by_role("cell").get_by_label(field, exact=True)).to_be_focused()
    dialog.get_by_role("button", name=re.compile("^(No|Cancel)$")).press("Enter")
    expect(button).to_be_focused()


def test_changed_position_rate_is_confirmed(stage: Stage) -> None:
    """The list says no more which one it was."""
    page, _ = stage.open(scenes.quiet(), answers=ALL)
    entry(page, "Units").click()
    row = page.get_by_role("dialog").get_by_role("row", name="FF-01")
    row.get_by_label("Position rate of FF-01").select_option("5")
    expect(row.get_by_role("status")).to_have_text("5 Hz requested.")


def test_base_map_is_confirmed(stage: Stage, tmp_path: Path) -> None:
    page, _ = stage.open(scenes.quiet(), answers={**ALL, "PUT /site/base-map": BASE_MAP})
    entry(page, "Site").click()
    dialog = page.get_by_role("dialog")
    (tmp_path / "map.png").write_bytes(b"")
    (tmp_path / "map.pgw").write_text("1\n0\n0\n-1\n400000\n6200000\n")
    dialog.get_by_label("Picture").set_input_files(tmp_path / "map.png")
    dialog.get_by_label("World file").set_input_files(tmp_path / "map.pgw")
    dialog.get_by_label("EPSG number").fill("25832")
    dialog.get_by_role("button", name="Set base map").click()
    expect(dialog.get_by_role("status").filter(has_text="The base map is set.")).to_be_visible()


def test_focused_control_is_not_covered_by_the_dialogs_header(stage: Stage) -> None:
    """Its head stays where it is while it scrolls, with what cannot wait."""
    page, _ = stage.open(scenes.crowd(), "laptop at 200 %", ALL)
    page.locator(".par-clock").press("Enter")
    page.get_by_role("dialog").wait_for()
    seen = """() => {
      const one = document.activeElement, box = one.getBoundingClientRect();
      const hit = document.elementFromPoint(box.left + box.width / 2, box.top + box.height / 2);
      return !one.closest("dialog") || one.contains(hit);
    }"""
    for _ in range(12):
        page.keyboard.press("Tab")
        assert page.evaluate(seen)
    for _ in range(10):
        page.keyboard.press("Shift+Tab")
        assert page.evaluate(seen)
