"""Alarms in the language of the console, from the code and the parameters of the station."""

from __future__ import annotations

import msgspec
from playwright.sync_api import expect

from base_station.views import wire
from tests.e2e import scenes
from tests.e2e.stage import Stage

STILL = wire.AlarmParametersView(member="Jonas Bergman", duration_s=34.0)


def test_alarm_is_translated_and_english_without_a_code(
    stage: Stage,
) -> None:
    page, station = stage.open(scenes.bad_minute())
    alarms = page.get_by_role("region", name="Open alarms")
    expect(alarms.locator("[data-alarm^='fall']")).to_contain_text("Jonas Bergman may have fallen")
    (fall,) = (one for one in station.picture.alarms if one.rule == "fall")
    coded = msgspec.structs.replace(fall, code="no-motion", parameters=STILL)
    station.change(alarms=(coded,))
    row = page.locator("[data-alarm^='fall']")
    expect(row).to_contain_text("Jonas Bergman: no motion, 34 s")
    page.evaluate("localStorage.setItem('muster-language', 'de')")
    page.reload()
    expect(row).to_contain_text("Jonas Bergman: keine Bewegung seit 34 s")
    old = page.locator("[data-alarm^='heat']")
    expect(old).to_contain_text("186 °C around the equipment of Mira Okafor")
    assert page.locator("html").get_attribute("lang") == "de"
