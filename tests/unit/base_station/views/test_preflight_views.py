"""Findings of a unit's start check, as the console shows them."""

from __future__ import annotations

import pytest

from base_station.storage.db.known_people import person_lookup
from base_station.views.units import unit_views
from base_station.views.wire import PreflightView
from shared.coded_text import Term, coded
from shared.messages import PreflightFinding, PreflightLevel
from tests.rig import message_factory
from tests.rig.station_script import Script

U = "FF-01"
WEAK = PreflightFinding(PreflightLevel.WARNING, "temperature", "the unit has no sensor", "no alarm")
BROKEN = PreflightFinding(PreflightLevel.FAILED, "disk", "0.0 GB free", "make room")
OF_LATER_VERSION = PreflightFinding(PreflightLevel.UNKNOWN, "radio", "weak")
_TEMPERATURE = "temperature: the unit has no sensor"


def preflight_of(found: tuple[PreflightFinding, ...] | None) -> PreflightView | None:
    """View of a unit whose description has come over the wire with these findings."""
    script = Script()
    script.register(U)
    script.say(message_factory.description(script.header(U), preflight=found))
    state = script.pipeline.state
    (card,) = unit_views(state, state.units.values(), person_lookup({}))
    return card.preflight


@pytest.mark.parametrize(
    ("found", "shown"),
    [
        ((), ("ok", "", ())),
        ((WEAK,), ("warning", "temperature: the unit has no sensor", (_TEMPERATURE,))),
        ((OF_LATER_VERSION,), ("warning", "radio: weak", ("radio: weak",))),
        (
            (BROKEN, WEAK),
            (
                "failed",
                "disk: 0.0 GB free; temperature: the unit has no sensor",
                ("disk: 0.0 GB free", _TEMPERATURE),
            ),
        ),
    ],
)
def test_findings_are_shown_each_and_in_one_text(
    found: tuple[PreflightFinding, ...], shown: tuple[str, str, tuple[str, ...]]
) -> None:
    view = preflight_of(found)
    assert view is not None
    assert (view.level, view.text, view.findings) == shown
    assert len(view.finding_codes) == len(found)


def test_unit_that_has_not_checked_itself_shows_nothing() -> None:
    assert preflight_of(None) is None


def test_codes_of_subject_and_text_come_to_the_console() -> None:
    subject, text = (
        coded("check-subject", "{subject}", subject=Term("battery", "battery")),
        coded("check-battery", "{level_fraction:.0%} of {of}", level_fraction=0.4, of="BAT0"),
    )
    view = preflight_of((PreflightFinding.of(PreflightLevel.WARNING, subject, text, ""),))
    assert view is not None
    (code,) = view.finding_codes
    assert view.text == "battery: 40% of BAT0"
    assert code.code == "check-finding"
    assert code.texts["subject:"] == "check-subject"
    assert code.texts["subject:subject"] == "battery"
    assert (code.texts["text:"], code.texts["text:of"]) == ("check-battery", "BAT0")
    assert code.numbers["text:level_fraction"] == pytest.approx(0.4)


def test_unit_without_description_has_no_findings() -> None:
    script = Script()
    script.register(U)
    state = script.pipeline.state
    (card,) = unit_views(state, state.units.values(), person_lookup({}))
    assert card.preflight is None
