"""What somebody tired, in haste or looking elsewhere must see, hear, and not do by a slip."""

from __future__ import annotations

import re
from collections.abc import Callable
from datetime import UTC, datetime, timedelta
from pathlib import Path
from urllib.parse import quote

import msgspec
import pytest
from playwright.sync_api import Locator, Page, expect

from base_station.views.wire import AnchorView, Snapshot
from tests.e2e import scenes
from tests.e2e.console_page import barriers, confirm, menu, painted, painted_at_edges, press
from tests.e2e.looks import flaws
from tests.e2e.stage import ANSWERS, PAST, Stage


def strip(page: Page) -> Locator:
    return page.get_by_role("region", name="Open alarms")


def test_who_is_in_danger_is_first_and_whole_among_forty(stage: Stage) -> None:
    page, _ = stage.open(scenes.crowd())
    cards = page.locator(".card")
    expect(cards).to_have_count(42)
    expect(cards.first).to_contain_text("Jonas Bergman")
    expect(cards.first).to_contain_text("Fall")
    expect(cards.first.get_by_text("Battery")).to_be_visible()
    calm = page.locator(".card.normal", has_text="Astrid Lindqvist 2")
    expect(calm).to_have_class(re.compile("brief"))
    calm.get_by_role("button").click()
    expect(calm).not_to_have_class(re.compile("brief"))  # who is chosen is shown whole


def test_what_somebody_silent_did_last_says_how_old_it_is(stage: Stage) -> None:
    page, _ = stage.open(scenes.bad_minute())
    silent = page.locator(".card", has_text="Tomas Novak").locator(".activity")
    expect(silent).to_contain_text("1 min old")
    heard = page.locator(".card", has_text="Mira Okafor").locator(".activity")
    expect(heard).to_have_text("Walking")


def test_a_figure_and_the_word_behind_it_are_two_words_to_who_listens(stage: Stage) -> None:
    shown = scenes.bad_minute()
    low = scenes.alarm(1, "battery", 2, "The battery of Jonas Bergman's unit is at 7 %", 5)
    units = (shown.units[0], scenes.with_alarms(shown.units[1], low), *shown.units[2:])
    alarms = (*shown.alarms, low)
    page, _ = stage.open(msgspec.structs.replace(shown, units=units, alarms=alarms))
    hot = page.locator(".card", has_text="Mira Okafor").get_by_role("definition")
    expect(hot.filter(has_text="186")).to_have_text("186 °C warning")
    flat = page.locator(".card", has_text="Jonas Bergman").get_by_role("definition")
    expect(flat.filter(has_text="%")).to_have_text("7 % low")


def test_a_unit_that_was_switched_off_in_order_is_calm(stage: Stage) -> None:
    """Its wearer is looked for by nobody: no hatching, no doubt, no place above those at work."""
    page, _ = stage.open(scenes.switched_off())
    cards = page.locator(".card")
    expect(cards.locator(".name").first).to_have_text("Astrid Lindqvist")  # by name
    for name in ("Astrid Lindqvist", "Jonas Bergman"):
        card = cards.filter(has_text=name)
        expect(card).to_have_class(re.compile(r"\bnormal\b"))
        expect(card).not_to_have_class(re.compile("unheard"))
        assert card.evaluate("card => getComputedStyle(card).backgroundImage") == "none"
        expect(card).to_contain_text("Switched off")
        expect(card).to_contain_text("10 min old")
        expect(card).not_to_contain_text("trust")
    page.get_by_role("button", name="Floors: All").click()
    page.wait_for_timeout(600)  # the plan has come to rest
    assert painted(page, "--quiet") < 4000, "the plan is not hatched for them"


