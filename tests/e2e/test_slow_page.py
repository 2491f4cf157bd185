"""A page on a slow processor confirms what it has shown, and shows the newest state."""

from __future__ import annotations

import msgspec
from playwright.sync_api import expect

from tests.e2e import scenes
from tests.e2e.stage import Stage
from tests.rig.waiting import until

PEOPLE, DELTAS = 200, 10


def test_slow_page_confirms_shown_messages_and_shows_the_newest(stage: Stage) -> None:
    page, station = stage.open(scenes.quiet(PEOPLE), "large")
    page.context.new_cdp_session(page).send("Emulation.setCPUThrottlingRate", {"rate": 4})
    for number in range(DELTAS):
        station.change(
            units=tuple(
                msgspec.structs.replace(
                    one,
                    position=msgspec.structs.replace(
                        one.position, t_ms=scenes.NOW_MS + number, floor=number
                    ),
                )
                for one in station.picture.units
                if one.position is not None
            )
        )
        page.wait_for_timeout(50)
    everything = 1 + PEOPLE + DELTAS  # a picture, its trails, and what changed

    def is_confirmed() -> bool:
        page.wait_for_timeout(100)
        return station.confirmed == everything

    until(is_confirmed, "the page has shown everything that came")
    first = page.locator(".cards > [data-unit]").first
    expect(first).to_contain_text(f"floor {DELTAS - 1}")
    # An alarm does not wait for the clock that cards of who is well go by.
    fallen = scenes.alarm(0, "fall", 1, "fallen", 0)
    station.change(alarms=(fallen,), units=(scenes.with_alarms(station.picture.units[0], fallen),))
    expect(page.get_by_role("region", name="Open alarms").locator("li")).to_have_count(1)
