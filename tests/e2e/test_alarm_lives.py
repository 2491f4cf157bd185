"""List of all alarms with their transitions: filtered, resolved with a reason, also in a replay."""

from __future__ import annotations

import json
import re

import msgspec
import pytest
from playwright.sync_api import Page, expect

from tests.e2e import scenes
from tests.e2e.console_page import barriers, choose_theme, menu, press, strip
from tests.e2e.layout_checks import flaws
from tests.e2e.stage import ANSWERS, PAST, SCREENS, Stage

HEAT = msgspec.structs.replace(scenes.bad_minute().alarms[2], alarm_id="heat:earlier")
RESOLVED = scenes.life(HEAT, 3, reason="found_and_helped", note="led out by Engine 2", peak=243.0)
LIVES = [*(scenes.life(one) for one in scenes.bad_minute().alarms), RESOLVED]


def open_list(page: Page) -> None:
    page.get_by_role("heading", level=1).wait_for()
    page.keyboard.press("a")
    page.get_by_role("dialog", name="Alarms").wait_for()


def test_alarm_shows_its_transitions_reason_note_and_peak(stage: Stage) -> None:
    answers = {**ANSWERS, f"{PAST}/alarms": LIVES}
    page, _ = stage.open(scenes.bad_minute(), answers=answers, timezone="UTC")
    open_list(page)
    dialog = page.get_by_role("dialog")
    expect(dialog.get_by_role("status").filter(has_text="5 alarms, 4 open")).to_be_visible()
    ended = dialog.locator(".alarm-life.resolved")
    for words in (
        "acknowledged (mia)",
        "resolved (chief: Found and helped, led out by Engine 2)",
        "Measured peak: 243 °C",
    ):
        expect(ended).to_contain_text(words)
    expect(ended.get_by_role("button", name="Resolve")).to_have_count(0)
    for name, (width, height) in SCREENS.items():
        page.set_viewport_size({"width": width, "height": height})
        assert flaws(page) == [], name
    for scheme in ("light", "dark"):
        page.emulate_media(color_scheme=scheme)
        assert barriers(page) == [], scheme
    page.keyboard.press("Escape")
    page.set_viewport_size({"width": 1280, "height": 800})
    choose_theme(page, "Red light")
    open_list(page)
    assert barriers(page) == [], "red light"


@pytest.mark.parametrize("count", [40, 200])
def test_the_list_is_filtered_by_member_kind_level_state_and_time(stage: Stage, count: int) -> None:
    shown = scenes.flood(count, down=3)
    old = [scenes.life(one, 30, reason="false_alarm", note="") for one in shown.alarms[:2]]
    old = [{**one, "alarm_id": f"old {one['alarm_id']}"} for one in old]
    answers = {**ANSWERS, f"{PAST}/alarms": [*map(scenes.life, shown.alarms), *old]}
    page, _ = stage.open(shown, answers=answers)
    open_list(page)
    dialog = page.get_by_role("dialog")
    total = count + 5

    def counts(words: str) -> None:
        expect(dialog.get_by_role("status").filter(has_text=words)).to_be_visible()

    counts(f"{total} alarms, {count + 3} open")
    for label, option, words in (
        ("Kind", "Fall", f"4 of {total}"),
        ("State", "Resolved", f"1 of {total}"),
        ("State", "Open", f"3 of {total}"),
        ("Member", scenes.person(1).name, f"1 of {total}"),
    ):
        dialog.get_by_role("combobox", name=label).select_option(option)
        counts(words)
    dialog.get_by_role("button", name="Show all").click()
    counts(f"{total} alarms")
    dialog.get_by_role("combobox", name="Level").select_option("1")
    counts(f"4 of {total}")
    dialog.get_by_role("combobox", name="Raised").select_option("Last 5 min")
    counts(f"3 of {total}")
    assert flaws(page) == []


def test_a_reason_and_a_note_go_to_the_station_from_zone_and_list(stage: Stage) -> None:
    page, station = stage.open(scenes.bad_minute())
    heat = scenes.bad_minute().alarms[2]
    station.change(alarms=(scenes.taken(heat),))
    row = strip(page).get_by_role("listitem").filter(has_text="186 °C")
    press(row.get_by_role("button", name="Resolve"))
    dialog = page.get_by_role("dialog", name="Resolve this alarm")
    expect(dialog).to_contain_text(heat.text)
    expect(dialog.get_by_role("button", name="Other")).to_be_disabled()
    assert barriers(page) == []
    for name, (width, height) in SCREENS.items():
        page.set_viewport_size({"width": width, "height": height})
        assert flaws(page) == [], name
    page.set_viewport_size({"width": 1280, "height": 800})
    dialog.get_by_label("Note").fill("gloves over a lamp")
    with page.expect_request(re.compile("/resolve$")) as sent:
        press(dialog.get_by_role("button", name="Other"))
    expected = {
        "last_raised_ms": heat.last_raised_ms, "reason": "other", "note": "gloves over a lamp",
    }  # fmt: skip
    assert json.loads(sent.value.post_data or "") == expected
    expect(dialog).to_have_count(0)
    open_list(page)
    life = page.locator(".alarm-life").filter(has_text="Jonas Bergman may have fallen")
    life.get_by_role("button", name="Resolve").click()
    with page.expect_request(re.compile("/resolve$")) as sent:
        press(life.get_by_role("button", name="Member is well"))
    assert json.loads(sent.value.post_data or "")["reason"] == "member_well"
    assert barriers(page) == []


def test_replay_lists_the_alarms_and_their_times_seek(
    stage: Stage,
) -> None:
    answers = {**ANSWERS, f"{PAST}/alarms": LIVES}
    page, _ = stage.open(scenes.quiet(), answers=answers, timezone="UTC")
    menu(page, "Incidents").get_by_role("button", name=f"Replay {scenes.INCIDENT.name}").click()
    expect(page.get_by_role("region", name="Replay")).to_contain_text("Recorded, not live")
    strip(page).get_by_role("button", name="All alarms").click()
    ended = page.locator(".alarm-life.resolved")
    expect(ended.get_by_role("button", name="Resolve")).to_have_count(0)
    assert barriers(page) == []
    with page.expect_request(re.compile(r"/replays/r2$")) as sent:
        ended.locator(".changes").get_by_role("button").last.click()
    assert sent.value.post_data_json == {"at_ms": RESOLVED["changed_ms"] - 5_000}