def test_whoever_is_chosen_is_in_sight_with_all_that_can_be_done(stage: Stage) -> None:
    page, _ = stage.open(scenes.crowd())
    lost = scenes.crowd().alarms[3]
    page.locator(".card").last.scroll_into_view_if_needed()
    strip(page).get_by_role("button", name=lost.text).first.click()
    actions = page.get_by_role("group", name="For Tomas Novak")
    expect(actions).to_be_in_viewport(ratio=1)
    expect(page.locator(".card.chosen .name")).to_be_in_viewport(ratio=1)
    page.locator(".card.normal").nth(5).get_by_role("button").first.click()  # at the lower edge
    expect(page.locator(".card-actions")).to_be_in_viewport(ratio=1)


def test_what_can_be_done_stays_in_sight_however_low_the_screen(stage: Stage) -> None:
    """And however long the card grows while it is looked at."""
    page, station = stage.open(scenes.crowd(), "large at 200 %")
    page.locator(".card", has_text="Tomas Novak").get_by_role("button").first.click()
    actions = page.get_by_role("group", name="For Tomas Novak")
    expect(actions).to_be_in_viewport(ratio=1)
    lost = station.picture.units[3]
    fault = scenes.alarm(3, "unit-fault", 2, f"Tomas Novak's unit: {scenes.FAULTS[1]}", 1)
    station.change(alarms=(fault,), units=(scenes.with_alarms(lost, fault),))
    expect(page.locator(".card.chosen")).to_contain_text(scenes.FAULTS[1])
    expect(actions).to_be_in_viewport(ratio=1)
    expect(actions.get_by_role("button", name="Message")).to_be_in_viewport(ratio=1)


def test_who_is_overdue_is_said_to_be_so_once(stage: Stage) -> None:
    page, station = stage.open(scenes.overdue())
    card = page.locator(".card", has_text=scenes.NAMES[0])
    expect(card).to_contain_text(re.compile(r"PAR \d+:\d+ over"))
    expect(card.get_by_label("Open alarms of this person")).to_have_count(0)
    heard = scenes.unit(0).duty
    late = station.picture.units[0]
    station.change(units=(msgspec.structs.replace(late, duty=heard),))
    open_alarms = card.get_by_label("Open alarms of this person")
    expect(open_alarms.get_by_role("listitem")).to_have_text(["Missed check-in"])


def test_two_presses_in_haste_resolve_nothing(stage: Stage) -> None:
    """The button to acknowledge is followed at its place by the one to resolve."""
    page, station = stage.open(scenes.bad_minute())
    fall = scenes.bad_minute().alarms[0]
    press(strip(page).get_by_role("button", name=f"Acknowledge: {fall.text}"))
    station.change(alarms=(scenes.taken(fall),))
    row = strip(page).get_by_role("listitem").filter(has_text=fall.text)
    page.clock.pause_at(datetime.now(UTC) + timedelta(seconds=1))  # no haste is as slow as a test
    row.get_by_role("button", name="Resolve").dblclick()
    page.clock.run_for(400)
    row.get_by_role("button", name="Yes, resolve").click()
    station.expect_changes(f"/alarms/{quote(fall.alarm_id)}/acknowledge")
    page.clock.resume()
    row.get_by_role("button", name="No").click()
    expect(row.get_by_role("button", name="Resolve")).to_be_focused()
    with page.expect_request(re.compile("/resolve$")):
        confirm(row, "Resolve")


def test_an_evacuation_takes_two_presses_at_two_places(stage: Stage) -> None:
    for screen in ("laptop", "phone"):
        page, station = stage.open(scenes.bad_minute(), screen)
        first = page.get_by_role("group", name="Commands").get_by_role("button", name="Evacuate")
        first.dblclick(force=True)
        station.expect_changes()
        page.get_by_role("button", name="Evacuate now").click()
        station.expect_changes("/commands")


def test_a_dialog_does_not_hide_what_cannot_wait(stage: Stage) -> None:
    page, _ = stage.open(scenes.bad_minute())
    dialog = menu(page, "Units")
    dialog.get_by_role("alert").get_by_role("button", name="Jonas Bergman may have fallen").click()
    expect(dialog).to_have_count(0)
    expect(page.locator(".card.chosen")).to_contain_text("Jonas Bergman")


