"""Orders at the console: each dialog shows its own, and those of a closed incident stay in it."""

from __future__ import annotations

import re
from pathlib import Path

import msgspec
import pytest
from playwright.sync_api import Page, expect

from base_station.views.wire import CommandView, Snapshot
from tests.e2e import scenes
from tests.e2e.console_page import barriers, command, menu, press
from tests.e2e.layout_checks import flaws
from tests.e2e.stage import ANSWERS, Stage

ACKNOWLEDGED = dict.fromkeys(("FF-01", "FF-02", "FF-03"), "acknowledged")


def with_orders(*orders: CommandView, shown: Snapshot | None = None) -> Snapshot:
    return msgspec.structs.replace(shown or scenes.quiet(), commands=orders)


def captions(page: Page, order: str) -> list[str]:
    """Captions of the orders in the dialog."""
    dialog = command(page, order)
    found = [text.partition(" (")[0] for text in dialog.locator("caption").all_inner_texts()]
    page.keyboard.press("Escape")
    expect(dialog).to_have_count(0)
    return found


def test_evacuate_dialog_lists_no_answers_to_other_orders(stage: Stage) -> None:
    """They would be taken for this one's, also those of an evacuation that is over."""
    par = scenes.order("c1", "par_request", ACKNOWLEDGED, is_open=False)
    over = scenes.order(
        "c2", "evacuate", ACKNOWLEDGED, is_open=False, ended_ms=scenes.NOW_MS - 1000
    )
    page, _ = stage.open(with_orders(par, over))
    assert captions(page, "Evacuate") == []
    assert captions(page, "PAR") == ["PAR"]
    assert sorted(captions(page, "Message")) == ["Evacuate", "PAR"]  # all of the incident


def test_units_without_answer_are_first_in_an_evacuation(stage: Stage) -> None:
    states = {
        "FF-01": "acknowledged",
        "FF-02": "received",
        "FF-03": "acknowledged",
        "FF-04": "queued",
    }
    page, station = stage.open(with_orders(scenes.order("c1", "evacuate", states)))
    dialog = command(page, "Evacuate")
    expect(dialog.locator("caption")).to_contain_text("2 of 4 acknowledged")
    names = dialog.get_by_role("rowheader")
    expect(names).to_have_text(["Jonas Bergman", "Tomas Novak", "Astrid Lindqvist", "Mira Okafor"])
    expect(dialog.get_by_role("row", name="Jonas Bergman")).to_contain_text("delivered")
    assert flaws(page) == []
    assert barriers(page) == []
    done = scenes.order("c1", "evacuate", states | {"FF-02": "acknowledged"})
    answered = dialog.get_by_role("button", name="Confirm by radio: Jonas Bergman")
    press(answered)
    station.change(commands=(done,))
    expect(names.first).to_have_text("Tomas Novak")
    station.expect_changes("/commands/c1/confirm")


def test_acknowledged_evacuation_stays_until_the_all_clear(stage: Stage) -> None:
    sent = scenes.order("c1", "evacuate", {"FF-01": "queued"})
    answers = {**ANSWERS, "POST /commands": msgspec.to_builtins(sent)}
    page, station = stage.open(scenes.quiet(), answers=answers)
    dialog = command(page, "Evacuate")
    dialog.get_by_role("button", name="Evacuate now").click()
    station.expect_changes("/commands")
    done = scenes.order("c1", "evacuate", {"FF-01": "acknowledged"}, is_open=False)
    station.change(commands=(done,))
    expect(dialog.locator("caption")).to_contain_text("1 of 1 acknowledged")
    expect(page.locator(".command-bar")).to_contain_text("1 of 1 acknowledged")
    ended = msgspec.structs.replace(done, ended_ms=scenes.NOW_MS)
    clear = scenes.order("ac", "all_clear", {"FF-01": "notified"})
    station.change(commands=(ended, clear))
    expect(dialog.locator("caption")).to_contain_text(re.compile("All clear .*0 of 1 acknowledged"))


@pytest.mark.parametrize("order", ["Evacuate", "PAR", "Message"])
def test_orders_of_a_closed_incident_are_not_shown(stage: Stage, order: str) -> None:
    of_last = [
        scenes.order(kind, kind, ACKNOWLEDGED, is_open=False, incident_id="the last one")
        for kind in ("evacuate", "par_request", "text")
    ]
    page, _ = stage.open(with_orders(*of_last))
    assert captions(page, order) == []


