"""The radio of an incident: in step with its replay after a start, a jump and a pause, and heard at
an alarm.
"""

from __future__ import annotations

import re
import time
from functools import cache

import msgspec
import numpy as np
from playwright.sync_api import Locator, Page, Route, expect

from base_station.radio.encoder import VoiceEncoder
from base_station.radio.ogg import ogg_opus
from base_station.radio.opus import SAMPLE_HZ
from base_station.views.wire import Snapshot
from tests.e2e import scenes
from tests.e2e.played_station import PlayedStation
from tests.e2e.replay_page import begin_replay
from tests.e2e.stage import ANSWERS, PAST, Stage
from tests.rig.tone_pattern import tone_pattern
from tests.rig.waiting import PATIENCE_S, until

WINDOW_S = 300
DRIFT_MAX_MS = 200.0
STEADY = 15  # looks in succession
SHOWN = scenes.past()
assert SHOWN.replay is not None
START_MS, END_MS = SHOWN.replay.start_ms, SHOWN.replay.end_ms
RADIO = {
    "from_ms": START_MS,
    "until_ms": END_MS,
    "channels": [
        {"name": name, "recorded_ms": [[START_MS, END_MS]], "voice_ms": []}
        for name in ("Command", "Tac-1")
    ],
}


@cache
def sound() -> bytes:
    """As long as a window."""
    encoder = VoiceEncoder(16_000, -50.0)
    second = tone_pattern(0, 0, 2 * SAMPLE_HZ, SAMPLE_HZ)
    pcm = np.tile(second, WINDOW_S // 2).tobytes()
    return ogg_opus(packet for _, packet in encoder.push(pcm))


def give_sound(route: Route) -> None:
    asked = re.fullmatch(r"bytes=(\d+)-(\d*)", route.request.headers.get("range", ""))
    content = sound()
    first = int(asked[1]) if asked else 0
    last = int(asked[2]) if asked and asked[2] else len(content) - 1
    headers = {
        "Content-Type": "audio/ogg",
        "Accept-Ranges": "bytes",
        "Content-Range": f"bytes {first}-{last}/{len(content)}",
    }
    route.fulfill(status=206 if asked else 200, headers=headers, body=content[first : last + 1])


def open_page(stage: Stage, picture: Snapshot) -> tuple[Page, PlayedStation]:
    answers = {**ANSWERS, f"{PAST}/radio": RADIO}
    page, station = stage.open(picture, answers=answers)
    page.route(re.compile(r"/radio/[^/]+\?"), give_sound)
    return page, station


def expect_in_step(page: Page, station: PlayedStation, from_ms: int, speed: float) -> None:
    """The replay plays from there, and the sound comes into step with it and stays there."""
    began_s, steady = time.monotonic(), 0
    drifts_ms: list[float] = []
    while steady < STEADY:
        elapsed_s = time.monotonic() - began_s
        show(station, from_ms + round(1_000.0 * speed * elapsed_s), speed=speed, playing=True)
        page.wait_for_timeout(100)
        media_ms = place_ms(page)
        replay_ms = from_ms + 1_000.0 * speed * (time.monotonic() - began_s)
        drifts_ms.append(media_ms - replay_ms)
        steady = steady + 1 if abs(drifts_ms[-1]) < DRIFT_MAX_MS * speed else 0
        assert elapsed_s < PATIENCE_S, drifts_ms


def show(station: PlayedStation, at_ms: int, *, speed: float, playing: bool) -> None:
    assert SHOWN.replay is not None
    replay = msgspec.structs.replace(SHOWN.replay, at_ms=at_ms, speed=speed, playing=playing)
    picture = msgspec.structs.replace(SHOWN, replay=replay)
    station._replays[-1].send(msgspec.json.encode(picture).decode())


def place_ms(page: Page) -> float:
    """Position of the audio, on the clock of the incident."""
    return float(
        player(page)
        .locator("audio")
        .evaluate("(audio) => Number(audio.dataset.fromMs) + 1000 * audio.currentTime")
    )


def player(page: Page) -> Locator:
    return page.get_by_role("group", name="Radio")


def test_radio_is_synchronised_with_the_replay(stage: Stage) -> None:
    page, station = open_page(stage, scenes.quiet())
    begin_replay(page)
    expect(player(page).locator("audio")).to_have_count(0)  # off until it is wanted
    player(page).get_by_role("button", name="Radio: off").click()
    expect_in_step(page, station, START_MS + 20_000, 1.0)
    expect_in_step(page, station, START_MS + 200_000, 1.0)  # after a jump
    expect_in_step(page, station, START_MS + 100_000, 2.0)
    show(station, START_MS + 50_000, speed=1.0, playing=False)
    page.wait_for_function("() => document.querySelector('audio').paused")
    until(lambda: abs(place_ms(page) - START_MS - 50_000) < DRIFT_MAX_MS, "the place")
    show(station, START_MS + 51_000, speed=16.0, playing=True)
    expect(player(page)).to_contain_text("Heard at half to double speed")
    page.wait_for_function("() => document.querySelector('audio').paused")
    player(page).get_by_label("Radio channel").select_option("Tac-1")
    expect(player(page).locator("audio")).to_have_attribute("src", re.compile("/radio/Tac-1"))


def test_a_replay_without_radio_has_no_player(stage: Stage) -> None:
    page, _ = stage.open(scenes.quiet())
    begin_replay(page)
    expect(page.get_by_role("slider", name="Time of the incident")).to_be_visible()
    expect(player(page)).to_have_count(0)


def test_radio_of_an_alarm_starts_ten_seconds_before_it(stage: Stage) -> None:
    raised_ms = START_MS + 60_000
    traces = ("motionless_s", "temperature_degc", "battery_level", "height_m", "stated_error_m")
    explanation: dict[str, object] = {
        **{name: [] for name in (*traces, "live_ms", "buttons_ms")},
        "alarm_id": "a",
        "rule": "fall",
        "raised_ms": raised_ms,
        "thresholds": {},
        "crossing": None,
    }
    page, _ = open_page(stage, scenes.bad_minute())
    page.route(re.compile("/explanation$"), lambda route: route.fulfill(json=explanation))
    page.locator(".card", has_text="Jonas Bergman").click()
    page.get_by_role("button", name=re.compile("^Reasons? of the alarm")).click()
    dialog = page.get_by_role("dialog")
    dialog.get_by_role("button", name="Hear it (Tac-1)").first.click()
    sound = dialog.locator("audio")
    expect(sound).to_have_attribute("src", re.compile(rf"/Tac-1\?from_ms={raised_ms - 10_000}&"))
    until(lambda: sound.evaluate("(audio) => audio.currentTime") > 0.5, "the sound")