def test_a_button_that_does_nothing_yet_looks_so(stage: Stage) -> None:
    page, _ = stage.open(scenes.quiet())
    site = menu(page, "Site")
    idle, ready = (
        site.get_by_role("button", name=name).evaluate("one => getComputedStyle(one).background")
        for name in ("Set base map", "Set place")
    )
    assert idle != ready


def test_the_place_of_a_plan_that_has_one_is_replaced_on_a_second_word(stage: Stage) -> None:
    """Whoever satellites have placed moves by it: it says by how far, and of another place anew."""
    anchor = AnchorView(57.7, 11.97, 0.0, 0.0)
    page, station = stage.open(msgspec.structs.replace(scenes.quiet(), anchor=anchor))
    site = menu(page, "Site")
    expect(site).to_contain_text("origin lies at 57.70000°, 11.97000°")
    latitude, asks = site.get_by_label("Latitude"), site.get_by_role("button", name="Set place")
    latitude.fill("57.701")
    latitude.press("Enter")
    question = site.get_by_role("group", name="Replace the place for everybody?")
    expect(question).to_contain_text("whoever satellites have placed moves by 111 m")
    expect(question.get_by_role("button", name="No")).to_be_focused()
    assert flaws(page) == []
    page.keyboard.press("Enter")
    expect(question).to_have_count(0)
    expect(asks).to_be_focused()
    asks.click()
    latitude.fill("57.702")
    expect(question).to_have_count(0)
    station.expect_changes()
    asks.click()
    expect(question).to_contain_text("moves by 223 m")
    page.wait_for_timeout(600)
    question.get_by_role("button", name="Yes, replace place").click()
    expect(site).to_have_count(0)
    station.expect_changes("/site/anchor")


def test_a_place_is_set_at_once_where_the_plan_has_none(stage: Stage) -> None:
    page, station = stage.open(scenes.quiet())
    site = menu(page, "Site")
    expect(site).to_contain_text("Nobody has said where the plan lies")
    for name in ("Latitude", "Longitude"):
        site.get_by_label(name).fill("11.5")
    site.get_by_role("button", name="Set place").click()
    expect(site).to_have_count(0)
    station.expect_changes("/site/anchor")


def test_each_fault_of_a_unit_says_which_it_is(stage: Stage) -> None:
    page, _ = stage.open(scenes.two_faults())
    card = page.locator(".card", has_text="Mira Okafor")
    faults = card.get_by_label("Open alarms of this person").get_by_role("listitem")
    expect(faults).to_have_text([f"Unit fault: {fault}" for fault in scenes.FAULTS])
    for fault in scenes.FAULTS:
        expect(strip(page)).to_contain_text(f"Mira Okafor's unit: {fault}")
    assert flaws(page) == []


def test_a_card_tells_what_befell_who_wore_the_unit_before(stage: Stage) -> None:
    """Bo is well; nobody is to look for him because of what was never resolved."""
    shown = scenes.bad_minute()
    wears_now = msgspec.structs.replace(shown.units[1], person=scenes.person(7))
    page, _ = stage.open(
        msgspec.structs.replace(shown, units=(shown.units[0], wears_now, *shown.units[2:]))
    )
    alarms = page.locator(".card", has_text="Li Na").get_by_label("Open alarms of this person")
    expect(alarms.get_by_role("listitem")).to_have_text(
        ["Fall (who wore it before)", "No motion (who wore it before)"], use_inner_text=True
    )


def test_of_who_switched_off_it_says_how_long_they_were_inside(stage: Stage) -> None:
    page, station = stage.open(scenes.switched_off())
    card = page.locator(".card", has_text="Jonas Bergman")
    expect(card).to_contain_text("Was inside4 min")
    station.change(now_ms=scenes.NOW_MS + 20 * scenes.MINUTE_MS)
    expect(card).to_contain_text("30 min ago")
    expect(card).to_contain_text("Was inside4 min")


