"""Actions about places: coordinates that are no place are refused with a reason."""

from __future__ import annotations

import math

import pytest

from base_station.core.events import Refused
from base_station.core.place_actions import pins_changed
from base_station.core.state import OWN_SITE_ID
from shared.messages.station import Action, SetAnchor, SetReference, SetStart
from tests.rig.station_script import Script


@pytest.fixture
def script() -> Script:
    """A station with one registered unit."""
    script = Script()
    script.register("FF-01")
    return script


def refusal(script: Script, action: Action) -> str:
    """Return the reason of the refusal; empty: the action was carried out."""
    return "".join(one.reason for one in script.act(action) if isinstance(one, Refused))


@pytest.mark.parametrize(
    ("std_m", "heading_std_rad", "reason"),
    [
        (-1.0, 0.1, "not negative"),
        (1.0, -0.1, "not negative"),
        (math.nan, 0.1, "no finite number"),
        (1.0, math.inf, "no finite number"),
        (1.0, 0.1, ""),
    ],
)
def test_start_needs_possible_uncertainties(
    script: Script, std_m: float, heading_std_rad: float, reason: str
) -> None:
    start = SetStart("FF-01", 0.0, 0.0, 0.0, 0.0, std_m, heading_std_rad)
    refused = refusal(script, start)
    assert reason in refused
    assert bool(refused) == bool(reason)


@pytest.mark.parametrize(("lat_deg", "lon_deg"), [(90.5, 0.0), (0.0, 180.5), (math.nan, 0.0)])
def test_anchor_beside_the_earth_is_refused(script: Script, lat_deg: float, lon_deg: float) -> None:
    assert refusal(script, SetAnchor(lat_deg, lon_deg, 0.0, 0.0))
    assert script.pipeline.state.sites[OWN_SITE_ID].anchor is None
    assert not refusal(script, SetAnchor(90.0, 180.0, 0.0, 0.0))


def test_reference_height_that_is_no_number_is_refused(script: Script) -> None:
    assert "no finite number" in refusal(script, SetReference("FF-01", math.nan))
    assert not refusal(script, SetReference("FF-01", 2.0))


def test_changed_pins_are_reported_in_order_of_the_units() -> None:
    assert pins_changed({"FF-02", "FF-01"}).unit_ids == ("FF-01", "FF-02")
