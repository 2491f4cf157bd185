"""Texts of units and of the station about them in German, from their codes."""

from __future__ import annotations

import re
from pathlib import Path

import msgspec
from playwright.sync_api import Page, expect

from base_station.storage.missing_segments import LogGap
from base_station.views import wire
from base_station.views.text_code import coded_views
from shared.coded_text import coded
from tests.e2e import scenes
from tests.e2e.stage import ANSWERS, PAST, Stage
from tests.rig.small_log import T0_NS

FAULT = wire.AlarmParametersView(
    member="Jonas Bergman",
    fault="battery BAT0: no reading: it was removed",
    fault_code="fault-of",
    fault_texts={
        "subject": "battery BAT0",
        "subject:": "device-battery",
        "subject:name": "BAT0",
        "fault": "no reading: it was removed",
        "fault:": "no-reading",
        "fault:reason": "it was removed",
        "fault:reason:": "device-removed",
    },
)
FOREIGN = wire.AlarmParametersView(member="Mira Okafor", fault="sensor kaputt")
DOUBT = wire.TrustView(
    "amber",
    "only known to 12 m",
    (wire.TextCodeView("doubt-place", {}, {"within_m": 12.0}),),
)


def in_german(page: Page) -> None:
    page.evaluate("localStorage.setItem('muster-language', 'de')")
    page.reload()
    page.get_by_role("heading", level=1).wait_for()


def test_faults_of_units_and_doubts_are_shown_in_german(stage: Stage, tmp_path: Path) -> None:
    shown = scenes.bad_minute()
    (fall,) = (one for one in shown.alarms if one.rule == "fall")
    (heat,) = (one for one in shown.alarms if one.rule == "heat")
    alarms = (
        msgspec.structs.replace(fall, code="unit-fault", parameters=FAULT),
        msgspec.structs.replace(heat, code="unit-fault", parameters=FOREIGN),
    )
    units = tuple(
        msgspec.structs.replace(one, trust=DOUBT) if one.unit_id == "FF-01" else one
        for one in shown.units
    )
    others = tuple(one for one in shown.alarms if one not in (fall, heat))
    page, _ = stage.open(msgspec.structs.replace(shown, units=units, alarms=(*alarms, *others)))
    in_german(page)
    fault = page.locator("[data-alarm^='fall']")
    expect(fault).to_contain_text("Akku BAT0: kein Messwert: es wurde entfernt")
    expect(page.locator("[data-alarm^='heat']")).to_contain_text("sensor kaputt")
    expect(page.get_by_text("nur auf 12\u00a0m bekannt").first).to_be_visible()
    page.screenshot(path=tmp_path / "faults_de.png")


def test_what_ended_an_alarm_is_shown_in_german(stage: Stage, tmp_path: Path) -> None:
    heat = scenes.bad_minute().alarms[2]
    life = scenes.life(heat, 3, reason="over-cooled", by="cooled down")
    page, _ = stage.open(scenes.bad_minute(), answers={**ANSWERS, f"{PAST}/alarms": [life]})
    in_german(page)
    page.keyboard.press("a")
    ended = page.get_by_role("dialog").locator(".alarm-life.resolved")
    expect(ended).to_contain_text("(abgekühlt)")
    page.screenshot(path=tmp_path / "ended_de.png")


def test_why_a_unit_refused_an_order_is_shown_in_german(stage: Stage, tmp_path: Path) -> None:
    order = scenes.order("c1", "evacuate", {"FF-01": "refused", "FF-02": "refused"})
    code = wire.TextCodeView("refused-expired", {}, {})
    ours = msgspec.structs.replace(
        order.units[0], reason="it had expired when it was sent", reason_code=code
    )
    foreign = msgspec.structs.replace(order.units[1], reason="kaputt")
    order = msgspec.structs.replace(order, units=(ours, foreign))
    page, _ = stage.open(msgspec.structs.replace(scenes.quiet(), commands=(order,)))
    in_german(page)
    page.get_by_role("group", name="Befehle").get_by_role("button", name="Räumung").click()
    dialog = page.get_by_role("dialog")
    expect(dialog).to_contain_text("beim Senden schon abgelaufen")
    expect(dialog).to_contain_text("kaputt")
    page.screenshot(path=tmp_path / "refused_de.png")


def test_defects_of_the_log_of_a_replay_are_shown_in_german(stage: Stage, tmp_path: Path) -> None:
    """With their reasons; one of an earlier version, which has no code, as it came."""
    unreadable = coded(
        "log-part-unreadable",
        "a part of the log cannot be read: {part}",
        part=coded(
            "segment-chunk-lost",
            "{file}: the chunk at byte {offset} is lost ({reason})",
            file="000002.mcap",
            offset=4096,
            reason=coded("chunk-checksum", "its checksum is wrong"),
        ),
    )
    defects = [LogGap(3, "", 0, T0_NS, is_file_missing=True).in_words(), unreadable, "as it came"]
    shown = scenes.past()
    assert shown.replay is not None
    replay = msgspec.structs.replace(
        shown.replay, flaws=tuple(map(str, defects)), flaw_codes=coded_views(defects)
    )
    page, _ = stage.open(msgspec.structs.replace(shown, replay=replay))
    in_german(page)
    page.locator("button.flaws").click()
    listed = page.get_by_role("dialog").get_by_role("listitem")
    expect(listed).to_have_count(3)
    expect(listed.nth(0)).to_contain_text(
        re.compile(r"Segment 3 fehlt: was bis zum 14\.11\.2023, \d\d:13 geschah, ist nicht")
    )
    expect(listed.nth(1)).to_have_text(
        "ein Teil des Logs ist nicht lesbar: 000002.mcap: der Block bei Byte 4.096 ist verloren "
        "(die Prüfsumme ist falsch)"
    )
    expect(listed.nth(2)).to_have_text("as it came")
    page.screenshot(path=tmp_path / "flaws_de.png")