def test_who_took_an_alarm_leaves_room_for_what_it_is_about(stage: Stage) -> None:
    """However long the name, the row is as with a short one; it says all to who points at it."""
    shown = scenes.bad_minute()
    rows_px = []
    for by in ("mia", "W" * 64):
        one = msgspec.structs.replace(shown.alarms[0], state="acknowledged", by=by)
        page, _ = stage.open(msgspec.structs.replace(shown, alarms=(one, *shown.alarms[1:])))
        row = strip(page).get_by_role("listitem").filter(has_text="may have fallen")
        expect(row.locator(".state")).to_have_attribute("title", f"acknowledged by {by}")
        box = row.bounding_box()
        assert box is not None
        rows_px.append(box["height"])
    assert rows_px[0] == rows_px[1]


@pytest.mark.parametrize("screen", ["laptop", "tablet", "phone"])
@pytest.mark.parametrize("scene", [scenes.at_the_edges, scenes.pins_at_the_edges])
def test_a_name_at_the_edge_of_the_plan_is_whole(
    stage: Stage, scene: Callable[[], Snapshot], screen: str
) -> None:
    page, _ = stage.open(scene(), screen)
    if screen == "phone":
        page.get_by_role("button", name="Plan").first.click()
    page.wait_for_timeout(1500)  # the plan has come to rest
    edges = painted_at_edges(page, "--text")
    assert edges == {"left": 0, "right": 0, "top": 0, "bottom": 0}


def test_nobody_ticks_off_who_is_down_without_a_word(stage: Stage) -> None:
    """One press for a crew or for all is for those who answered."""
    page, station = stage.open(scenes.bad_minute())
    page.locator(".par-clock").click()
    dialog = page.get_by_role("dialog", name="Roll call (PAR)")
    down = dialog.get_by_role("listitem").filter(has_text="Jonas Bergman")
    expect(down).to_contain_text("Fall, No motion")
    assert flaws(page) == []
    dialog.get_by_role("button", name="All heard", exact=True).click()
    expect(
        dialog.get_by_role("group", name="Has everybody answered, Jonas Bergman too?")
    ).to_be_visible()
    station.expect_changes()


def test_a_crew_with_somebody_down_is_ticked_off_on_a_second_word(stage: Stage) -> None:
    shown = scenes.bad_minute(7)  # two of each crew
    page, station = stage.open(shown)
    page.locator(".par-clock").click()
    crews = page.get_by_role("dialog").get_by_role("region")
    calm = crews.filter(has_text="Engine 1").get_by_role("button", name="all heard")
    press(calm)
    station.expect_changes("/check-ins")
    confirm_crew = crews.filter(has_text="Jonas Bergman")
    ticks = crews.get_by_text(re.compile("all heard", re.IGNORECASE))  # beside that for everybody
    assert {"Engine 1: all heard", "Engine 2: all heard"} <= set(ticks.all_inner_texts())
    confirm_crew.get_by_role("button", name="Engine 2: all heard").click()
    expect(confirm_crew).to_contain_text("Have all answered, Jonas Bergman too?")
    station.expect_changes("/check-ins")
    page.wait_for_timeout(600)
    confirm_crew.get_by_role("button", name="Yes, all heard").click()
    station.expect_changes("/check-ins", "/check-ins")


def test_a_floor_says_how_many_of_those_on_it_are_in_danger(stage: Stage) -> None:
    page, _ = stage.open(scenes.crowd())
    floors = page.get_by_role("group", name="Floor shown").get_by_role("button")
    expect(floors.nth(0)).to_have_accessible_name("Floor 1 , 1 in danger, of 20 people")
    expect(floors.nth(1)).to_have_accessible_name("Floor G , 20 people")


