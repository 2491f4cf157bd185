"""The strip of open alarms: present values beside those of the raising."""

from __future__ import annotations

import msgspec
from playwright.sync_api import expect

from base_station.views import wire
from tests.e2e import scenes
from tests.e2e.layout_checks import flaws
from tests.e2e.stage import SCREENS, Stage


def test_alarm_shows_the_current_value_and_its_age(stage: Stage) -> None:
    """Its text keeps the figure of when it was raised, which nobody is to take for the present."""
    page, station = stage.open(scenes.bad_minute())
    alarms = page.get_by_role("region", name="Open alarms")
    row = {rule: alarms.locator(f"[data-alarm^='{rule}']") for rule in ("heat", "fall")}
    expect(row["heat"]).to_contain_text("186 °C around the equipment of Mira Okafor")
    expect(row["heat"]).to_contain_text("now 186 °C")
    expect(row["fall"]).to_contain_text("+ No motion, now 55 s")
    hot, lying = station.picture.units[2], station.picture.units[1]
    walking = wire.StatusView("walking", 0.0, 0.07, False, 80, 51.0, None, "unknown", ())
    station.change(
        units=(
            msgspec.structs.replace(hot, ambient_degc=231.4, heat_used=0.65),
            msgspec.structs.replace(lying, status=walking),
        )
    )
    expect(row["heat"]).to_contain_text("186 °C around")
    expect(row["heat"].locator(".since")).to_contain_text("ago now 231 °C, 65 %")
    expect(row["fall"]).to_contain_text("+ No motion, has moved since")
    for name, (width, height) in SCREENS.items():
        page.set_viewport_size({"width": width, "height": height})
        assert flaws(page) == [], name
