"""A failing card, panel, dialog or message is named on the screen, and affects no other."""

from __future__ import annotations

import json

import msgspec
import pytest
from playwright.sync_api import Page, expect

from base_station.views.wire import Snapshot
from tests.e2e import scenes
from tests.e2e.stage import ANSWERS, Stage


def cards(page: Page) -> int:
    return page.locator(".cards > [data-unit]").count()


def with_unit(shown: Snapshot, index: int, **broken: object) -> Snapshot:
    units = [
        msgspec.structs.replace(one, **broken) if i == index else one
        for i, one in enumerate(shown.units)
    ]
    return msgspec.structs.replace(shown, units=tuple(units))


@pytest.mark.parametrize(
    "broken", [{"trust": None}, {"status": 5}, {"alarms": None}, {"person": {"name": {"en": "J"}}}]
)
def test_failing_card_is_reported_and_the_others_are_shown(
    stage: Stage, broken: dict[str, object]
) -> None:
    shown = with_unit(scenes.quiet(4), 1, **broken)
    page, station = stage.open(shown)
    expect(page.locator(".cards > li")).to_have_count(4)
    failed = page.locator(".cards > .cannot-show")
    if "person" not in broken and "status" not in broken:
        expect(failed).to_contain_text("The card of")
        expect(failed).to_contain_text("cannot be shown:")
        assert cards(page) == 3
    whole = scenes.quiet(4).units[1]
    station.change(units=(whole,))  # what it says next is well
    expect(failed).to_have_count(0)
    expect(page.locator(".cards > [data-unit]")).to_have_count(4)


ROOM = {"type": "Feature", "properties": {"kind": "room", "floor": 0, "name": "store"}}


@pytest.mark.parametrize(
    "geometry", [None, 5, {"type": "Polygon"}, {"type": "Circle", "coordinates": [0, 0]}]
)
def test_failing_feature_of_the_plan_hides_no_card_and_no_wall(
    stage: Stage, geometry: object
) -> None:
    plan = json.loads(scenes.PLAN.read_bytes())
    plan["features"].insert(0, {**ROOM, "geometry": geometry})
    encoded = msgspec.Raw(json.dumps(plan).encode())
    page, _ = stage.open(msgspec.structs.replace(scenes.quiet(4), plan=encoded))
    if isinstance(geometry, dict):  # the others have no place, and nothing of them is drawn
        fault = page.locator(".cannot-show, .faults").first
        expect(fault).to_contain_text("cannot be shown:")
    expect(page.locator(".cards > li")).to_have_count(4)
    expect(page.locator(".map canvas").first).to_be_visible()


def test_failing_panel_hides_no_other(stage: Stage) -> None:
    shown = msgspec.structs.replace(scenes.bad_minute(4), beacons=None, pins=5)
    page, _ = stage.open(shown)
    expect(page.locator(".cannot-show, .faults").first).to_contain_text("cannot be shown:")
    expect(page.locator(".cards > [data-unit]")).to_have_count(len(shown.units))
    expect(page.get_by_role("region", name="Open alarms").locator("li").first).to_be_visible()


def test_failing_alarm_hides_no_other(stage: Stage) -> None:
    shown = scenes.bad_minute(4)
    broken = msgspec.structs.replace(shown.alarms[0], text={"en": "fallen"})
    page, _ = stage.open(msgspec.structs.replace(shown, alarms=(broken, *shown.alarms[1:])))
    strip = page.get_by_role("region", name="Open alarms")
    expect(strip.locator("li")).to_have_count(3)  # a member each
    expect(strip.locator(".alarm", has_text="Mira Okafor")).to_be_visible()


def test_failing_dialog_closes_with_a_message(stage: Stage) -> None:
    page, _ = stage.open(scenes.quiet(3), answers={**ANSWERS, "/people": [None]})
    page.get_by_role("navigation").get_by_role("button", name="People").click()
    expect(page.locator(".faults")).to_contain_text("This dialog cannot be shown:")
    expect(page.locator("dialog")).to_have_count(0)
    assert cards(page) == 3
    page.locator(".faults").get_by_role("button", name="OK").click()
    expect(page.locator(".faults")).to_have_count(0)


BAD_UNIT = '{"type": "field_delta", "seq": 0, "after_seq": SEQ, "units": {"FF-01": 5}}'


@pytest.mark.parametrize("reported", [BAD_UNIT, "no JSON", "null"])
def test_failing_message_affects_no_other(stage: Stage, reported: str) -> None:
    page, station = stage.open(scenes.quiet(3))
    station.say(reported.replace("SEQ", str(station.picture.seq)))
    expect(page.locator(".faults")).to_contain_text("A message of the station cannot be shown:")
    first = station.picture.units[0]
    assert first.person is not None
    named = msgspec.structs.replace(first.person, name="Ada Newcomer")
    station.change(units=(msgspec.structs.replace(first, person=named),))
    expect(page.locator(".cards")).to_contain_text("Ada Newcomer")


def test_omitted_features_of_a_damaged_plan_are_reported(stage: Stage) -> None:
    plan = json.loads(scenes.PLAN.read_bytes())
    plan["muster"]["damage"] = "The plan is damaged: feature 3"
    encoded = msgspec.Raw(json.dumps(plan).encode())
    page, _ = stage.open(msgspec.structs.replace(scenes.quiet(3), plan=encoded))
    expect(page.get_by_role("region", name="Plan")).to_contain_text(
        "The plan is damaged: feature 3"
    )


def test_lost_link_hides_the_stations_health(stage: Stage) -> None:
    page, station = stage.open(scenes.quiet(3))
    header = page.locator(".header")
    expect(header).to_contain_text("Base station OK")
    station.fall_silent()
    expect(header).to_contain_text("Connection lost")
    expect(header).to_contain_text("Base station state unknown")
    expect(header).not_to_contain_text("Base station OK")
