"""Change of the fuser by a message of the log: people stay at their places, and a replay agrees."""

from __future__ import annotations

import math

import pytest

from base_station.core.alarms import ALARMS
from base_station.core.checkpoint import read_checkpoint
from base_station.core.pipeline import StationPipeline
from base_station.fusion import FUSERS
from shared.clock import NS_PER_S
from shared.messages.pins import SetPin
from shared.messages.station import SetFuser, SetStart
from tests.rig import message_factory
from tests.rig.station_script import START_NS, Script

UNIT = "FF-01"


def walk(script: Script, metres: int) -> None:
    """A metre a second to the north of the own frame."""
    for _ in range(metres):
        script.now_s += 1.0
        north_m = script.now_s
        position = message_factory.position(
            script.header(UNIT), north_m=north_m, east_m=0.0, distance_m=north_m
        )
        script.say(position)


@pytest.fixture
def script() -> Script:
    script = Script()
    script.register(UNIT)
    return script


def test_change_of_fuser_keeps_positions_and_is_logged(script: Script) -> None:
    walk(script, 1)
    script.act(SetStart(UNIT, 30.0, -10.0, -3.0, 1.0, 0.5, 0.05))
    walk(script, 60)
    before = script.fused[-1]
    script.act(SetFuser("gps-switching"))
    after = script.fused[-1]
    assert (before.fuser, after.fuser) == ("gps-inertial", "gps-switching")
    assert script.pipeline.state.fuser == "gps-switching"
    for name in ("north_m", "east_m", "down_m", "heading_rad"):
        assert getattr(after, name) == pytest.approx(getattr(before, name), abs=0.02)
    assert after.std_north_m == pytest.approx(before.std_north_m, rel=0.1)
    walk(script, 40)
    assert script.fused[-1].north_m - before.north_m == pytest.approx(40.0 * math.cos(1.0), abs=0.5)
    script.act(SetFuser("gps-inertial"))
    assert script.fused[-1].fuser == "gps-inertial"
    again = Script(StationPipeline(ALARMS, FUSERS[0]))
    for t_ns, key, payload in script.records:
        again.now_s = (t_ns - START_NS) / NS_PER_S
        again.record(key, payload)
    assert again.outputs == script.outputs


def test_checkpoint_continues_with_the_fuser_of_the_log(script: Script) -> None:
    walk(script, 1)
    script.act(SetStart(UNIT, 0.0, 0.0, 0.0, 1.0, 0.5, 0.05))
    script.act(SetFuser("gps-switching"))
    walk(script, 20)
    saved = read_checkpoint(script.pipeline.checkpoint())
    before = len(script.outputs)
    walk(script, 5)
    again = Script(StationPipeline(ALARMS, FUSERS[0], saved))
    for t_ns, key, payload in script.records[-5:]:
        again.now_s = (t_ns - START_NS) / NS_PER_S
        again.record(key, payload)
    assert again.outputs == script.outputs[before:]
    assert again.fused[-1].fuser == "gps-switching"


def test_unit_without_positions_and_one_with_a_pin_continue(script: Script) -> None:
    script.register("FF-02")
    walk(script, 1)
    assumed = script.fused[-1]
    script.act(SetFuser("gps-switching"))
    assert script.fused[-1].quality_reason == assumed.quality_reason != ""
    walk(script, 30)
    script.act(SetPin("p1", UNIT, script.t_ns, 50.0, 60.0, 1.0, None, None, 3.2, ""))
    pinned = script.fused[-1]
    assert (pinned.north_m, pinned.east_m) == pytest.approx((50.0, 60.0), abs=1.0)
    script.act(SetFuser("gps-inertial"))
    again = script.fused[-1]
    assert (again.north_m, again.east_m) == pytest.approx((50.0, 60.0), abs=1.0)


def test_unknown_fuser_changes_nothing(script: Script) -> None:
    walk(script, 3)
    script.act(SetFuser("of-a-later-version"))
    assert script.pipeline.state.fuser == ""
    walk(script, 1)
    assert script.fused[-1].fuser == "gps-inertial"
