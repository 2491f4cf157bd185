"""The station's pipeline: any messages in any order raise no error, and a checkpoint changes no
result.
"""

from __future__ import annotations

import math
from collections.abc import Callable

from hypothesis import given, settings
from hypothesis import strategies as st

from base_station.core.alarms import ALARMS
from base_station.core.alarms.thresholds import limits_of
from base_station.core.checkpoint import read_checkpoint
from base_station.core.state.duty import ParConfirmation
from base_station.fusion import FUSERS
from shared.messages import (
    AlarmChange,
    AlarmState,
    CommandKind,
    CommandReply,
    CommandState,
    EventKind,
    OperatorAction,
)
from shared.messages.station import (
    AcknowledgeAlarm,
    Assign,
    CheckIn,
    CloseIncident,
    ConfirmCommand,
    DismissDispatch,
    ForgetWearers,
    NoteDispatch,
    OpenIncident,
    RegisterUnit,
    ReportProblem,
    ResolveAlarm,
    SendCommand,
    SetAccountability,
    SetAnchor,
    SetFuser,
    SetPlan,
    SetRest,
    SetStart,
    SetThresholds,
    Unassign,
    UndoConfirmation,
)
from shared.quality import Quality
from tests.rig import message_factory
from tests.rig.live_station import make_pipeline
from tests.rig.station_script import Script

UNITS = st.sampled_from(["FF-01", "FF-02", "stranger"])
METRES = st.floats(-1e4, 1e4)
ANY = st.floats(allow_nan=True, allow_infinity=True, width=32)
COMMAND_IDS = st.sampled_from(["c1", "c2", "c3"])
CHECK_IN_IDS = st.sampled_from(["k1", "k2"])
DISPATCHES = st.sampled_from(["d1", "d2"])
ANGLES = st.floats(0.0, 6.28)

THRESHOLDS = [f"{rule.name}.{name}" for rule in ALARMS for name in limits_of(rule)]

Deed = Callable[[Script], object]


def _resolve_some(script: Script) -> object:
    return [script.act(ResolveAlarm(alarm.alarm_id, "")) for alarm in script.alarms[-2:]]