def test_escape_ends_a_dialog_and_not_what_was_begun_on_the_plan(stage: Stage) -> None:
    page, _ = stage.open(scenes.quiet())
    page.get_by_role("button", name="Beacon", exact=True).click()
    panel = page.get_by_role("form", name="Beacon")
    panel.get_by_label("Its number").fill("17")
    menu(page, "Units")
    page.keyboard.press("Escape")
    expect(page.get_by_role("dialog")).to_have_count(0)
    expect(panel.get_by_label("Its number")).to_have_value("17")
    page.keyboard.press("Escape")
    expect(panel).to_have_count(0)


def test_what_is_looked_at_by_keys_stays_until_somebody_asks_for_all(stage: Stage) -> None:
    page, station = stage.open(scenes.quiet())
    scale = page.locator(".ol-scale-line-inner")
    expect(scale).to_have_text("10 m")
    page.get_by_role("application", name="Plan of the site").focus()
    for _ in range(3):
        page.keyboard.press("+")
        page.wait_for_timeout(400)
    close_up = scale.inner_text()
    station.change(now_ms=scenes.NOW_MS + 1000)
    page.wait_for_timeout(1500)
    assert scale.inner_text() == close_up != "10 m"
    page.get_by_role("button", name="Fit").click()
    expect(scale).to_have_text("10 m")


def test_who_is_given_a_unit_is_told_to_wear_another(stage: Stage) -> None:
    """Chosen by a slip, they would be looked for where that unit is."""
    page, _ = stage.open(scenes.quiet())
    worn_by = menu(page, "Units").get_by_label("Who wears FF-01")
    worn_by.focus()
    options = worn_by.get_by_role("option")
    expect(options.filter(has_text="Jonas Bergman")).to_have_text(
        "Jonas Bergman (Engine 2), wears FF-02"
    )
    expect(options.filter(has_text="Astrid Lindqvist")).to_have_text("Astrid Lindqvist (Engine 1)")


def test_what_a_dialog_could_not_do_is_said_in_it(stage: Stage) -> None:
    """Behind it nobody could read or close it."""
    page, _ = stage.open(scenes.bad_minute())
    menu(page, "Incidents").get_by_role("button", name="How good were the positions?").click()
    dialog = page.get_by_role("dialog", name="How good were the positions?")
    notice = dialog.get_by_role("alert").filter(has_text="The station answered 404")
    notice.get_by_role("button", name="OK").click()
    expect(notice).to_have_count(0)
    assert flaws(page) == []


def test_an_incident_is_saved_or_it_is_said_why_not_and_the_console_stays(stage: Stage) -> None:
    saved = {f"{PAST}/export/csv": "unit_id,person"}
    formats = [
        {"name": name, "suffix": name, "needs_anchor": name == "gpx"} for name in ("csv", "gpx")
    ]
    answers = {**ANSWERS, **saved, "/export-formats": formats}
    page, _ = stage.open(scenes.quiet(), answers=answers)
    dialog = menu(page, "Incidents")
    save_as = dialog.get_by_label(f"Save {scenes.INCIDENT.name} as a file")
    with page.expect_download() as download:
        save_as.select_option("csv")
    assert download.value.suggested_filename == f"{scenes.INCIDENT.incident_id}.csv"
    assert "unit_id,person" in download.value.path().read_text()
    save_as.select_option("gpx")
    expect(dialog.get_by_text("The station answered 404")).to_be_visible()
    expect(save_as).to_be_enabled()
    save_as.press("ArrowDown")
    save_as.press("ArrowDown")
    with page.expect_request(re.compile("/export/")) as asked:
        save_as.press("Enter")
    assert asked.value.url.endswith("/export/gpx"), "what the keys passed is not asked for"


