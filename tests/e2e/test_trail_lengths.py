"""The trail of a person in danger or chosen is drawn from its beginning, of others for minutes."""

from __future__ import annotations

import msgspec
from playwright.sync_api import Page

from base_station.views import wire
from tests.e2e import scenes
from tests.e2e.console_page import drawn, painted
from tests.e2e.played_station import PlayedStation
from tests.e2e.stage import Stage

CALM, DOWN = 0, 1  # of the bad minute
AGO_MS = 40 * scenes.MINUTE_MS


def walked_long_ago(station: PlayedStation, index: int) -> None:
    """A straight way over the whole plan, well before the last five minutes; thinned."""
    begin = wire.TrailPoint(scenes.NOW_MS - AGO_MS, -4.0, -2.0, None)
    end = wire.TrailPoint(scenes.NOW_MS - AGO_MS + 60_000, 14.0, 18.0, None)
    points = msgspec.Raw(wire.encoded_trail([begin, end]))
    station.show_trail(wire.Trail(scenes.unit_id(index), points))


def ink(page: Page, colours: tuple[str, ...]) -> int:
    page.wait_for_timeout(600)  # the plan is drawn five times a second at most
    drawn(page)
    return sum(painted(page, colour) for colour in colours)


def test_trail_of_a_casualty_is_complete_until_the_alarm_is_resolved(stage: Stage) -> None:
    page, station = stage.open(scenes.bad_minute())
    assert station.picture.units[DOWN].alarms
    colours = ("--immediate",)
    before = ink(page, colours)
    walked_long_ago(station, DOWN)
    whole = ink(page, colours)
    assert whole > before + 100
    calm = msgspec.structs.replace(scenes.quiet().units[DOWN], alarms=())
    resolved = [
        msgspec.structs.replace(one, state="resolved")
        for one in station.picture.alarms
        if one.unit_id == calm.unit_id
    ]
    station.change(units=(calm,), alarms=tuple(resolved))
    assert ink(page, colours) < whole - 100


def test_trail_of_the_chosen_member_is_complete(stage: Stage) -> None:
    page, station = stage.open(scenes.quiet())
    none = wire.Trail(scenes.unit_id(CALM), msgspec.Raw(b"[]"))
    station.show_trail(none)
    before = ink(page, ("--normal",))
    walked_long_ago(station, CALM)
    assert ink(page, ("--normal",)) < before + 50, "of others the last five minutes"
    page.locator(f"[data-unit='{scenes.unit_id(CALM)}'] .card-head").click()
    whole = ink(page, ("--chosen",))
    station.show_trail(none)
    assert ink(page, ("--chosen",)) < whole - 100
