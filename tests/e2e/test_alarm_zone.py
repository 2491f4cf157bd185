"""The zone of alarms: one row a member, floods folded, and a layout that does not move."""

from __future__ import annotations

from urllib.parse import quote

import msgspec
import pytest
from playwright.sync_api import Page, expect

from base_station.views import wire
from tests.e2e import scenes
from tests.e2e.console_page import barriers, drawn, press, strip
from tests.e2e.layout_checks import flaws
from tests.e2e.played_station import PlayedStation
from tests.e2e.stage import Stage

SIZES = ((1920, 1080), (1366, 768), (1024, 768), (390, 844), (844, 390))
STAYS = ("Evacuate", "PAR", "Message")


def places(page: Page) -> dict[str, object]:
    """Positions of the urgent controls, once the page is complete and connected.

    A busy machine may keep the page waiting for so long that it counts the station as lost for a
    moment, and then a frame around everything moves all by its width.
    """
    lost = page.locator(".console.stopped")
    while True:
        expect(lost).to_have_count(0)
        measured = measured_places(page)
        if lost.count() == 0:
            return measured


def measured_places(page: Page) -> dict[str, object]:
    drawn(page)
    bar = page.get_by_role("group", name="Commands")
    buttons = {
        name: bar.get_by_role("button", name=name, exact=True).bounding_box() for name in STAYS
    }
    return {**buttons, "main": page.locator(".main").bounding_box()}


def raise_alarms(station: PlayedStation, picture: wire.Snapshot, first: int) -> None:
    """Those of the first units of a picture."""
    units = picture.units[:first]
    ids = {one.unit_id for one in units}
    station.change(units=units, alarms=tuple(a for a in picture.alarms if a.unit_id in ids))


@pytest.mark.parametrize(
    ("count", "size"), [*((40, size) for size in SIZES), (200, SIZES[0]), (200, SIZES[3])]
)
def test_controls_keep_their_place_when_alarms_come_and_go(
    stage: Stage, count: int, size: tuple[int, int]
) -> None:
    page, station = stage.open(scenes.quiet(count))
    page.set_viewport_size({"width": size[0], "height": size[1]})
    expect(strip(page)).to_contain_text("No open alarms")
    before = places(page)
    flood = scenes.flood(count)
    for first in (1, 2, 3, 20, count):
        raise_alarms(station, flood, first)
        expect(strip(page).get_by_role("heading")).to_have_text(f"{first + min(first, 3)} open")
        assert places(page) == before, first
    over = tuple(msgspec.structs.replace(one, state="resolved") for one in flood.alarms)
    station.change(alarms=over)
    expect(strip(page)).to_contain_text("No open alarms")
    assert places(page) == before


@pytest.mark.parametrize("size", SIZES)
def test_hidden_alarms_are_one_press_away_and_move_nothing(
    stage: Stage, size: tuple[int, int]
) -> None:
    page, _ = stage.open(scenes.flood(40, down=9))
    page.set_viewport_size({"width": size[0], "height": size[1]})
    strip(page).get_by_role("button", name="more").wait_for()
    before = places(page)
    rows = strip(page).get_by_role("listitem")
    shown = rows.count()
    strip(page).get_by_role("button", name=f"+{10 - shown} more").click()
    expect(rows).to_have_count(49)  # one by one
    assert places(page) == before
    page.keyboard.press("Escape")
    expect(rows).to_have_count(shown)
    expect(strip(page).get_by_role("button", name="more")).to_be_focused()
    assert flaws(page) == []


def test_one_press_acknowledges_all_alarms_of_a_member(stage: Stage) -> None:
    page, station = stage.open(scenes.bad_minute())
    fall, still, *_ = station.picture.alarms
    rows = strip(page).get_by_role("listitem")
    expect(rows).to_have_count(3)
    expect(rows.first).to_contain_text(f"{fall.text} + No motion, now 55 s")
    press(rows.first.get_by_role("button", name="Acknowledge"))
    station.expect_changes(*(f"/alarms/{quote(one.alarm_id)}/acknowledge" for one in (fall, still)))
    station.change(alarms=(scenes.taken(fall), scenes.taken(still)))
    expect(rows.filter(has_text=fall.text)).to_contain_text("acknowledged by chief")
    press(rows.filter(has_text=fall.text).get_by_role("button", name="Resolve"))
    expect(page.get_by_role("dialog", name="Resolve 2 alarms")).to_be_visible()


def test_press_directly_after_a_change_of_the_row_is_ignored(stage: Stage) -> None:
    """It was meant for the heat alone; the mayday would never be seen."""
    page, station = stage.open(scenes.bad_minute())
    mira = station.picture.units[2]
    mayday = scenes.alarm(2, "mayday", 1, "Mayday from Mira Okafor", 0)
    still = scenes.alarm(2, "no-motion", 2, "Mira Okafor has not moved for 30 s", 0)
    acknowledge = strip(page).get_by_role("button", name="Acknowledge: 186 °C")
    acknowledge.wait_for()
    page.clock.pause_at(page.evaluate("Date.now() + 1000"))
    heat = station.picture.alarms[2]
    changed = scenes.with_alarms(mira, heat, still, heat_level="warning", ambient_degc=186.0)
    station.change(alarms=(still,), units=(changed,))
    expect(strip(page)).to_contain_text("+ No motion")
    acknowledge.click()
    station.expect_changes()
    expect(page.locator(".notice")).to_contain_text("the press was ignored. Press again.")
    page.clock.run_for(700)
    acknowledge.click()
    station.expect_changes(*(f"/alarms/{quote(one.alarm_id)}/acknowledge" for one in (heat, still)))
    station.change(alarms=(mayday,), units=(scenes.with_alarms(mira, mayday, heat, still),))
    rows = strip(page).get_by_role("listitem")
    expect(rows.filter(has_text="Mayday from Mira Okafor")).to_contain_text("+ Heat: warning")


def test_alarm_flood_is_one_row_with_one_acknowledgement(stage: Stage) -> None:
    page, station = stage.open(scenes.flood(40, down=1), timezone="UTC")
    rows = strip(page).get_by_role("listitem")
    expect(rows).to_have_count(2)
    expect(rows.first).to_contain_text("Astrid Lindqvist may have fallen + Link lost")
    expect(rows.last).to_contain_text("39 units lost their link at 10:06")
    press(rows.last.get_by_role("button", name="Acknowledge"))
    lost = [one for one in station.picture.alarms if one.rule == "link-lost"][1:]
    station.expect_changes(*(f"/alarms/{quote(one.alarm_id)}/acknowledge" for one in lost))
    station.change(alarms=tuple(map(scenes.taken, lost)))
    expect(rows.last).to_contain_text("acknowledged by chief")
    expect(rows.last.get_by_role("button", name="Resolve")).to_have_count(0)
    rows.last.get_by_role("button", name="39 units lost their link").click()
    expect(strip(page).get_by_role("button", name="Resolve")).to_have_count(39)


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_alarm_zone_and_list_are_accessible(stage: Stage, scheme: str) -> None:
    page, _ = stage.open(scenes.flood(40, down=9))
    page.emulate_media(color_scheme="dark" if scheme == "dark" else "light")
    assert barriers(page) == []
    strip(page).get_by_role("button", name="more").click()
    assert barriers(page) == []
