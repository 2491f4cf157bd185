"""Alarms leave the station as a code and parameters, with people's names in them."""

from __future__ import annotations

import msgspec

from base_station.storage.db.known_people import KnownPerson
from base_station.storage.db.models import AlarmRow
from base_station.views.recorded import named_alarm, reference_person
from base_station.views.station import alarm_view
from base_station.views.wire import AlarmParametersView, AlarmView
from shared.channels import ALARM
from shared.codec import decode, encode
from shared.messages import AlarmChange, AlarmParameters, AlarmState, Header
from shared.messages.muster.v1 import alarm_pb2

CHANGE = AlarmChange(
    Header("station", 1, 1, 0, t_utc_ns=5_000_000), "no-motion:FF-01:5", "no-motion", "FF-01", 1,
    AlarmState.RAISED, "alarm", "{person ana}: no motion, 30 s", "", 5_000_000, 5_000_000,
    code="no-motion", parameters=AlarmParameters(member="{person ana}", duration_s=30.0),
)  # fmt: skip


def people(person_id: str) -> KnownPerson:
    return KnownPerson(person_id.title())


def logged(payload: bytes) -> AlarmView:
    change = decode(ALARM, payload)
    assert isinstance(change, AlarmChange)
    return alarm_view(change, people)


def test_names_are_inserted_live_stored_and_recorded() -> None:
    shown = AlarmParametersView(member="Ana", duration_s=30.0)
    live = logged(encode(CHANGE))
    assert (live.code, live.parameters) == ("no-motion", shown)
    row = AlarmRow(
        alarm_id="no-motion:FF-01:5", rule="no-motion", unit_id="FF-01", priority=1, state="raised",
        level="alarm", text=CHANGE.text, by="", raised_ns=5, last_raised_ns=5, changed_ns=5,
        code="no-motion", parameters=msgspec.json.encode(CHANGE.parameters).decode(),
        reason="", note="",
    )  # fmt: skip
    stored = alarm_view(row, people)
    assert (stored.code, stored.parameters) == ("no-motion", shown)
    recorded = msgspec.json.encode(alarm_view(CHANGE, reference_person))
    played = named_alarm(msgspec.json.decode(recorded, type=AlarmView), people)
    assert played == live


def test_only_parameters_of_the_sentence_are_sent() -> None:
    sent = msgspec.json.decode(msgspec.json.encode(alarm_view(CHANGE, people)))
    assert sent["parameters"] == {"member": "Ana", "duration_s": 30.0}


def test_alarms_of_earlier_versions_have_their_sentence_alone() -> None:
    wire = alarm_pb2.AlarmChange.FromString(encode(CHANGE))
    for field in ("code", "parameters"):
        wire.ClearField(field)
    earlier = logged(wire.SerializeToString())
    assert (earlier.code, earlier.parameters) == ("", AlarmParametersView())
    assert earlier.text == "Ana: no motion, 30 s"
    sent = msgspec.json.decode(msgspec.json.encode(earlier))
    recorded = {name: value for name, value in sent.items() if name not in ("code", "parameters")}
    assert msgspec.convert(recorded, AlarmView) == earlier
