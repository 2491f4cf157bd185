"""Names are removed from operators' entries, and inserted again for display."""

from __future__ import annotations

import pytest

from base_station.core.person_references import (
    FREE_TEXTS,
    reference_to,
    with_names,
    with_references,
    without_numbers,
    without_people,
)
from shared.messages import CommandKind
from shared.messages.pins import PlaceBeacon, SetMeeting, SetPin, StartTogether
from shared.messages.station import (
    Action,
    ImportFile,
    NoteDispatch,
    OpenIncident,
    RegisterUnit,
    ResolveAlarm,
    SendCommand,
    Unassign,
)

ROSTER = {"Ada": "p1", "Bo Lind": "p2", "Bo": "p3"}
NAMES = {person_id: name for name, person_id in ROSTER.items()}


@pytest.mark.parametrize(
    ("text", "recorded"),
    [
        ("Ada, out", "{person p1}, out"),
        ("ADA and bo lind's crew", "{person p1} and {person p2}'s crew"),
        ("Bo and Bo Lind", "{person p3} and {person p2}"),
        ("the Adapter", "the Adapter"),
        ("nobody", "nobody"),
    ],
)
def test_entered_name_becomes_a_reference_and_is_shown_as_the_name(
    text: str, recorded: str
) -> None:
    action = with_references(ResolveAlarm("a1", text), ROSTER)
    assert action == ResolveAlarm("a1", recorded)
    assert with_names(recorded, NAMES.__getitem__).lower() == text.lower()


EVERY_FREE_TEXT: tuple[Action, ...] = (
    OpenIncident("i1", "to Ada"),
    RegisterUnit("u1", "to Ada"),
    ResolveAlarm("a1", "to Ada"),
    SendCommand("c1", CommandKind.TEXT, "u1", "", False, "to Ada", 0.0, 60.0),
    SetPin("s1", "u1", 0, 0.0, 0.0, 1.0, None, None, 0.3, "to Ada"),
    StartTogether("s2", ("u1",), 0, 0.0, 0.0, 1.0, None, None, 0.3, "to Ada"),
    SetMeeting("s3", "u1", "u2", 0, 1.0, "to Ada"),
    PlaceBeacon("b1", "to Ada", 0.0, 0.0, None, 1.0, 1.0),
    NoteDispatch("2024-1", "json", remarks="to Ada"),
    ImportFile("i1", "f1", "to Ada", "gpx", "", 0, 0.0, 0, 0),
)


@pytest.mark.parametrize("action", EVERY_FREE_TEXT, ids=lambda one: type(one).__name__)
def test_every_free_text_field_is_recorded_without_names(action: Action) -> None:
    recorded = with_references(action, ROSTER)
    assert getattr(recorded, FREE_TEXTS[type(action)]) == "to {person p1}"


def test_action_without_free_text_is_recorded_unchanged() -> None:
    assert with_references(Unassign("Ada"), ROSTER) == Unassign("Ada")
    unnamed = ResolveAlarm("a1", "Ada")
    assert with_references(unnamed, {}) is unnamed
    assert {type(one) for one in EVERY_FREE_TEXT} == set(FREE_TEXTS)


def test_erased_people_leave_no_reference() -> None:
    text = f"{reference_to('p1')} met {reference_to('p2')}"
    assert without_people(text, {"p1"}, "#") == "# met {person p2}"


def test_texts_about_two_people_differ_in_more_than_an_amount() -> None:
    assert without_numbers("{person a1} for 5 s") == "{person a1} for  s"
    assert without_numbers("{person a1}") != without_numbers("{person a2}")
