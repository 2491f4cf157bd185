"""Durations of the trust light of each unit, with its reasons, while an incident is open."""

from __future__ import annotations

import pytest

from base_station.core.trust.trust import trust_of
from shared.coded_text import code_of_text
from shared.messages import EventKind
from shared.messages.station import Assign, CloseIncident, OpenIncident
from tests.rig.station_script import Script


@pytest.fixture
def script() -> Script:
    script = Script()
    script.register("FF-01", "FF-02")
    script.act(OpenIncident("i1", "Mill Lane"))
    return script


def send_messages(script: Script) -> None:
    script.status("FF-01")
    script.position("FF-01", script.now_s, 0.0)


def test_silence_changes_the_light_and_is_its_reason(script: Script) -> None:
    """Amber about the unit's own start, red once it is lost."""
    script.wait(20.0, lambda: send_messages(script))
    script.wait(60.0)
    tally = script.pipeline.state.units["FF-01"].trust
    assert tally.green_s == 0.0
    assert tally.red_s == pytest.approx(31.0, abs=2.0)
    assert tally.green_s + tally.amber_s + tally.red_s == pytest.approx(79.0, abs=2.0)
    assert tally.causes["no message"] > 31.0
    assert sum(tally.causes.values()) == pytest.approx(tally.amber_s + tally.red_s)


def test_unit_without_wearer_and_contact_has_no_light(script: Script) -> None:
    script.wait(30.0)
    assert script.pipeline.state.units["FF-02"].trust.red_s == 0.0


def test_wearer_of_a_unit_without_any_contact_is_red(script: Script) -> None:
    script.act(Assign("FF-02", "p2", "Bo", "", ""))
    script.wait(30.0)
    tally = script.pipeline.state.units["FF-02"].trust
    assert tally.causes == {"no position yet": pytest.approx(30.0, abs=1.0)}
    assert tally.red_s == pytest.approx(30.0, abs=1.0)


def test_unit_switched_off_in_order_has_no_light_until_it_is_on_again(
    script: Script,
) -> None:
    script.wait(20.0, lambda: send_messages(script))
    script.event("FF-01", EventKind.STOPPED)
    tally = script.pipeline.state.units["FF-01"].trust
    before_s = tally.green_s + tally.amber_s + tally.red_s
    script.wait(60.0)
    assert tally.green_s + tally.amber_s + tally.red_s == before_s
    assert "no message" not in tally.causes
    script.wait(10.0, lambda: send_messages(script))
    script.wait(60.0)
    assert tally.causes["no message"] > 31.0


def test_time_counts_only_while_an_incident_is_open_and_from_its_beginning(script: Script) -> None:
    script.wait(20.0, lambda: send_messages(script))
    script.act(CloseIncident("i1"))
    before_s = script.pipeline.state.units["FF-01"].trust.amber_s
    script.wait(20.0, lambda: send_messages(script))
    assert script.pipeline.state.units["FF-01"].trust.amber_s == before_s
    script.act(OpenIncident("i2", "Elm Street"))
    assert script.pipeline.state.units["FF-01"].trust.amber_s == 0.0


@pytest.mark.parametrize(("away_s", "seen_s"), [(5.0, 5.0), (6.0, 0.0), (3600.0, 0.0)])
def test_time_without_the_station_has_no_light(
    script: Script, away_s: float, seen_s: float
) -> None:
    script.wait(10.0, lambda: send_messages(script))
    before = script.pipeline.state.units["FF-01"].trust.amber_s
    script.now_s += away_s
    script.tick()
    tally = script.pipeline.state.units["FF-01"].trust
    assert tally.amber_s + tally.red_s == before + seen_s


def test_reason_of_the_light_has_its_code(script: Script) -> None:
    unit = script.pipeline.state.units["FF-01"]
    assert code_of_text(trust_of(unit, 0).reason).code == "doubt-no-position"
    script.wait(20.0, lambda: send_messages(script))
    trust = trust_of(unit, 0)
    assert trust.reason == "start not known: shown about the unit's own start"
    assert code_of_text(trust.reason).code == "doubt-start"