def test_locate_signal_is_shown_until_it_is_stopped(stage: Stage) -> None:
    received = scenes.order("c1", "locate", {"FF-01": "received"})
    answers = {**ANSWERS, "POST /commands": msgspec.to_builtins(received)}
    page, station = stage.open(with_orders(), answers=answers)
    card = page.locator(".card", has_text="Astrid Lindqvist")
    card.get_by_role("button", name="Astrid Lindqvist").click()
    locate = card.get_by_role("button", name="Sound locator")
    expect(locate).to_have_attribute("title", re.compile("such as a sounder or a light"))
    locate.click()
    station.expect_changes("/commands")
    station.change(commands=(received,))
    expect(card.locator(".card-commands")).to_have_text("Locatedelivered")
    station.change(commands=(scenes.order("c1", "locate", {"FF-01": "notified"}),))
    expect(card.locator(".card-commands")).to_contain_text("signals since")
    assert barriers(page) == []
    card.get_by_role("button", name="Stop sound locator").click()
    station.expect_changes("/commands", "/commands/c1/stop")
    notified = scenes.order("c1", "locate", {"FF-01": "notified"}, is_open=False)
    ended = msgspec.structs.replace(notified, ended_ms=scenes.NOW_MS)
    station.change(commands=(ended,))
    expect(card.locator(".card-commands")).to_contain_text("stopping")
    expect(locate).to_be_visible()


def test_signal_of_a_unit_is_no_answer_of_its_wearer(stage: Stage) -> None:
    page, _ = stage.open(with_orders(scenes.order("c1", "evacuate", {"FF-01": "notified"})))
    card = page.locator(".card", has_text="Astrid Lindqvist")
    expect(card.locator(".card-commands")).to_contain_text("signalled by the unit")
    dialog = command(page, "Evacuate")
    expect(dialog.locator("caption")).to_contain_text("0 of 1 acknowledged")
    row = dialog.get_by_role("row", name="Astrid Lindqvist")
    expect(row).to_contain_text("signalled by the unit")
    expect(row.get_by_role("button", name="Confirm by radio")).to_be_visible()


@pytest.mark.parametrize("order", ["Evacuate", "PAR", "Message"])
def test_order_names_the_members_reachable_by_radio_only(stage: Stage, order: str) -> None:
    page, _ = stage.open(scenes.without_outputs())
    dialog = command(page, order)
    reported = dialog.locator(".not-notifiable")
    expect(reported).to_have_text(
        "2 of 5 cannot be notified: use the voice radio: Astrid Lindqvist, Mira Okafor"
    )
    assert flaws(page) == []
    assert barriers(page) == []
    dialog.get_by_label("To").select_option(label="Rescue 3")
    expect(reported).to_have_text("1 of 1 cannot be notified: use the voice radio: Mira Okafor")
    dialog.get_by_label("To").select_option(label="Jonas Bergman")
    expect(reported).to_have_text("")


def test_many_members_reachable_by_radio_only_are_folded(stage: Stage, tmp_path: Path) -> None:
    shown = scenes.some_down(40, 1)
    units = tuple(
        msgspec.structs.replace(one, can_be_notified=place < 2)
        for place, one in enumerate(shown.units)
    )
    page, _ = stage.open(msgspec.structs.replace(shown, units=units))
    dialog = command(page, "Evacuate")
    summary = dialog.get_by_text("38 of 40 cannot be notified: use the voice radio", exact=True)
    name = dialog.locator(".not-notifiable").get_by_text("Jonas Bergman")
    expect(summary).to_be_visible()
    expect(name).to_be_hidden()
    page.screenshot(path=tmp_path / "folded.png")
    summary.click()
    expect(name).to_be_visible()
    page.screenshot(path=tmp_path / "unfolded.png")
    assert flaws(page) == []
    assert barriers(page) == []


def test_card_shows_one_state_of_the_par(stage: Stage, tmp_path: Path) -> None:
    """That of its mark, not also that of the delivery of a request, which may be an earlier one."""
    par = scenes.order("c1", "par_request", ACKNOWLEDGED)
    evacuation = scenes.order("c2", "evacuate", ACKNOWLEDGED)
    page, _ = stage.open(with_orders(par, evacuation, shown=scenes.par_requested()))
    card = page.locator(".card", has_text="Astrid Lindqvist")
    expect(card).to_contain_text("PAR requested")
    expect(card.locator(".card-commands")).to_have_text("Evacuateacknowledged")
    page.screenshot(path=tmp_path / "par.png")


def test_card_shows_a_wearer_who_cannot_be_notified(stage: Stage) -> None:
    """Before anything is sent, and a locate order says so before it goes."""
    page, station = stage.open(scenes.without_outputs())
    shown = page.locator(".card", has_text="cannot be notified").locator(".name")
    expect(shown).to_have_text(["Astrid Lindqvist", "Mira Okafor"])
    card = page.locator(".card", has_text="Astrid Lindqvist")
    card.get_by_role("button", name="Astrid Lindqvist").click()
    card.get_by_role("button", name="Sound locator").click()
    dialog = page.get_by_role("dialog", name="Locate")
    expect(dialog.locator(".not-notifiable")).to_have_text(
        "1 of 1 cannot be notified: use the voice radio: Astrid Lindqvist"
    )
    station.expect_changes()


