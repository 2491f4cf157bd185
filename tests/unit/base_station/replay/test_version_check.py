"""Distinction of a log whose station decided otherwise from one of the same program."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cache
from pathlib import Path

import msgspec
import pytest

from base_station.core.erasure.erasure import CaptureClocks, erasure_of_person
from base_station.core.erasure.incident_scan import erasure_of_incident
from base_station.core.erasure.redaction import Redactor
from base_station.core.events import Received, event_of
from base_station.replay.playback import Archive, Decision, Playback, Record
from base_station.replay.version_check import VersionCheck, decisions_differ
from base_station.storage.checkpoints import Checkpoints
from shared.channels import OPERATOR
from shared.messages import (
    STATION_ID,
    AlarmChange,
    EventKind,
    FusedPosition,
    OperatorAction,
)
from shared.messages.station import Assign, CloseIncident, OpenIncident, SetStart, Unassign
from tests.rig.live_station import make_pipeline
from tests.rig.logged_walk import Change, logged, north, walk_with_mayday
from tests.rig.station_script import Script


def named(decision: Decision) -> Decision:
    if isinstance(decision, AlarmChange):
        return msgspec.structs.replace(decision, alarm_id="another")
    return decision


def test_decisions_of_the_same_program_are_shown_again() -> None:
    assert any(key.endswith("fused") for _, key, _ in logged())
    assert not decisions_differ(logged(), make_pipeline())
    assert not decisions_differ(walk_with_mayday(), make_pipeline()), "nothing was decided"
    assert not decisions_differ(logged(north(0.01)), make_pipeline()), "nobody sees that"


@pytest.mark.parametrize("change", [north(2.0), named])
def test_decisions_of_another_program_are_not(change: Change) -> None:
    assert decisions_differ(logged(change), make_pipeline())


def test_log_from_its_middle_does_not_identify_the_program() -> None:
    """Its first places come from fusers with more evidence."""
    whole = list(logged())
    for begin in (len(whole) // 3, len(whole) // 2):
        assert not decisions_differ(whole[begin:], make_pipeline())
        assert not decisions_differ([*whole[:10], *whole[begin:]], make_pipeline())


@cache
def two_incidents() -> tuple[Record, ...]:
    """In each incident a wearer walks and presses the button; the start is set in the first one."""
    script = Script()
    script.register("FF-01")
    for incident_id, person in (("i1", "Ada"), ("i2", "Bea")):
        script.act(Assign("FF-01", person, person, "red", "leader"))
        script.act(OpenIncident(incident_id, "Mill Lane"))
        if incident_id == "i1":
            script.act(SetStart("FF-01", 5.0, 5.0, 0.0, 1.0, 0.5, 0.05))
        for second in range(40):
            script.now_s += 1.0
            script.position("FF-01", 1.0 * second, 0.0)
            if second == 20:
                script.event("FF-01", EventKind.MAYDAY)
            script.tick()
        script.act(CloseIncident(incident_id))
        script.act(Unassign("FF-01"))
    return tuple(script.records)


@pytest.mark.parametrize("incident", [False, True])
def test_erased_records_do_not_identify_the_program(incident: bool) -> None:
    whole = list(logged(records=two_incidents()))
    assert not decisions_differ(whole, make_pipeline())
    assert not decisions_differ(redacted(whole, incident=incident), make_pipeline())


def checked(records: Iterable[Record], folder: Path, from_incident: str) -> list[bool]:
    """Result for each record from the begin of an incident."""
    whole = list(records)
    archive = Archive(
        lambda from_ns: (one for one in whole if one[0] >= from_ns),
        Checkpoints(folder),
        make_pipeline,
    )
    playback = Playback(archive)
    for _ in playback.seek(opened_ns(whole, from_incident)):
        pass
    check = VersionCheck(playback, whole[-1][0])
    return list(iter(check.check_next_record, None))


def opened_ns(records: Iterable[Record], incident_id: str) -> int:
    return next(
        event.t_ns
        for event in (event_of(*one) for one in records)
        if isinstance(event, Received)
        and isinstance(event.message, OperatorAction)
        and isinstance(event.message.action, OpenIncident)
        and event.message.action.incident_id == incident_id
    )


def test_incident_of_another_version_behind_others_is_reported(
    tmp_path: Path,
) -> None:
    """The log's beginning is of this one."""
    second_ns = opened_ns(two_incidents(), "i2")
    mixed = [
        of_this if of_this[0] < second_ns else of_other
        for of_this, of_other in zip(
            logged(records=two_incidents()),
            logged(moved, records=two_incidents()),
            strict=True,
        )
    ]
    assert any(checked(mixed, tmp_path, "i2"))
    same = checked(logged(records=two_incidents()), tmp_path, "i2")
    assert not any(same)
    assert len(same) > 40
    assert any(checked(logged(moved, records=two_incidents()), tmp_path, "i1"))


def moved(decision: Decision) -> Decision:
    if isinstance(decision, FusedPosition):
        return msgspec.structs.replace(decision, north_m=decision.north_m + 2.0)
    return decision


@pytest.mark.parametrize("incident", [False, True])
def test_incident_behind_erased_records_is_not_reported(incident: bool, tmp_path: Path) -> None:
    whole = list(logged(records=two_incidents()))
    assert not any(checked(redacted(whole, incident=incident), tmp_path, "i2"))


def redacted(whole: list[Record], *, incident: bool) -> list[Record]:
    actions = [one for one in whole if one[1] == OPERATOR.key(STATION_ID)]
    if incident:
        erasure = erasure_of_incident(actions, "i1")
    else:
        erasure = erasure_of_person(actions, "Ada", ["Ada"], whole[-1][0])
    redact = Redactor(erasure, clocks_of(whole))
    return [one for record in whole for one in redact(record)]


def clocks_of(records: list[Record]) -> CaptureClocks:
    clocks = CaptureClocks()
    for event in (event_of(*one) for one in records):
        if isinstance(event, Received):
            clocks.note(event.t_ns, event.message.header)
    return clocks
