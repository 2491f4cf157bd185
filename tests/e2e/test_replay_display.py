"""A replay: nobody takes the past for the present, nor misses what is live beside it."""

from __future__ import annotations

import re

import msgspec
import pytest
from playwright.sync_api import expect

from base_station.views.wire import GapView, Snapshot
from tests.e2e import scenes
from tests.e2e.console_page import close, menu, strip
from tests.e2e.layout_checks import flaws
from tests.e2e.replay_page import begin_replay
from tests.e2e.stage import SCREENS, Stage

MISSING = (
    "segments 2 to 3 of the log are missing: what happened from 2026-11-21 14:10:00 UTC until "
    "2026-11-21 14:40:00 UTC is not known"
)
TORN = "000004-20261121T144000Z.mcap was not ended in order: its last 3000 bytes cannot be read"


def over_a_day(*flaws: str) -> Snapshot:
    """An incident that was opened the day before."""
    shown = scenes.past()
    assert shown.replay is not None
    start_ms = shown.replay.start_ms - 24 * 60 * scenes.MINUTE_MS
    replay = msgspec.structs.replace(shown.replay, start_ms=start_ms, flaws=flaws)
    return msgspec.structs.replace(shown, replay=replay)


def test_live_banner_on_a_phone_keeps_the_name_of_the_replay(stage: Stage) -> None:
    page, _ = stage.open(scenes.bad_minute(), "phone")
    page.get_by_role("button", name="Menu").click()
    banner = begin_replay(page)
    expect(banner).to_contain_text("Live now: 4 open alarms")
    what = banner.get_by_text("Recorded, not live.")
    expect(what).to_contain_text(scenes.INCIDENT.name)
    box = what.bounding_box()
    assert box is not None
    assert box["height"] < 50, "two lines, and no column of words"


def test_urgent_live_alarm_is_shown_over_a_replay_and_leads_to_it(stage: Stage) -> None:
    page, station = stage.open(scenes.quiet())
    banner = begin_replay(page)
    dialog = menu(page, "Account")
    expect(dialog).not_to_contain_text("Jonas Bergman may have fallen")  # that was then
    mayday = scenes.alarm(0, "mayday", 1, "MAYDAY of Astrid Lindqvist", 2)
    station.change(alarms=(mayday,), units=(scenes.with_alarms(scenes.unit(0), mayday),))
    now = dialog.get_by_role("alert").get_by_role("button")
    expect(now).to_have_text("Live now: MAYDAY of Astrid Lindqvist")
    now.click()
    expect(banner).to_have_count(0)
    expect(page.locator(".card.chosen .name")).to_have_text("Astrid Lindqvist")
    expect(page.locator(".card.chosen")).to_contain_text("Mayday")


def test_replay_station_shows_no_past_alarm_as_live(
    stage: Stage,
) -> None:
    page, _ = stage.open(scenes.past())
    expect(strip(page)).to_contain_text("Jonas Bergman may have fallen")
    expect(menu(page, "Account").get_by_role("button", name="may have fallen")).to_have_count(0)


def test_replay_does_not_show_the_stations_health(stage: Stage) -> None:
    """Measurements of the machine are not replayed; current problems are shown beside it."""
    health = msgspec.structs.replace(scenes.HEALTH, problems=("only 700 MB are free", "b"))
    page, _ = stage.open(msgspec.structs.replace(scenes.quiet(), health=health))
    light = page.get_by_role("button", name="Station health")
    expect(light).to_be_visible()
    banner = begin_replay(page)
    expect(light).to_have_count(0)
    expect(banner).to_contain_text("Station: only 700 MB are free +1")
    assert flaws(page) == []
    banner.get_by_role("button", name="Back to live").click()
    expect(light).to_be_visible()


def test_replay_seeks_from_alarm_to_alarm(stage: Stage) -> None:
    page, _ = stage.open(scenes.past())
    bar = page.get_by_role("region", name="Replay")
    with page.expect_request(re.compile("/replays/r1$")) as sent:
        bar.get_by_role("button", name="Alarm before").click()
    last_ms = max(alarm["raised_ms"] for alarm in scenes.PAST_ALARMS)
    assert sent.value.post_data_json == {"at_ms": last_ms - 5000}
    with page.expect_request(re.compile("/replays/r1$")) as sent:
        bar.get_by_label("Go to an alarm").select_option(index=1)
    first_ms = min(alarm["raised_ms"] for alarm in scenes.PAST_ALARMS)
    assert sent.value.post_data_json == {"at_ms": first_ms - 5000}, "as they were raised"
    expect(bar.get_by_role("button", name="Next alarm")).to_be_disabled()
    expect(page.get_by_role("button", name="Evacuate")).to_have_count(0)


