"""Sounds of alarms, and a browser that blocks them."""

from __future__ import annotations

import pytest
from playwright.sync_api import expect

from tests.e2e import scenes
from tests.e2e.stage import Stage


def test_alarm_sounds_unless_sound_is_off(stage: Stage) -> None:
    page, station = stage.open(scenes.quiet())
    page.evaluate(
        """() => {
          window.tones = 0;
          const part = { setValueAtTime() {}, linearRampToValueAtTime() {} };
          const silent = {
            frequency: {}, gain: part, setPeriodicWave() {}, start() {}, stop() {},
            connect: (next) => next,
          };
          window.AudioContext = class {
            state = "running";
            constructor() { window.tones += 1; }
            createOscillator() { return { ...silent }; }
            createGain() { return { ...silent }; }
            createPeriodicWave() {}
            close() {}
          };
        }"""
    )
    expect(page.get_by_role("button", name="No sound yet")).to_be_visible()
    page.keyboard.press("Shift")
    fall = scenes.bad_minute().alarms[0]
    station.change(alarms=(fall,))
    page.wait_for_function("window.tones === 1")
    page.get_by_role("button", name="Sound on").click()
    expect(page.get_by_role("button", name="Sound off")).to_be_visible()
    station.change(alarms=(scenes.bad_minute().alarms[1],))
    page.wait_for_timeout(700)
    assert page.evaluate("window.tones") == 1


@pytest.mark.parametrize("key", [None, "Enter", "Space"])
def test_press_of_the_no_sound_button_enables_sound(stage: Stage, key: str | None) -> None:
    """It is the first press on the page, which alone lets the browser play."""
    page, _ = stage.open(scenes.quiet())
    button = page.get_by_role("button", name="No sound yet")
    if key is None:
        button.click()
    else:
        button.press(key)
    expect(page.get_by_role("button", name="Sound on")).to_be_visible()
    page.get_by_role("button", name="Sound on").click()
    expect(page.get_by_role("button", name="Sound off")).to_be_visible()


def test_sound_blocked_by_the_browser_is_not_shown_as_on(stage: Stage) -> None:
    page, _ = stage.open(scenes.quiet())
    page.evaluate(
        """() => {
          const part = { setValueAtTime() {}, linearRampToValueAtTime() {} };
          const silent = {
            frequency: {}, gain: part, setPeriodicWave() {}, start() {}, stop() {},
            connect: (next) => next,
          };
          window.AudioContext = class {
            state = "suspended";
            createOscillator() { return { ...silent }; }
            createGain() { return { ...silent }; }
            createPeriodicWave() {}
            close() {}
          };
        }"""
    )
    page.get_by_role("button", name="No sound yet").click()
    expect(page.get_by_role("button", name="Sound on")).to_be_visible()
    expect(page.get_by_role("button", name="No sound yet")).to_be_visible()