def test_an_incident_begins_with_the_times_that_the_station_has(stage: Stage) -> None:
    page, _ = stage.open(msgspec.structs.replace(scenes.quiet(), incident=None))
    dialog = menu(page, "Incidents")
    expect(dialog.get_by_label("Roll call every, min")).to_have_value("15")
    dialog.get_by_label("Name of the new incident").fill("Mill Lane")
    dialog.get_by_label("Rest after, min").fill("30")
    with page.expect_request(lambda request: request.method == "POST") as sent:
        dialog.get_by_role("button", name="Open incident").click()
    assert sent.value.post_data_json == {
        "name": "Mill Lane",
        "par_interval_s": 900,
        "work_limit_s": 1800,
    }


def test_times_that_are_no_whole_minutes_stay_as_they_are(stage: Stage) -> None:
    incident = msgspec.structs.replace(scenes.INCIDENT, par_interval_s=90.0)
    page, _ = stage.open(msgspec.structs.replace(scenes.quiet(), incident=incident))
    dialog = menu(page, "Incidents")
    dialog.get_by_label("Rest after, min").fill("30")
    with page.expect_request(lambda request: request.method == "PUT") as sent:
        dialog.get_by_role("button", name="Change times").click()
    assert sent.value.post_data_json == {"par_interval_s": 90, "work_limit_s": 1800}


def test_the_last_hour_is_the_station_s_whatever_the_browser_s_clock_says(stage: Stage) -> None:
    page, station = stage.open(msgspec.structs.replace(scenes.quiet(), incident=None))
    page.clock.set_fixed_time(datetime.fromtimestamp(scenes.NOW_MS / 1000, UTC) + timedelta(days=2))
    station.change()
    dialog = menu(page, "Units")
    with page.expect_request(re.compile("/recordings$")) as sent:
        dialog.get_by_role("button", name="Fetch the recording of FF-01").click()
    asked = sent.value.post_data_json
    assert asked is not None
    assert scenes.NOW_MS - asked["from_ms"] == pytest.approx(60 * scenes.MINUTE_MS, rel=0.1)


def test_a_plan_is_replaced_by_who_has_said_so(stage: Stage, tmp_path: Path) -> None:
    page, station = stage.open(scenes.bad_minute())
    site = menu(page, "Site")
    file = site.get_by_label("New plan")
    (tmp_path / "notes.json").write_text("notes")
    file.set_input_files(tmp_path / "notes.json")
    notice = site.get_by_role("alert").filter(has_text="This file is no GeoJSON")
    notice.get_by_role("button", name="OK").click()
    (tmp_path / "yard.json").write_text(
        '{"type": "FeatureCollection", "features": [],'
        ' "muster": {"frame": "site-m", "name": "Yard", "floors": [{"floor": 0, "down_m": 0}]}}'
    )
    file.set_input_files(tmp_path / "yard.json")
    expect(site).to_contain_text("The file has Yard: 1 floor, 0 rooms")
    site.get_by_role("button", name="Replace plan").click()
    site.get_by_role("button", name="No").click()
    station.expect_changes()
    assert flaws(page) == []
    confirm(site, "Replace plan")
    expect(site).to_have_count(0)
    station.expect_changes("/site/plan")


def test_a_phone_shows_the_list_or_the_plan(stage: Stage) -> None:
    page, _ = stage.open(scenes.bad_minute(), "phone")
    people, plan = page.get_by_role("region", name="People"), page.locator(".map")
    expect(people).to_be_visible()
    expect(plan).to_be_hidden()
    strip(page).get_by_role("button", name="Jonas Bergman may have fallen", exact=True).click()
    expect(plan).to_be_visible()
    expect(people).to_be_hidden()
    page.get_by_role("button", name="Menu").click()
    page.get_by_role("navigation").get_by_role("button", name="Units").click()
    expect(page.get_by_role("dialog")).to_be_visible()


