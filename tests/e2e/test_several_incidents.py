"""Two incidents on one station: one is shown at a time, and alarms of both stay in sight."""

from __future__ import annotations

import msgspec
import pytest
from playwright.sync_api import Locator, Page, Request, expect

from tests.e2e import scenes
from tests.e2e.console_page import barriers, choose_theme, command, menu, press, strip
from tests.e2e.layout_checks import flaws
from tests.e2e.stage import ANSWERS, SCREENS, Stage

FLATS, HARBOUR = scenes.INCIDENT, scenes.HARBOUR
DOWN = scenes.NAMES[6]


def switch(page: Page) -> Locator:
    return page.get_by_role("combobox", name="Incident", exact=True)


def names(page: Page) -> set[str]:
    """Names of the listed members, except those of no incident."""
    return set(page.locator(".people-list > .cards .name").all_text_contents())


def on_scene(page: Page) -> Locator:
    return page.get_by_role("group", name="Headcount").get_by_role("button", name="On scene")


def test_one_incident_is_shown_at_a_time_and_its_orders_name_it(stage: Stage) -> None:
    page, station = stage.open(scenes.two_incidents())
    expect(switch(page).locator("option")).to_have_text(
        [FLATS.name, f"{HARBOUR.name} (1 open alarm)"]
    )
    expect(on_scene(page)).to_contain_text("2")
    assert names(page) == {scenes.NAMES[5], DOWN}
    switch(page).select_option(FLATS.incident_id)
    expect(on_scene(page)).to_contain_text("5")
    assert names(page) == set(scenes.NAMES[:5])
    expect(page.get_by_role("heading", level=1)).to_have_text(FLATS.name)
    dialog = command(page, "Evacuate")
    expect(dialog.get_by_label("To").locator("option").first).to_have_text(
        f"Everyone in {FLATS.name}"
    )
    with page.expect_request("**/commands") as order:
        dialog.get_by_role("button", name="Evacuate now").click()
    assert _sent(order.value) == {
        "kind": "evacuate",
        "target": {"everyone": True},
        "text": "",
        "incident_id": FLATS.incident_id,
    }
    page.keyboard.press("Escape")
    page.locator(".par-clock").click()
    with page.expect_request("**/check-ins") as check_in:
        press(page.get_by_role("dialog").get_by_role("button", name="Confirm all", exact=True))
        press(page.get_by_role("button", name="Yes, answered by radio"))
    assert _sent(check_in.value)["incident_id"] == FLATS.incident_id
    page.keyboard.press("Escape")
    closed = msgspec.structs.replace(HARBOUR, closed_ms=scenes.NOW_MS)
    flats = station.picture.sites[0].plan
    over = msgspec.structs.replace(
        station.picture, incident=FLATS, incidents=(FLATS, closed), plan=flats
    )
    station.begin_anew(over)
    expect(switch(page)).to_have_count(0)
    apart = page.get_by_role("region", name="Unassigned")
    expect(apart.get_by_role("heading")).to_contain_text("Unassigned 3")


def test_alarm_of_another_incident_shows_its_name_and_leads_to_it(stage: Stage) -> None:
    page, _ = stage.open(scenes.two_incidents())
    what = strip(page).get_by_role("listitem").locator(".what")
    expect(what).to_have_text(f"{DOWN} may have fallen")
    switch(page).focus()
    page.keyboard.press("ArrowUp")
    assert DOWN in names(page), "what the keys pass is not chosen"
    page.keyboard.press("Enter")
    expect(what).to_have_text(f"{HARBOUR.name}: {DOWN} may have fallen")
    menu(page, "Display")
    urgent = page.get_by_role("alert").get_by_role("button")
    expect(urgent).to_have_text(f"{HARBOUR.name}: {DOWN} may have fallen")
    page.keyboard.press("Escape")
    page.keyboard.press("Escape")
    what.click()
    expect(what).to_have_text(f"{DOWN} may have fallen")
    expect(page.locator(f"[data-unit='{scenes.unit_id(6)}'].chosen")).to_be_visible()
    expect(switch(page)).to_have_value(HARBOUR.incident_id)


def test_members_without_incident_are_listed_separately_and_assigned(stage: Stage) -> None:
    page, station = stage.open(scenes.two_incidents())
    apart = page.get_by_role("region", name="Unassigned")
    expect(apart.get_by_role("heading")).to_contain_text("Unassigned 1")
    press(apart.locator(".card-head"))
    with page.expect_request("**/members") as sent:
        apart.get_by_role("button", name="Assign to this incident").click()
    assert sent.value.url.endswith(f"/incidents/{HARBOUR.incident_id}/members")
    assert _sent(sent.value) == {"target": {"unit_id": scenes.unit_id(7)}}
    assigned = msgspec.structs.replace(station.picture.units[7], incident_id=HARBOUR.incident_id)
    station.change(units=(assigned,))
    expect(apart).to_have_count(0)
    expect(on_scene(page)).to_contain_text("3")
    dialog = menu(page, "Incidents")
    dialog.get_by_label("Crew or unit of another incident").select_option("Engine 1")
    with page.expect_request("**/members") as crew:
        dialog.get_by_role("button", name="Assign to this incident").click()
    assert _sent(crew.value) == {"target": {"crew": "Engine 1"}}
    assert flaws(page) == []
    assert barriers(page) == []


def test_second_incident_is_opened_beside_the_first(stage: Stage) -> None:
    opened = {"incident_id": HARBOUR.incident_id, "name": HARBOUR.name}
    page, station = stage.open(scenes.quiet(), answers={**ANSWERS, "POST /incidents": opened})
    expect(switch(page)).to_have_count(0)
    dialog = menu(page, "Incidents")
    dialog.get_by_role("button", name="Open another incident").click()
    expect(dialog).to_contain_text(f"{FLATS.name} goes on beside it")
    dialog.get_by_label("Name of the new incident").fill(HARBOUR.name)
    with page.expect_request("**/incidents") as sent:
        dialog.get_by_role("button", name="Open beside").click()
    asked = _sent(sent.value)
    assert (asked["name"], asked["beside_others"]) == (HARBOUR.name, True)
    station.begin_anew(scenes.two_incidents())
    expect(dialog.get_by_role("button", name="Assign to this incident")).to_be_enabled()
    page.keyboard.press("Escape")
    expect(switch(page)).to_have_value(HARBOUR.incident_id)
    assert names(page) == {scenes.NAMES[5], DOWN}


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_incident_switch_fits_every_screen_and_is_accessible(stage: Stage, scheme: str) -> None:
    page, _ = stage.open(scenes.two_incidents())
    page.emulate_media(color_scheme="dark" if scheme == "dark" else "light")
    switch(page).select_option(FLATS.incident_id)
    for screen, (width, height) in SCREENS.items():
        page.set_viewport_size({"width": width, "height": height})
        assert flaws(page) == [], screen
        expect(switch(page)).to_be_in_viewport(ratio=1)
    assert barriers(page) == []
    page.set_viewport_size({"width": 1280, "height": 800})
    choose_theme(page, "Red light")
    assert barriers(page) == [], "red light"


def _sent(request: Request) -> dict[str, object]:
    sent = request.post_data_json
    assert isinstance(sent, dict)
    return sent
