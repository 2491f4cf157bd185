"""Alarms and commands are not triggered by a slip, and urgent ones are never hidden."""

from __future__ import annotations

import re
from datetime import UTC, datetime, timedelta
from urllib.parse import quote

import msgspec
from playwright.sync_api import expect

from tests.e2e import scenes
from tests.e2e.console_page import close, menu, press, strip
from tests.e2e.stage import Stage


def test_quick_second_press_does_not_resolve_the_alarm(stage: Stage) -> None:
    """The button to acknowledge is followed at its place by the one to resolve."""
    page, station = stage.open(scenes.bad_minute())
    fall, still = scenes.bad_minute().alarms[:2]
    press(strip(page).get_by_role("button", name=f"Acknowledge: {fall.text}"))
    station.change(alarms=(scenes.taken(fall), scenes.taken(still)))
    row = strip(page).get_by_role("listitem").filter(has_text=fall.text)
    page.clock.pause_at(datetime.now(UTC) + timedelta(seconds=1))  # no haste is as slow as a test
    page.clock.run_for(600)  # the button has stood there for so long
    row.get_by_role("button", name="Resolve").dblclick()
    dialog = page.get_by_role("dialog", name="Resolve 2 alarms")
    page.clock.run_for(400)
    dialog.get_by_role("button", name="False alarm").click()
    station.expect_changes(*(f"/alarms/{quote(one.alarm_id)}/acknowledge" for one in (fall, still)))
    page.clock.resume()
    close(dialog)
    expect(row.get_by_role("button", name="Resolve")).to_be_focused()
    press(row.get_by_role("button", name="Resolve"))
    with page.expect_request(re.compile("/resolve$")):
        press(dialog.get_by_role("button", name="False alarm"))


def test_evacuation_needs_two_presses_at_different_places(stage: Stage) -> None:
    for screen in ("laptop", "phone"):
        page, station = stage.open(scenes.bad_minute(), screen)
        first = page.get_by_role("group", name="Commands").get_by_role("button", name="Evacuate")
        first.dblclick(force=True)
        station.expect_changes()
        page.get_by_role("button", name="Evacuate now").click()
        station.expect_changes("/commands")


def test_dialog_does_not_hide_urgent_alarms(stage: Stage) -> None:
    page, _ = stage.open(scenes.bad_minute())
    dialog = menu(page, "Units")
    dialog.get_by_role("alert").get_by_role("button", name="Jonas Bergman may have fallen").click()
    expect(dialog).to_have_count(0)
    expect(page.locator(".card.chosen")).to_contain_text("Jonas Bergman")


def test_long_name_of_the_acknowledging_user_leaves_room_for_the_cause(stage: Stage) -> None:
    """However long the name, the row is as with a short one; it says all to who points at it."""
    shown = scenes.bad_minute()
    rows_px = []
    for by in ("mia", "W" * 64):
        both = tuple(
            msgspec.structs.replace(one, state="acknowledged", by=by) for one in shown.alarms[:2]
        )
        page, _ = stage.open(msgspec.structs.replace(shown, alarms=(*both, *shown.alarms[2:])))
        row = strip(page).get_by_role("listitem").filter(has_text="may have fallen")
        expect(row.locator(".state")).to_have_attribute("title", f"acknowledged by {by}")
        box = row.bounding_box()
        assert box is not None
        rows_px.append(box["height"])
    assert rows_px[0] == rows_px[1]
