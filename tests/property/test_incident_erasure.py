"""Erasure of one incident removes its people and leaves every other incident unchanged, whichever
incidents were open together and whoever was moved between them.
"""

from __future__ import annotations

from collections.abc import Iterable

from hypothesis import given, settings
from hypothesis import strategies as st

from base_station.core.erasure.erasure import CaptureClocks, Erasure, Record
from base_station.core.erasure.incident_scan import erasure_of_incident
from base_station.core.erasure.redaction import Redactor
from base_station.core.events import event_of
from base_station.core.state import StationState
from shared.channels import OPERATOR, POSITION
from shared.messages import STATION_ID
from shared.messages.station import (
    Action,
    Assign,
    AssignIncident,
    CloseIncident,
    OpenIncident,
    RegisterUnit,
    Unassign,
)
from tests.rig.station_script import Script, new_pipeline

UNITS = ("A", "B", "C")
PEOPLE = ("p1", "p2", "p3")
INCIDENTS = ("i1", "i2", "i3")
UNIT, PERSON = st.sampled_from(UNITS), st.sampled_from(PEOPLE)
INCIDENT = st.sampled_from(INCIDENTS)

DEEDS: st.SearchStrategy[Action | str] = st.one_of(
    st.builds(lambda i, b: OpenIncident(i, i, beside_others=b), INCIDENT, st.booleans()),
    st.builds(CloseIncident, INCIDENT),
    st.builds(
        lambda i, units: AssignIncident(i, tuple(units)),
        st.sampled_from(["", *INCIDENTS]),
        st.lists(UNIT, min_size=1, max_size=3, unique=True),
    ),
    st.builds(Assign, UNIT, PERSON),
    st.builds(Unassign, UNIT),
    st.builds(RegisterUnit, UNIT, UNIT),
    UNIT,  # the part that states its location
)

# By time: the incident, the wearer and the site of each unit, and when its duty began.
Picture = dict[str, tuple[str, str | None, str, int | None]]
OPENING: list[Action] = [
    *(RegisterUnit(one, one) for one in UNITS[:2]),
    *(Assign(unit_id, person_id) for unit_id, person_id in zip(UNITS[:2], PEOPLE[:2], strict=True)),
    OpenIncident("i1", "i1"),
    OpenIncident("i2", "i2", beside_others=True),
]


def picture_of(state: StationState) -> Picture:
    found = {}
    for unit in state.units.values():
        incident = state.open_incident_of(unit)
        duty = unit.duty
        found[unit.unit_id] = (
            "" if incident is None else incident.incident_id,
            unit.wearer.person_id,
            unit.site_id,
            None if duty is None else duty.since_ns,
        )
    return found


def pictures(records: Iterable[Record]) -> dict[int, Picture]:
    """State behind the last record of each time."""
    pipeline = new_pipeline()
    found = {}
    for record in records:
        pipeline.step(event_of(*record))
        found[record[0]] = picture_of(pipeline.state)
    return found


def filled(found: dict[int, Picture], times_ns: Iterable[int]) -> dict[int, Picture]:
    """Pictures, with the earlier one at times of which no record is left."""
    shown: Picture = {}
    return {t_ns: (shown := found.get(t_ns, shown)) for t_ns in times_ns}


def first_received(records: list[Record]) -> dict[str, int]:
    """First reception of each unit, as the service reads it from the log."""
    received: dict[str, int] = {}
    for t_ns, key, _ in records:
        for unit_id in UNITS:
            if key == POSITION.key(unit_id):
                received.setdefault(unit_id, t_ns)
    return received


def erasure_from(records: list[Record], incident_id: str) -> Erasure:
    actions = [one for one in records if one[1] == OPERATOR.key(STATION_ID)]
    return erasure_of_incident(actions, incident_id, first_received(records))


def erased(records: list[Record], erasure: Erasure) -> list[Record]:
    redactor = Redactor(erasure, CaptureClocks(), erasure.inserted_in(records))
    return [one for record in records for one in redactor(record)]


def without(incident_id: str, before: Picture) -> Picture:
    """The picture without wearers and members of the incident."""
    return {
        unit_id: (at, None, site_id, None) if at == incident_id else (at, person, site_id, since_ns)
        for unit_id, (at, person, site_id, since_ns) in before.items()
    }


@settings(max_examples=150, deadline=None)
@given(deeds=st.lists(DEEDS, max_size=30), order=st.permutations(INCIDENTS))
def test_erased_incident_leaves_no_person_and_other_incidents_stay(
    deeds: list[Action | str], order: list[str]
) -> None:
    script = Script()
    for deed in (*OPENING, *deeds, RegisterUnit("C", "C"), *map(CloseIncident, INCIDENTS)):
        script.now_s += 1.0
        if isinstance(deed, str):
            script.position(deed, script.now_s, 0.0)
        else:
            script.act(deed)
    left = script.records
    opened = {incident_id for picture in pictures(left).values() for incident_id in ids(picture)}
    for incident_id in order:
        if incident_id not in opened:
            continue
        before = pictures(left)
        erasure = erasure_from(left, incident_id)
        after_once = erased(left, erasure)
        expected = {t_ns: without(incident_id, picture) for t_ns, picture in before.items()}
        assert filled(pictures(after_once), expected) == expected
        assert erased(after_once, erasure) == after_once, "cut short, it is done again"
        again = erasure_from(after_once, incident_id)
        assert set(again.wearings) == set(erasure.wearings), "journals may bring more of it"
        assert erased(after_once, again) == after_once
        left = after_once


def ids(picture: Picture) -> set[str]:
    return {incident_id for incident_id, *_ in picture.values()} - {""}
