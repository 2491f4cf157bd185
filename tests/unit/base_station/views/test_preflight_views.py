"""Findings of a unit's start check, as the console shows them."""

from __future__ import annotations

import pytest

from base_station.storage.db.known_people import person_lookup
from base_station.views.units import unit_views
from base_station.views.wire import PreflightView
from shared.messages import PreflightFinding, PreflightLevel
from tests.rig import message_factory
from tests.rig.station_script import Script

U = "FF-01"
WEAK = PreflightFinding(PreflightLevel.WARNING, "temperature", "the unit has no sensor", "no alarm")
BROKEN = PreflightFinding(PreflightLevel.FAILED, "disk", "0.0 GB free", "make room")
OF_LATER_VERSION = PreflightFinding(PreflightLevel.UNKNOWN, "radio", "weak")


@pytest.mark.parametrize(
    ("found", "shown"),
    [
        (None, None),
        ((), PreflightView("ok", "")),
        ((WEAK,), PreflightView("warning", "temperature: the unit has no sensor")),
        ((OF_LATER_VERSION,), PreflightView("warning", "radio: weak")),
        (
            (BROKEN, WEAK),
            PreflightView("failed", "disk: 0.0 GB free; temperature: the unit has no sensor"),
        ),
    ],
)
def test_findings_are_one_text(
    found: tuple[PreflightFinding, ...] | None, shown: PreflightView | None
) -> None:
    script = Script()
    script.register(U)
    script.say(message_factory.description(script.header(U), preflight=found))
    state = script.pipeline.state
    (card,) = unit_views(state, state.units.values(), person_lookup({}))
    assert card.preflight == shown


def test_unit_without_description_has_no_findings() -> None:
    script = Script()
    script.register(U)
    state = script.pipeline.state
    (card,) = unit_views(state, state.units.values(), person_lookup({}))
    assert card.preflight is None
