"""A pin or beacon that is moved at the console keeps what was said of it."""

from __future__ import annotations

from typing import Any

import msgspec
from playwright.sync_api import Locator, Page, Request, expect

from base_station.views import wire
from tests.e2e import scenes
from tests.e2e.console_page import on_plan
from tests.e2e.stage import Stage

PIN = msgspec.structs.replace(
    scenes.pin("a", 0, "used", 3.04, ""), std_m=0.35, heading_rad=6.5, heading_std_rad=0.1, note="A"
)
BEACON = wire.BeaconView("door-3", "Door 3", 3.04, 4.0, 1, 0.35, 5.0, None)


def is_move(request: Request) -> bool:
    return request.method == "PUT"


def pin_panel(page: Page) -> Locator:
    page.get_by_role("button", name="Pins 1").click()
    page.get_by_role("button", name="Astrid Lindqvist here").click()
    return page.get_by_role("form", name="Pin: ")


def moved(page: Page, panel: Locator) -> dict[str, Any]:
    """Request to the station after a move."""
    with page.expect_request(is_move) as asked:
        panel.get_by_role("button", name="Move pin", exact=True).click()
    page.keyboard.press("Escape")
    expect(panel).to_have_count(0)
    return dict(asked.value.post_data_json or {})


def test_form_sends_only_its_fields(stage: Stage) -> None:
    page, _ = stage.open(msgspec.structs.replace(scenes.quiet(), pins=(PIN,)))
    panel = pin_panel(page)
    panel.get_by_label("Note").fill("B")
    as_it_is = {"unit_id": "FF-01", "north_m": 3.04, "east_m": 4.0, "std_m": 0.35, "floor": 0}
    assert moved(page, panel) == as_it_is | {"note": "B"}, "what it does not show is left out"
    panel = pin_panel(page)
    panel.get_by_label("North, m").fill("3.2")
    panel.get_by_label("When").select_option("now")
    now = as_it_is | {"north_m": 3.2, "t_ms": None}
    assert moved(page, panel) == now | {"note": "A"}, "it is now, and not when it was before"


def test_beacon_is_edited_by_keyboard(stage: Stage) -> None:
    page, _ = stage.open(msgspec.structs.replace(scenes.quiet(), beacons=(BEACON,)))
    page.get_by_role("button", name="Pins 0, beacons 1").press("Enter")
    page.get_by_role("button", name="Beacon Door 3").press("Enter")
    panel = page.get_by_role("form", name="Beacon")
    panel.get_by_label("Name").fill("Door 4")
    with page.expect_request(is_move) as asked:
        panel.get_by_role("button", name="Save beacon").press("Enter")
    place = {"north_m": 3.04, "east_m": 4.0, "std_m": 0.35, "floor": 1}
    assert asked.value.post_data_json == {"label": "Door 4", "reach_m": 5.0, **place}


def test_panning_the_plan_moves_no_pin(stage: Stage) -> None:
    """Only one that was chosen is drawn to another place, and what was said of it stays."""
    at = scenes.position(0)
    pin = msgspec.structs.replace(PIN, north_m=at.north_m, east_m=at.east_m)
    page, station = stage.open(msgspec.structs.replace(scenes.quiet(), pins=(pin,)))
    page.emulate_media(reduced_motion="reduce")
    moves: list[dict[str, Any]] = []

    def note(one: Request) -> None:
        if is_move(one):
            moves.append(dict(one.post_data_json or {}))

    page.on("request", note)

    def draw() -> None:
        """From the plan's middle, where the person is, and the pin."""
        page.locator(".card").first.get_by_role("button").first.click()
        page.wait_for_timeout(600)
        page.mouse.move(*on_plan(page, 0, 0))
        page.mouse.down()
        page.mouse.move(*on_plan(page, 60, 40), steps=8)
        page.mouse.up()
        page.wait_for_timeout(350)  # it is no double click

    draw()
    station.expect_changes()
    panel = pin_panel(page)
    expect(panel).to_be_visible()
    for _ in range(10):  # a loaded machine has not drawn the plan yet
        draw()
        if moves:
            break
    assert sorted(moves[0]) == ["east_m", "north_m", "unit_id"], "the rest stays as it is"
    assert moves[0]["east_m"] > at.east_m + 1.0
    assert moves[0]["north_m"] < at.north_m - 1.0
    expect(panel).to_be_visible()