DEEDS: st.SearchStrategy[Deed] = st.one_of(
    st.builds(lambda u, n, e: lambda s: s.position(u, n, e), UNITS, METRES, METRES),
    st.builds(
        lambda u, q: lambda s: s.position(u, 0.0, 0.0, quality=q),
        UNITS,
        st.sampled_from(list(Quality)),
    ),
    st.builds(
        lambda u, lat, lon, std: lambda s: s.gps(u, lat, lon, horizontal_std_m=std),
        UNITS,
        st.floats(-91.0, 91.0),
        st.floats(-181.0, 181.0),
        st.floats(0.0, 500.0),
    ),
    st.builds(
        lambda u, n, e: lambda s: s.gps(u, 52.0 + n * 1e-5, 4.0 + e * 1e-5),
        UNITS,
        st.floats(-20.0, 20.0),
        st.floats(-20.0, 20.0),
    ),
    st.builds(
        lambda u, m, b, p: lambda s: s.status(u, motionless_s=m, battery=b, mayday=p),
        UNITS,
        st.floats(0.0, 60.0),
        st.none() | st.floats(0.0, 1.0),
        st.booleans(),
    ),
    st.builds(lambda u, t: lambda s: s.temperature(u, t), UNITS, st.floats(-50.0, 900.0)),
    st.builds(
        lambda u, k, d: lambda s: s.event(u, k, d),
        UNITS,
        st.sampled_from(list(EventKind)),
        st.sampled_from(["", "stuck", "silent for 2 s", "silent for 3 s"]),
    ),
    st.builds(lambda d: lambda s: s.wait(d), st.integers(1, 40)),
    st.builds(
        lambda key, payload: lambda s: s.record(key, payload),
        st.sampled_from(
            ["muster/v1/FF-01/up/position", "muster/v1/FF-01/what", "", "muster/v1/station/tick"]
        ),
        st.binary(max_size=40),
    ),
    st.builds(lambda u: lambda s: s.act(RegisterUnit(u, u)), UNITS),
    st.builds(lambda u, p: lambda s: s.act(Assign(u, p, p, "", "")), UNITS, st.text(max_size=3)),
    st.builds(lambda u: lambda s: s.act(Unassign(u)), UNITS),
    st.builds(lambda i: lambda s: s.act(OpenIncident(i, i)), st.sampled_from(["a", "b"])),
    st.builds(lambda i: lambda s: s.act(CloseIncident(i)), st.sampled_from(["a", "b"])),
    st.builds(lambda a, b, c, d: lambda s: s.act(SetAnchor(a, b, c, d)), ANY, ANY, ANY, ANY),
    st.builds(
        lambda u, n, h, p, q: lambda s: s.act(SetStart(u, n, 0.0, 0.0, h, p, q)),
        UNITS,
        METRES,
        ANGLES,
        ANY,
        ANY,
    ),
    st.builds(lambda g: lambda s: s.act(SetPlan(g)), st.binary(max_size=20)),
    st.builds(lambda t: lambda s: s.act(ReportProblem("log", t)), st.sampled_from(["", "full"])),
    st.builds(lambda i: lambda s: s.act(AcknowledgeAlarm(i)), st.text(max_size=5)),
    st.just(_resolve_some),
    st.builds(
        lambda i, k, u, c, e, last: lambda s: s.act(SendCommand(i, k, u, c, e, "hi", 5.0, last)),
        COMMAND_IDS,
        st.sampled_from(list(CommandKind)),
        st.just("") | UNITS,
        st.sampled_from(["", "", "red"]),
        st.booleans(),
        st.just(20.0) | ANY,
    ),
    st.builds(lambda u, i: lambda s: s.command(u, i), UNITS, COMMAND_IDS),
    st.builds(
        lambda u, i, state: lambda s: s.reply(u, i, state),
        UNITS,
        COMMAND_IDS,
        st.sampled_from(list(CommandState)),
    ),
    st.builds(
        lambda u, o: lambda s: s.say(message_factory.description(s.header(u), outputs=o)),
        UNITS,
        st.sampled_from([(), ("led",)]),
    ),
    st.builds(lambda u, i: lambda s: s.act(ConfirmCommand(i, u)), UNITS, COMMAND_IDS),
    st.builds(
        lambda u, c, e, i: lambda s: s.act(CheckIn(u, c, e, i)),
        st.just("") | UNITS,
        st.sampled_from(["", "red"]),
        st.booleans(),
        st.just("") | CHECK_IN_IDS,
    ),
    st.builds(
        lambda i, u: lambda s: s.act(UndoConfirmation(i, u)),
        st.just("") | CHECK_IN_IDS | COMMAND_IDS,
        st.just("") | UNITS,
    ),
    st.builds(
        lambda n, u, t: lambda s: s.act(NoteDispatch(n, "json", units=u, updated_ns=t)),
        DISPATCHES,
        st.sampled_from([(), ("E12",)]),
        st.integers(0, 2),
    ),
    st.builds(lambda n: lambda s: s.act(DismissDispatch(n)), DISPATCHES),
    st.builds(lambda n: lambda s: s.act(OpenIncident(f"i{n}", n, 0.0, 0.0, n)), DISPATCHES),
    st.builds(lambda p, w: lambda s: s.act(SetAccountability(p, w)), st.just(30.0) | ANY, ANY),
    st.builds(
        lambda v: lambda s: s.act(SetThresholds(v)),
        st.dictionaries(st.sampled_from(THRESHOLDS) | st.text(max_size=5), ANY),
    ),
    st.builds(
        lambda n: lambda s: s.act(SetFuser(n)),
        st.sampled_from([kind.name for kind in FUSERS]) | st.just("none"),
    ),
    st.builds(lambda u, r: lambda s: s.act(SetRest(u, r)), UNITS, st.booleans()),
    st.builds(lambda u: lambda s: s.act(ForgetWearers(u)), UNITS),
)


def _restart(script: Script, unit_id: str) -> None:
    script.boot_ids[unit_id] = script.boot_ids.get(unit_id, 7) + 1


