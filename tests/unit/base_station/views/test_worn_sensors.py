"""Sensors of a unit and their places on the body, on the card and in the tables."""

from __future__ import annotations

from pathlib import Path

import pytest

from base_station.storage.db.known_people import person_lookup
from base_station.storage.db.projecting import project_into
from base_station.storage.db.roster import Roster
from base_station.storage.db.store import Store
from base_station.storage.projection import Projection
from base_station.views.stored_units import stored_sensors
from base_station.views.units import unit_views
from base_station.views.wire import WornSensorView
from shared.clock import SystemClock
from shared.messages import UnitSensor
from tests.rig import message_factory
from tests.rig.station_script import Script

U = "FF-01"
FOOT = UnitSensor("left", "left_foot", "x-IMU3", 400.0, None, None, False, False, mount="laces")
BACK = UnitSensor("back", "lower_back", "BMI270", 100.0, None, None, True, True, True)


@pytest.mark.parametrize(
    ("described", "shown"),
    [
        (
            (FOOT, BACK),
            (
                WornSensorView("left", "left_foot", False, "laces", "x-IMU3"),
                WornSensorView("back", "lower_back", True, "", "BMI270"),
            ),
        ),
        ((), (WornSensorView("", "", False, "", "sensor"),)),  # of an earlier version
    ],
)
def test_each_sensor_is_shown_where_it_is_worn(
    tmp_path: Path, described: tuple[UnitSensor, ...], shown: tuple[WornSensorView, ...]
) -> None:
    script = Script()
    script.register(U, "FF-02")
    description = message_factory.description(
        script.header(U), tracker="foot_and_trunk", sensors=described
    )
    script.say(description)
    state = script.pipeline.state
    card, silent = unit_views(state, state.units.values(), person_lookup({}))
    assert (card.tracker, card.sensors) == ("foot_and_trunk", shown)
    assert (silent.tracker, silent.sensors) == ("", ())
    with Store(tmp_path / "station.sqlite") as store:
        with store.write() as session:
            received = ((U, 1), ("FF-02", 1))
            project_into(
                session, [Projection(1, last_messages=received, descriptions=(description,))]
            )
        units = Roster(store, SystemClock()).units()
        stored = {unit.unit_id: stored_sensors(unit) for unit, _ in units}
    assert stored == {U: shown, "FF-02": ()}