def test_what_is_old_looks_old_when_the_station_is_gone(stage: Stage) -> None:
    page, station = stage.open(scenes.bad_minute())
    expect(page).to_have_title("(4!) Muster")
    station.fall_silent()
    banner = page.get_by_role("alert").filter(has_text="Connection to the station lost")
    expect(banner).to_contain_text("is not being updated")
    expect(page).to_have_title(re.compile("NO CONNECTION"))
    expect(page.locator(".card").first).to_contain_text("Not updated")
    assert flaws(page) == []
    assert barriers(page) == []


def test_a_picture_of_before_a_sleep_says_when_it_was(stage: Stage) -> None:
    """Whatever time has gone by unheard."""
    page, station = stage.open(scenes.quiet())
    page.clock.pause_at(datetime.now(UTC) + timedelta(seconds=1))
    station.change()
    station.hang()
    page.clock.fast_forward(30 * scenes.MINUTE_MS)
    page.wait_for_timeout(600)  # the page's own clock has gone on
    page.clock.run_for(3_000)
    banner = page.get_by_role("alert").filter(has_text="Connection to the station lost")
    heard = page.evaluate(f"new Date({scenes.NOW_MS}).toTimeString().slice(0, 8)")
    expect(banner).to_contain_text(f"This picture is from {heard} ")


def test_a_picture_of_before_a_sleep_is_old_at_once_when_the_machine_wakes(stage: Stage) -> None:
    """On many machines the steady clock stands in a sleep, and only the time of day goes on."""
    page, station = stage.open(scenes.quiet())
    station.change()
    station.hang()
    page.evaluate("const day = Date.now; Date.now = () => day() + 3_600_000")
    expect(page.locator(".card").first).to_contain_text("Not updated")
    expect(page.locator(".card").first).to_contain_text("1 h 00 min old")


def test_whose_login_has_ended_is_told_so(stage: Stage) -> None:
    page, station = stage.open(scenes.quiet())
    station.end_logins()
    expect(page.get_by_role("status")).to_contain_text("This login has ended")
    expect(page.get_by_role("button", name="Log in")).to_be_visible()
    expect(page).to_have_title("Muster")