@settings(max_examples=60)
@given(st.lists(DEEDS, max_size=40), st.integers(0, 40))
def test_pipeline_never_fails_and_checkpoint_changes_nothing(deeds: list[Deed], cut: int) -> None:
    script = Script()
    script.register("FF-01", "FF-02")
    resumed: Script | None = None
    for number, deed in enumerate(deeds):
        if number == cut:
            saved = read_checkpoint(script.pipeline.checkpoint())
            assert saved is not None
            resumed = Script(make_pipeline(saved))
            begin = len(script.records), len(script.outputs)
        script.now_s += 0.3
        deed(script)
        if number % 13 == 12:
            _restart(script, "FF-01")
    if resumed is not None:
        for t_ns, key, payload in script.records[begin[0] :]:
            resumed.now_s = (t_ns - script.records[0][0]) / 1e9
            resumed.record(key, payload)
        assert resumed.outputs == script.outputs[begin[1] :]
    assert [alarm.text for alarm in script.alarms if alarm.level.startswith("rule-")] == []
    for fused in script.fused:
        assert all(map(math.isfinite, (fused.north_m, fused.east_m, fused.down_m)))
        assert fused.std_north_m >= 0.0


@settings(max_examples=60)
@given(st.lists(DEEDS, max_size=60))
def test_alarm_states_only_advance(deeds: list[Deed]) -> None:
    """Raised first, resolved last and finally; acknowledged and worse in between; of one subject
    one alarm is open.
    """
    script = Script()
    script.register("FF-01", "FF-02")
    for deed in deeds:
        script.now_s += 0.3
        deed(script)
        still_open = [one for one in script.pipeline.state.alarms.values() if one.is_open]
        matters = {(one.rule, one.unit_id, one.level, one.about) for one in still_open}
        assert len(matters) == len(still_open)
    lives: dict[str, list[AlarmChange]] = {}
    for change in script.alarms:
        lives.setdefault(change.alarm_id, []).append(change)
    for life in lives.values():
        assert life[0].state is AlarmState.RAISED
        assert all(change.state is not AlarmState.RESOLVED for change in life[:-1])
        assert len({change.raised_ns for change in life}) == 1
        assert all(change.priority in {1, 2, 3} and change.text for change in life)
    latched = {"mayday", "fall", "unit-fault", "tracker-fault"}
    for life in lives.values():
        if life[0].rule in latched and life[-1].state is AlarmState.RESOLVED:
            assert life[-1].by.startswith("chief")


@settings(max_examples=60)
@given(st.lists(DEEDS, max_size=60))
def test_only_wearer_or_commander_acknowledges_a_command(deeds: list[Deed]) -> None:
    script = Script()
    script.register("FF-01", "FF-02")
    for deed in deeds:
        script.now_s += 0.3
        deed(script)
    acknowledged = {
        (reply.header.unit_id, reply.command_id)
        for reply in script.published(CommandReply)
        if reply.state is CommandState.ACKNOWLEDGED
    }
    for command in script.pipeline.state.commands.values():
        for delivery in command.deliveries.values():
            if command.state_of(delivery) == "acknowledged":
                by_wearer = (delivery.unit_id, command.command_id) in acknowledged
                assert by_wearer or delivery.acknowledged_by == "chief"


@settings(max_examples=60)
@given(st.lists(DEEDS, max_size=60))
def test_only_a_person_completes_a_roll_call(deeds: list[Deed]) -> None:
    """Each action of no person leaves the check-in of all units unchanged."""
    script = Script()
    script.register("FF-01", "FF-02")
    script.act(Assign("FF-01", "p1", "Ana", "red", ""))
    script.act(OpenIncident("a", "a", 30.0, 60.0))
    for deed in deeds:
        script.now_s += 0.3
        before = vouched(script)
        replied = len(script.published(CommandReply))
        acted = len(script.published(OperatorAction))
        deed(script)
        by_button = any(
            reply.state is CommandState.ACKNOWLEDGED
            for reply in script.published(CommandReply)[replied:]
        )
        if len(script.published(OperatorAction)) == acted and not by_button:
            assert vouched(script) == before


def vouched(script: Script) -> dict[str, list[ParConfirmation]]:
    """Check-ins of each unit on duty."""
    return {
        unit.unit_id: list(unit.duty.confirmations)
        for unit in script.pipeline.state.units.values()
        if unit.duty is not None
    }
