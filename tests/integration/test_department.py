"""Stations and their department over real Zenoh: access rules, receipts, and no event lost."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path

import pytest

from base_station.storage.projection import Projection
from shared.channels import (
    POSITION,
    Qos,
    clock_key,
    department_events_key,
    department_summary_key,
)
from shared.errors import ConfigError
from shared.messages import STATION_ID, AlarmChange, AlarmState, Header
from tests.rig.department_site import DepartmentSite
from tests.rig.tak_scene import T_MS, Scene
from tests.rig.waiting import until

QUIET_S = 1.0  # long enough for what is allowed to have come twice over


@pytest.fixture
def closing() -> Iterator[ExitStack]:
    with ExitStack() as stack:
        yield stack


def raised(number: int) -> Projection:
    t_ns = T_MS * 1_000_000 + number
    header = Header(STATION_ID, 1, 1, 0, t_ns, 0.0)
    alarm_id = f"fall|FF-01|{number}"
    state = AlarmState.RAISED
    change = AlarmChange(header, alarm_id, "fall", "FF-01", 1, state, "", "fell", "", t_ns, t_ns)
    return Projection(t_ns, alarms=(change,))


def test_station_reports_under_its_own_key_only_and_to_its_own_department(
    tmp_path: Path, closing: ExitStack
) -> None:
    department = DepartmentSite(tmp_path / "city", closing)
    engine_7, engine_8 = department.enrol("engine-7"), department.enrol("engine-8")
    department.open()
    received: list[str] = []
    department.bus.subscribe("muster/**", lambda key, _: received.append(key))
    asked: list[str] = []
    asked_of = department_events_key("engine-8")

    def answer(key: str, _: str, __: bytes) -> list[bytes]:
        asked.append(key)
        return [b"receipt"]

    department.bus.serve(asked_of, answer)
    bus, other = department.bus_of(engine_7), department.bus_of(engine_8)
    overheard: list[str] = []
    other.subscribe("muster/**", lambda key, _: overheard.append(key))
    own = department_summary_key("engine-7")

    def is_received() -> bool:
        bus.publish(own, b"mine", Qos.LIVE)
        return own in received

    until(is_received, "a summary of its own")
    until(other.is_linked, "the other station's link")
    deadline_s = time.monotonic() + QUIET_S
    while time.monotonic() < deadline_s:
        bus.publish(own, b"mine", Qos.LIVE)
        for key in (department_summary_key("engine-8"), POSITION.key("FF-01")):
            bus._session.put(key, b"forged")  # as somebody's own program may, undeclared
        time.sleep(0.05)
    assert list(bus.query(asked_of, b"", 0.5)) == []
    assert list(bus.query(clock_key("FF-01"), b"", 0.5)) == []
    assert set(received) == {own}
    assert (overheard, asked) == ([], [])

    stranger = DepartmentSite(tmp_path / "county", closing).enrol("engine-7")
    refused = department.bus_of(replace(stranger, connect=engine_7.connect))
    time.sleep(QUIET_S)
    assert not refused.is_linked()


def test_events_wait_for_the_department_and_arrive_once(tmp_path: Path, closing: ExitStack) -> None:
    department = DepartmentSite(tmp_path / "city", closing)
    enrolment = department.enrol("engine-7")
    forwarder = department.forwarder(enrolment, tmp_path / "station")
    forwarder.reset(Scene("FF-01").picture())
    forwarder.project(raised(1))
    forwarder.start()  # there is no department yet
    until(lambda: forwarder.view().state == "connecting" and forwarder.view().text, "the reason")
    department.open()
    until(lambda: department.tables.open_alarms(9)[1] == 1, "the alarm of before")
    until(lambda: "engine-7" in department.picture.all(), "a summary")
    for number in range(2, 6):
        department.close()
        forwarder.project(raised(number))
        department.open()
        until(lambda: forwarder.view().state == "connected", "the connection")
    until(lambda: department.tables.open_alarms(9)[1] == 5, "all alarms")
    forwarder.close()

    again = department.forwarder(enrolment, tmp_path / "station")  # the same events, after a kill
    again.reset(Scene("FF-01").picture())
    for number in range(1, 7):
        again.project(raised(number))
    again.start()
    until(lambda: department.tables.open_alarms(9)[1] == 6, "the alarm of after")
    ids = [one.event_id for one in department.tables.events(None, 100)]
    assert len(ids) == len(set(ids)) == 7  # and the incident
    assert department.tables.missing() == {}


def test_enrolment_of_a_unit_is_refused_for_a_station(tmp_path: Path, closing: ExitStack) -> None:
    department = DepartmentSite(tmp_path / "city", closing)
    with pytest.raises(ConfigError, match="enrols the unit FF-01, not a station"):
        department.forwarder(department.pki.enroll("FF-01"), tmp_path / "station")
