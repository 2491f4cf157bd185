"""Dialogs report what they cannot do, and end alone."""

from __future__ import annotations

from pathlib import Path

from playwright.sync_api import expect

from tests.e2e import scenes
from tests.e2e.console_page import menu
from tests.e2e.layout_checks import flaws
from tests.e2e.stage import Stage


def test_disabled_button_looks_disabled(stage: Stage) -> None:
    page, _ = stage.open(scenes.quiet())
    site = menu(page, "Site")
    idle, ready = (
        site.get_by_role("button", name=name).evaluate("one => getComputedStyle(one).background")
        for name in ("Set base map", "Save location")
    )
    assert idle != ready


def test_escape_closes_the_dialog_and_keeps_the_plan_tool(stage: Stage) -> None:
    page, _ = stage.open(scenes.quiet())
    page.get_by_role("button", name="Beacon", exact=True).click()
    panel = page.get_by_role("form", name="Beacon")
    panel.get_by_label("Its number").fill("17")
    menu(page, "Units")
    page.keyboard.press("Escape")
    expect(page.get_by_role("dialog")).to_have_count(0)
    expect(panel.get_by_label("Its number")).to_have_value("17")
    page.keyboard.press("Escape")
    expect(panel).to_have_count(0)


def test_failure_of_a_dialog_is_shown_in_it(stage: Stage) -> None:
    """Behind it nobody could read or close it."""
    page, _ = stage.open(scenes.bad_minute())
    menu(page, "Incidents").get_by_role("button", name="Accuracy report").click()
    dialog = page.get_by_role("dialog", name="Accuracy report")
    notice = dialog.get_by_role("alert").filter(has_text="The station answered 404")
    notice.get_by_role("button", name="OK").click()
    expect(notice).to_have_count(0)
    assert flaws(page) == []


def test_refused_photo_does_not_add_the_person_twice(stage: Stage, tmp_path: Path) -> None:
    """A user may press again after the refusal of the photo."""
    page, _ = stage.open(scenes.quiet())
    added = {**scenes.PEOPLE[0], "person_id": "new"}
    page.route(
        "**/api/v1/people",
        lambda route: (
            route.fulfill(json=added) if route.request.method == "POST" else route.fallback()
        ),
    )
    page.route(
        "**/photo", lambda route: route.fulfill(status=422, json={"detail": "This is no picture."})
    )
    (tmp_path / "notes.txt").write_text("notes")
    dialog = menu(page, "People")
    dialog.get_by_label("Name", exact=True).fill("Astrid Lindqvist")
    dialog.get_by_label("Photo", exact=True).set_input_files(tmp_path / "notes.txt")
    dialog.get_by_role("button", name="Add person").click()
    expect(dialog.get_by_role("alert").filter(has_text="no picture")).to_be_visible()
    expect(dialog.get_by_label("Name", exact=True)).to_have_value("")