def test_alarms_are_heard_unless_switched_off(stage: Stage) -> None:
    page, station = stage.open(scenes.quiet())
    page.evaluate(
        """() => {
          window.tones = 0;
          const silent = { frequency: {}, connect() {}, start() {}, stop() {} };
          window.AudioContext = class {
            state = "running";
            constructor() { window.tones += 1; }
            createOscillator() { return { ...silent }; }
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
def test_the_button_that_says_no_sound_yet_switches_it_on(stage: Stage, key: str | None) -> None:
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


def test_sound_that_the_browser_keeps_silent_is_not_said_to_be_on(stage: Stage) -> None:
    page, _ = stage.open(scenes.quiet())
    page.evaluate(
        """() => {
          const silent = { frequency: {}, connect() {}, start() {}, stop() {} };
          window.AudioContext = class {
            state = "suspended";
            createOscillator() { return { ...silent }; }
            close() {}
          };
        }"""
    )
    page.get_by_role("button", name="No sound yet").click()
    expect(page.get_by_role("button", name="Sound on")).to_be_visible()
    expect(page.get_by_role("button", name="No sound yet")).to_be_visible()


def test_a_photo_that_is_refused_adds_nobody_twice(stage: Stage, tmp_path: Path) -> None:
    """Who adds a person and is told that the photo is none may press again."""
    page, _ = stage.open(scenes.quiet())
    added = {**scenes.PEOPLE[0], "person_id": "new"}
    page.route(
        "**/api/v1/people",
        lambda route: (
            route.fulfill(json=added) if route.request.method == "POST" else route.fallback()
        ),
    )
    page.route(
        "**/photo", lambda route: route.fulfill(status=422, json={"detail": "This is no picture."})
    )
    (tmp_path / "notes.txt").write_text("notes")
    dialog = menu(page, "People")
    dialog.get_by_label("Name", exact=True).fill("Astrid Lindqvist")
    dialog.get_by_label("Photo", exact=True).set_input_files(tmp_path / "notes.txt")
    dialog.get_by_role("button", name="Add person").click()
    expect(dialog.get_by_role("alert").filter(has_text="no picture")).to_be_visible()
    expect(dialog.get_by_label("Name", exact=True)).to_have_value("")


def test_what_can_no_more_be_done_on_the_plan_takes_no_clicks(stage: Stage) -> None:
    page, station = stage.open(scenes.bad_minute())
    page.get_by_role("button", name="Pins 2").click()
    page.get_by_role("button", name="Astrid Lindqvist here").click()
    expect(page.locator(".map.placing")).to_have_count(1)
    station.change(pins=())  # somebody else has removed it
    expect(page.get_by_role("form")).to_have_count(0)
    expect(page.locator(".map.placing")).to_have_count(0)


def test_a_pin_that_is_looked_at_stays_on_its_floor(stage: Stage) -> None:
    """Whichever floor is shown, and where nobody is on its own."""
    pins = tuple(
        msgspec.structs.replace(scenes.pin(str(index), index, "used", 3.0, ""), floor=floor)
        for index, floor in enumerate((None, 4))
    )
    page, _ = stage.open(msgspec.structs.replace(scenes.quiet(), pins=pins))
    for name, floor in (("Astrid Lindqvist", ""), ("Jonas Bergman", "4")):
        page.get_by_role("button", name="Pins 2").click()
        page.get_by_role("button", name=f"{name} here").click()
        expect(page.get_by_role("combobox", name="Floor")).to_have_value(floor)


def begin_replay(page: Page) -> Locator:
    """Beside what is live."""
    menu(page, "Incidents").get_by_role("button", name=f"Replay {scenes.INCIDENT.name}").click()
    banner = page.get_by_role("region", name="Replay")
    expect(banner).to_contain_text("This is the past")
    return banner


def test_on_a_phone_what_is_live_leaves_a_replay_its_name(stage: Stage) -> None:
    page, _ = stage.open(scenes.bad_minute(), "phone")
    page.get_by_role("button", name="Menu").click()
    banner = begin_replay(page)
    expect(banner).to_contain_text("Live now: 4 open alarms")
    what = banner.get_by_text("This is the past.")
    expect(what).to_contain_text(scenes.INCIDENT.name)
    box = what.bounding_box()
    assert box is not None
    assert box["height"] < 50, "two lines, and no column of words"


def test_what_cannot_wait_is_said_over_a_replay_as_live_and_leads_there(stage: Stage) -> None:
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


def test_a_station_that_replays_says_no_alarm_of_the_past_as_one_that_cannot_wait(
    stage: Stage,
) -> None:
    page, _ = stage.open(scenes.past())
    expect(strip(page)).to_contain_text("Jonas Bergman may have fallen")
    expect(menu(page, "Account").get_by_role("button", name="may have fallen")).to_have_count(0)


def test_a_replay_does_not_say_that_the_station_is_well(stage: Stage) -> None:
    """What was measured of the machine is no part of the past; what is wrong now is said beside."""
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


def test_the_past_is_gone_through_from_alarm_to_alarm(stage: Stage) -> None:
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


def test_a_jump_in_the_past_begins_the_list_anew(stage: Stage) -> None:
    """Live, whoever gets better keeps the place for a while."""
    page, station = stage.open(scenes.past())
    expect(page.locator(".card").first).to_contain_text("Jonas Bergman")
    well = tuple(scenes.unit(index) for index in range(5))
    station.change(units=well, alarms=(), now_ms=scenes.NOW_MS - 20 * scenes.MINUTE_MS)
    jonas = page.locator(".card", has_text="Jonas Bergman")
    expect(jonas).to_have_class(re.compile("normal"), timeout=2000)
