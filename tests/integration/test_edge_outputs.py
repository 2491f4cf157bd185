"""Orders of a station as they reach the wearer, from the console to a voice or a line."""

from __future__ import annotations

import time
import wave
from collections.abc import Callable, Iterator
from contextlib import closing
from pathlib import Path
from shutil import which
from typing import Any

import pytest

from deploy.demo.panel_button import PanelButton
from tests.rig.shown_unit import ShownUnit
from tests.rig.station_command import Agent, Browser, Command
from tests.rig.waiting import until

FF_01 = "u1"
_SHORT_PRESS_S = 0.1
_LONGER_S = 5.0  # than the pattern of an order takes


@pytest.fixture
def browser(serve: Callable[..., Command], data: Path) -> Iterator[Browser]:
    with Browser(serve().wait_ready(), data) as browser:
        browser.call("POST", "/units", json={"unit_id": FF_01, "label": FF_01})
        yield browser


@pytest.fixture
def shown(browser: Browser) -> Iterator[ShownUnit]:
    with closing(ShownUnit(browser, FF_01)) as shown:
        until(lambda: shown.card, "the unit's card")
        yield shown


@pytest.fixture
def panel_path(tmp_path: Path) -> Path:
    return tmp_path / "button"


@pytest.fixture
def panel(panel_path: Path) -> Iterator[PanelButton]:
    button = PanelButton(panel_path)
    yield button
    button.unplug()


@pytest.fixture
def started(
    port: int, tmp_path: Path, panel_path: Path, panel: PanelButton
) -> Iterator[Callable[..., Agent]]:
    agents: list[Agent] = []

    def started(*outputs: str, source: str = "bench:5") -> Agent:
        flags = [flag for text in outputs for flag in ("--output", text)]
        where = ("--data", str(tmp_path / "edge"), "--connect", f"tcp/127.0.0.1:{port}")
        flags += ["--button", f"socket:{panel_path}"]
        output = tmp_path / f"agent-{len(agents)}.txt"
        agents.append(Agent(output, "--unit", FF_01, "--source", source, *where, *flags))
        return agents[-1]

    yield started
    for agent in agents:
        agent.kill()
        print(agent.output())  # shown beside a failure


def order(browser: Browser, kind: str, **fields: Any) -> str:
    answer = browser.call(
        "POST", "/commands", json={"kind": kind, "target": {"unit_id": FF_01}, **fields}
    )
    command_id: str = answer["command_id"]
    return command_id


def delivery(browser: Browser, command_id: str) -> dict[str, Any]:
    commands = browser.call("GET", "/commands")
    (found,) = (one for one in commands if one["command_id"] == command_id)
    (unit,) = found["units"]
    return dict(unit)


def test_order_notifies_the_wearer_and_is_repeated_after_a_restart(browser, shown, started) -> None:
    agent = started("terminal:FF-01")
    until(lambda: "linked to the station" in agent.output(), "the link")
    command_id = order(browser, "evacuate")
    until(
        lambda: "FF-01: [evacuate] Evacuate. Leave the building now." in agent.output(), "the order"
    )
    until(lambda: delivery(browser, command_id)["state"] == "notified", "that it was played")
    text_id = order(browser, "text", text="stairs are gone")
    until(lambda: "FF-01: [message] Message: stairs are gone" in agent.output(), "the message")
    until(lambda: delivery(browser, text_id)["state"] == "notified", "that it was played, too")
    agent.kill()
    again = started("terminal:FF-01")
    until(lambda: "[evacuate]" in again.output(), "the order after a restart")
    until(lambda: "stairs are gone" in again.output(), "the message after a restart")
    assert again.stop() == 0


def test_order_ends_with_an_answer_by_radio_and_with_the_all_clear(
    browser, shown, started, panel: PanelButton
) -> None:
    agent = started("terminal:FF-01")
    until(lambda: "linked to the station" in agent.output(), "the link")
    command_id = order(browser, "evacuate")
    until(lambda: delivery(browser, command_id)["state"] == "notified", "that it was played")
    browser.call("POST", f"/commands/{command_id}/confirm", json={"unit_id": FF_01})
    until(lambda: "END_ORDER" in agent.output(), "the end of the order")
    ended = agent.output().count("[evacuate]")
    time.sleep(_LONGER_S)
    assert agent.output().count("[evacuate]") <= ended + 1, "one may have begun"
    browser.call("POST", f"/commands/{command_id}/confirm/undo", json={"unit_id": FF_01})
    until(lambda: agent.output().count("[evacuate]") > ended + 1, "the order again")
    until(lambda: delivery(browser, command_id)["state"] == "notified", "that it was played again")
    browser.call("POST", f"/commands/{command_id}/repeat", json={})
    until(lambda: delivery(browser, command_id)["state"] == "notified", "that it was sent again")
    locate_id = order(browser, "locate")
    until(lambda: delivery(browser, locate_id)["signal"] == "light", "the signal of the place")
    browser.call("POST", f"/commands/{locate_id}/stop", json={})
    until(lambda: delivery(browser, locate_id)["ended_ms"], "that the unit has stopped it")
    clear_id = browser.call("POST", f"/commands/{command_id}/all-clear", json={})["command_id"]
    until(
        lambda: "[all clear] All clear. The evacuation is over." in agent.output(), "the all clear"
    )
    cleared = agent.output().count("[evacuate]")
    assert delivery(browser, command_id)["state"] == "expired"

    def is_acknowledged() -> bool:
        panel.press()
        time.sleep(_SHORT_PRESS_S)
        panel.release()
        return bool(delivery(browser, clear_id)["state"] == "acknowledged")

    until(is_acknowledged, "the answer to the all clear")
    assert agent.output().count("[evacuate]") == cleared
    assert agent.stop() == 0