def test_seek_sorts_the_list_anew(stage: Stage) -> None:
    """Live, whoever gets better keeps the place for a while."""
    page, station = stage.open(scenes.past())
    expect(page.locator(".card").first).to_contain_text("Jonas Bergman")
    well = tuple(scenes.unit(index) for index in range(5))
    station.change(units=well, alarms=(), now_ms=scenes.NOW_MS - 20 * scenes.MINUTE_MS)
    jonas = page.locator(".card", has_text="Jonas Bergman")
    expect(jonas).to_have_class(re.compile("normal"), timeout=2000)


@pytest.mark.parametrize("screen", SCREENS)
def test_differences_of_a_replay_are_shown_in_the_console(stage: Stage, screen: str) -> None:
    page, _ = stage.open(over_a_day(MISSING, TORN), screen)
    reported = page.get_by_role("region", name="Replay").get_by_role("button", name="Not all is as")
    expect(reported).to_have_text("Not all is as it was: 2")
    assert flaws(page) == []
    reported.click()
    dialog = page.get_by_role("dialog")
    expect(dialog.get_by_role("listitem")).to_have_text([MISSING, TORN])
    assert flaws(page) == []


def test_replay_of_a_complete_log_shows_no_warning(stage: Stage) -> None:
    page, _ = stage.open(scenes.past())
    bar = page.get_by_role("region", name="Replay")
    expect(bar).to_contain_text("Recorded, not live")
    expect(bar).not_to_contain_text("Not all")


@pytest.mark.parametrize("screen", ["laptop", "tablet upright", "phone on its side"])
def test_gap_of_the_record_is_named_and_its_data_shown_as_old(stage: Stage, screen: str) -> None:
    shown = scenes.past()
    assert shown.replay is not None
    from_ms = shown.replay.at_ms - scenes.MINUTE_MS
    gap = GapView(from_ms, from_ms + 2 * scenes.MINUTE_MS)
    page, station = stage.open(shown, screen)
    expect(page.get_by_text("No record from")).to_have_count(0)
    station.change(replay=msgspec.structs.replace(shown.replay, gap=gap))
    expect(page.get_by_role("region", name="Replay").get_by_role("alert")).to_contain_text(
        re.compile(r"No record from .*\d\d:\d\d:\d\d to .*\d\d:\d\d:\d\d")
    )
    expect(page.locator(".console")).to_have_class(re.compile("not-now"))
    assert flaws(page) == []
    station.change(replay=shown.replay)
    expect(page.get_by_text("No record from")).to_have_count(0)
    expect(page.locator(".console")).not_to_have_class(re.compile("not-now"))


def test_times_of_another_day_show_date_and_time_zone(
    stage: Stage,
) -> None:
    page, _ = stage.open(over_a_day(), timezone="Asia/Kolkata")
    expect(page.get_by_role("region", name="Replay")).to_contain_text(
        "UTC+5:30. Recorded, not live."
    )
    day = re.compile(r"^\w{3} \d{1,2}, \d{4}, \d\d:\d\d:\d\d")
    expect(page.locator("time.clock")).to_have_text(day)
    assert day.match(page.get_by_label("Go to an alarm").locator("option").nth(1).inner_text())
    seek = page.get_by_label("Time of the incident")
    assert day.match(seek.get_attribute("aria-valuetext") or "")
    expect(menu(page, "Incidents")).to_contain_text(
        "Times shown in this device's time zone (UTC+5:30)."
    )


def test_second_replay_at_a_replay_station_shows_no_live_banner(
    stage: Stage,
) -> None:
    """The picture behind it is a replay too, so the banner must stay."""
    page, station = stage.open(scenes.past())
    bar = page.get_by_role("region", name="Replay")
    expect(bar).to_contain_text("Recorded, not live")
    dialog = menu(page, "Incidents")
    expect(dialog.get_by_role("button", name="Delete data")).to_have_count(0)
    dialog.get_by_role("button", name=f"Replay {scenes.INCIDENT.name}").click()
    station.expect_changes("/replays")
    back = bar.get_by_role("button", name="Back to the first replay")
    expect(back).to_be_visible()
    expect(bar).not_to_contain_text("Live now")
    expect(bar.get_by_role("button", name="Back to live")).to_have_count(0)
    dialog = menu(page, "Incidents")
    expect(dialog.get_by_role("row", name="the station")).to_be_visible()
    expect(dialog.get_by_role("button", name="End replay")).to_have_count(0)
    close(dialog)
    assert flaws(page) == []
    back.click()
    expect(back).to_have_count(0)
    expect(bar).to_contain_text("Recorded, not live")
    expect(bar.get_by_label("Time of the incident")).to_be_visible()
    station.expect_changes("/replays", "/replays/r2")
