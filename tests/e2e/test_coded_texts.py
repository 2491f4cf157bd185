"""Texts of units and of the station about them in German, from their codes."""

from __future__ import annotations

from pathlib import Path

import msgspec
from playwright.sync_api import Page, expect

from base_station.views import wire
from tests.e2e import scenes
from tests.e2e.stage import ANSWERS, PAST, Stage

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