def test_wearer_without_notifier_is_unreached_until_the_answer_by_radio(stage: Stage) -> None:
    states = {"FF-01": "received", "FF-02": "notified", "FF-03": "sent"}
    cannot = {"FF-01", "FF-03"}
    shown = with_orders(
        scenes.order("c1", "evacuate", states, without_output=cannot),
        shown=scenes.without_outputs(),
    )
    page, station = stage.open(shown)
    card = page.locator(".card", has_text="Astrid Lindqvist")
    expect(card.locator(".card-commands")).to_have_text("Evacuatecannot be notified")
    dialog = command(page, "Evacuate")
    expect(dialog.locator("caption")).to_contain_text("0 of 3 acknowledged, 2 cannot be notified")
    names = dialog.get_by_role("rowheader")
    expect(names).to_have_text(["Astrid Lindqvist", "Mira Okafor", "Jonas Bergman"])
    row = dialog.get_by_role("row", name="Astrid Lindqvist")
    expect(row).to_contain_text("cannot be notified")
    assert flaws(page) == []
    assert barriers(page) == []
    press(row.get_by_role("button", name="Confirm by radio: Astrid Lindqvist"))
    station.expect_changes("/commands/c1/confirm")
    answered = states | {"FF-01": "acknowledged"}
    station.change(commands=(scenes.order("c1", "evacuate", answered, without_output=cannot),))
    expect(dialog.locator("caption")).to_contain_text("1 of 3 acknowledged, 1 cannot be notified")
    expect(row).not_to_contain_text("cannot be notified")


def test_closing_an_incident_names_members_inside(stage: Stage) -> None:
    page, station = stage.open(scenes.bad_minute())
    dialog = menu(page, "Incidents")
    dialog.get_by_role("button", name="Close this incident").click()
    question = dialog.get_by_role("group").filter(has_text="It cannot be opened again.")
    expect(question).to_contain_text("Open alarms: Jonas Bergman (Fall, No motion); Mira Okafor")
    expect(question).to_contain_text("Inside: Astrid Lindqvist; Jonas Bergman; Mira Okafor;")
    assert flaws(page) == []
    assert barriers(page) == []
    station.expect_changes()
    page.wait_for_timeout(600)
    with page.expect_request(lambda request: request.url.endswith("/close")) as closed:
        question.get_by_role("button", name="Yes, close this incident").click()
    sent = closed.value.post_data_json
    assert sent is not None
    assert sorted(sent["despite_alarm_ids"]) == [
        "fall:FF-02", "heat:FF-03", "link-lost:FF-04", "no-motion:FF-02"
    ]  # fmt: skip
    assert sent["despite_unit_ids"][:2] == ["FF-01", "FF-02"]


def test_closing_a_finished_incident_asks_the_usual_question(stage: Stage) -> None:
    shown = scenes.quiet()
    out = tuple(msgspec.structs.replace(one, inside_since_ms=None) for one in shown.units)
    page, _ = stage.open(msgspec.structs.replace(shown, units=out))
    dialog = menu(page, "Incidents")
    dialog.get_by_role("button", name="Close this incident").click()
    expect(
        dialog.get_by_role("group", name="It cannot be opened again.", exact=True)
    ).to_be_visible()


@pytest.mark.parametrize("screen", ["laptop", "large", "tablet", "phone"])
def test_orders_under_way_move_no_button(stage: Stage, screen: str) -> None:
    """Four at a time are usual: an evacuation, a PAR, a sound locator and a message."""
    picture = scenes.quiet()
    page, station = stage.open(picture, screen)
    bar = page.get_by_role("group", name="Commands")

    def tops() -> list[float]:
        boxes = [one.bounding_box() for one in bar.get_by_role("button").all()[:3]]
        return [box["y"] for box in boxes if box is not None]

    before = tops()
    states = {one.unit_id: "received" for one in picture.units}
    orders = tuple(
        scenes.order(kind, kind, states) for kind in ("par_request", "locate", "text", "evacuate")
    )
    for count in (1, 2, 3, 4):
        station.change(commands=orders[-count:])
        expect(bar).to_contain_text("Evacuate 0 of")
        assert tops() == before, count
        assert flaws(page) == []
    expect(bar.get_by_role("listitem")).to_have_count(2)
    bar.get_by_role("button", name="3 more orders").click()
    expect(page.get_by_role("dialog").locator(".order")).to_have_count(4)