def test_a_mayday_that_is_acknowledged_in_an_outage_is_played_once_after_it(
    browser, shown, started, panel: PanelButton
) -> None:
    agent = started("terminal:FF-01", source="simulated:loses-radio")
    until(lambda: "linked to the station" in agent.output(), "the link")
    panel.press()
    until(lambda: "[mayday called]" in agent.output(), "the mayday in the unit")
    panel.release()
    until(lambda: any("Mayday" in text for text in shown.alarms.values()), "the alarm")
    (alarm,) = browser.call("GET", "/alarms")
    until(lambda: "radio down" in agent.output(), "the outage")
    seen = {"last_raised_ms": alarm["last_raised_ms"]}
    browser.call("POST", f"/alarms/{alarm['alarm_id']}/acknowledge", json=seen)
    (command,) = browser.call("GET", "/commands")
    assert (command["kind"], command["units"][0]["state"]) == ("mayday_acknowledged", "queued")
    evacuation_id = order(browser, "evacuate")
    clear = browser.call("POST", f"/commands/{evacuation_id}/all-clear", json={})
    until(lambda: "radio back" in agent.output(), "the end of the outage")
    until(
        lambda: delivery(browser, command["command_id"])["state"] == "notified",
        "that the wearer was notified",
    )
    assert agent.output().count("FF-01: [mayday acknowledged]") == 1
    until(
        lambda: "[all clear]" in agent.output(), "the all clear, of what the unit had not received"
    )
    until(lambda: delivery(browser, clear["command_id"])["received_ms"], "that the unit has it")
    assert "[evacuate]" not in agent.output()
    assert delivery(browser, evacuation_id)["sent_ms"] is None
    assert agent.stop() == 0


def test_a_wearer_who_fell_is_notified_of_the_acknowledgement(browser, shown, started) -> None:
    agent = started("terminal:FF-01", source="simulated:goes-down")
    until(lambda: any("possible fall" in text for text in shown.alarms.values()), "the alarm")
    alarm = next(one for one in browser.call("GET", "/alarms") if one["rule"] == "fall")
    seen = {"last_raised_ms": alarm["last_raised_ms"]}
    browser.call("POST", f"/alarms/{alarm['alarm_id']}/acknowledge", json=seen)
    (command,) = browser.call("GET", "/commands")
    assert command["kind"] == "alarm_acknowledged"
    until(
        lambda: delivery(browser, command["command_id"])["state"] == "notified",
        "that the wearer was notified",
    )
    assert "[alarm acknowledged] The commander knows of your alarm." in agent.output()
    why = {**seen, "reason": "found_and_helped", "note": "at the stairs"}
    browser.call("POST", f"/alarms/{alarm['alarm_id']}/resolve", json=why)
    resolved = browser.call("GET", f"/alarms/{alarm['alarm_id']}")
    assert [one["state"] for one in resolved["changes"]] == ["raised", "acknowledged", "resolved"]
    assert (resolved["reason"], resolved["note"]) == ("found_and_helped", "at the stairs")
    until(lambda: any("no motion" in text for text in shown.alarms.values()), "no motion")
    (still,) = (one for one in browser.call("GET", "/alarms") if one["rule"] == "no-motion")
    assert still["peak"] >= 20.0, "seconds without motion, from the pre-alert on"
    assert agent.stop() == 0


@pytest.mark.skipif(
    which("espeak-ng") is None or which("aplay") is None,
    reason="no espeak-ng or no aplay on this machine: install espeak-ng and alsa-utils",
)
def test_a_message_is_spoken_on_the_sound_card(
    browser, shown, started, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    card, sound = tmp_path / "asound.conf", tmp_path / "spoken.wav"
    card.write_text(
        "pcm.quiet { type null }\n"
        f'pcm.default {{ type file slave.pcm "quiet" file "{sound}" format "wav" }}\n'
    )
    monkeypatch.setenv("ALSA_CONFIG_PATH", str(card))
    agent = started("speech:en")
    until(lambda: "linked to the station" in agent.output(), "the link")
    command_id = order(browser, "text", text="come out by the window")
    until(lambda: delivery(browser, command_id)["state"] == "notified", "that it was spoken")
    with wave.open(str(sound)) as spoken:
        assert spoken.getnframes() > spoken.getframerate()  # more than a second
    assert agent.stop() == 0


@pytest.mark.skipif(which("espeak-ng") is None, reason="no espeak-ng on this machine")
def test_missing_sound_card_is_an_alarm_and_notifies_no_wearer(
    browser, shown, started, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "asound.conf").write_text("")
    monkeypatch.setenv("ALSA_CONFIG_PATH", str(tmp_path / "asound.conf"))
    agent = started("speech:en")
    until(lambda: "linked to the station" in agent.output(), "the link")
    command_id = order(browser, "text", text="come out by the window")
    until(lambda: "output speech:en" in str(shown.alarms), "the alarm of the broken output")
    assert delivery(browser, command_id)["state"] == "received"
    assert agent.stop() == 0
