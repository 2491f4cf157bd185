"""Wearers of units over time, from the log: of one person, and of all people of one incident."""

from __future__ import annotations

import msgspec
import pytest

from base_station.core.erasure.erasure import (
    CaptureClocks,
    Erasure,
    Record,
    Wearing,
    erasure_of_person,
    inserted_action_id,
    is_inserted,
    raised_of,
)
from base_station.core.erasure.incident_scan import erasure_of_incident
from base_station.core.erasure.redaction import Redactor
from shared.channels import OPERATOR
from shared.codec import encode
from shared.errors import UserError
from shared.messages import STATION_ID, Header, OperatorAction
from shared.messages.station import (
    Action,
    Assign,
    CloseIncident,
    OpenIncident,
    Unassign,
)

NOW_NS = 1000
OPEN, CLOSE = OpenIncident("i1", "Mill Lane"), CloseIncident("i1")


def done(*actions: tuple[int, Action]) -> list[Record]:
    """The actions at these times; each has its time as its id."""
    return [
        (
            t_ns,
            OPERATOR.key(STATION_ID),
            encode(OperatorAction(Header(STATION_ID, 1, t_ns, 0), f"a{t_ns}", "chief", action)),
        )
        for t_ns, action in actions
    ]


def erasure_of(records: list[Record]) -> Erasure:
    """Erasure of a log whose beginning, with the registrations, is lost."""
    return erasure_of_incident(records, "i1", is_whole=False)


def ana(unit_id: str, name: str = "Ana") -> Assign:
    return Assign(unit_id, "p1", name, "", "")


def worn(assign: Assign) -> Assign:
    """The assignment as it remains behind the end of an erased incident."""
    return msgspec.structs.replace(assign, keeps_incident=True)


def bo(unit_id: str) -> Assign:
    return Assign(unit_id, "p2", "Bo Lind", "", "")


@pytest.mark.parametrize(
    ("actions", "wearings"),
    [
        ([(10, ana("A")), (20, Unassign("A"))], [("A", 10, 20)]),
        ([(10, ana("A")), (20, Unassign("B"))], [("A", 10, NOW_NS)]),
        ([(10, ana("A")), (20, bo("A"))], [("A", 10, 20)]),
        ([(10, ana("A")), (20, bo("B"))], [("A", 10, NOW_NS)]),
        ([(10, ana("A")), (20, ana("B"))], [("A", 10, 20), ("B", 20, NOW_NS)]),
        ([(10, ana("A")), (20, ana("A")), (30, Unassign("A"))], [("A", 10, 30)]),
        ([(10, bo("A")), (20, ana("A")), (30, bo("A")), (40, ana("A"))],
         [("A", 20, 30), ("A", 40, NOW_NS)]),
        ([(10, bo("A")), (20, Unassign("A"))], []),
    ],
)  # fmt: skip
def test_person_wears_a_unit_until_its_return_or_hand_over(
    actions: list[tuple[int, Action]], wearings: list[tuple[str, int, int]]
) -> None:
    erasure = erasure_of_person(done(*actions), "p1", (), NOW_NS)
    assert erasure.wearings == tuple(Wearing(*one) for one in wearings)


def test_every_name_of_a_person_is_known_the_longest_first() -> None:
    actions = done((10, ana("A")), (20, ana("A", " ")), (30, ana("A", "Ana Kovač")), (40, bo("A")))
    actions.insert(1, (15, OPERATOR.key(STATION_ID), b"\xffa newer program's"))
    assert erasure_of_person(actions, "p1", ["Anka"], NOW_NS).names == ("Ana Kovač", "Anka", "Ana")


def test_moment_of_return_belongs_to_the_next_wearer() -> None:
    erasure = erasure_of_person(done((10, ana("A")), (20, Unassign("A"))), "p1", (), NOW_NS)
    assert [erasure.covers("A", t_ns) for t_ns in (9, 10, 19, 20)] == [False, True, True, False]
    assert not erasure.covers("B", 15)


def test_every_wearer_in_an_incident_belongs_to_it() -> None:
    records = done(
        (5, bo("C")), (6, Unassign("C")),  # before
        (10, ana("A")),
        (20, OPEN), (30, bo("B")), (35, ana("D")), (36, Unassign("B")), (40, CLOSE),
        (50, bo("E")),
    )  # fmt: skip
    erasure = erasure_of(records)
    assert erasure.wearings == tuple(Wearing(one, 20, 40) for one in "ABD")
    assert erasure.names == ("Bo Lind", "Ana")
    assert (erasure.from_ns, erasure.until_ns) == (20, 40)
    assert [one.unit_id for one in erasure.hand_backs] == ["A", "B", "D"]
    again = [one.assign for one in erasure.reassignments]
    assert again == [worn(ana("D"))], "who changes for another unit wears one"
    assert not erasure.covers("A", 40)


def test_alarms_of_its_units_after_an_incident_belong_to_it_until_the_next_one() -> None:
    """Late messages of a unit, and notes of the people who handle them."""
    records = done(
        (5, OpenIncident("i0", "")), (6, CloseIncident("i0")),
        (10, ana("A")), (20, OPEN), (40, CLOSE), (50, OpenIncident("i2", "")),
    )  # fmt: skip
    erasure = erasure_of(records)
    raised_ns = (19, 20, 39, 40, 49, 50)
    about = [erasure.is_about("A", one) for one in raised_ns]
    assert about == [False, True, True, True, True, False]
    about = [erasure.is_about("B", one) for one in raised_ns]
    assert about == [False, True, True, False, False, False]
    assert raised_of("fall:A:45") == ("A", 45)
    assert raised_of("of another program") is None
    last = erasure_of(records[:-1])
    assert last.is_about("A", 10**18)


def test_log_of_an_erased_incident_keeps_its_units() -> None:
    """Their journals may bring more of it."""
    records = done(
        (5, bo("C")), (6, Unassign("C")),  # before
        (10, ana("A")), (20, OPEN), (30, bo("B")), (36, Unassign("B")), (40, CLOSE),
    )  # fmt: skip
    erasure = erasure_of(records)
    forgotten = redacted(records, erasure)
    again = erasure_of(forgotten)
    assert again.wearings == erasure.wearings == (Wearing("A", 20, 40), Wearing("B", 20, 40))
    assert redacted(forgotten, again) == forgotten


def redacted(records: list[Record], erasure: Erasure) -> list[Record]:
    redactor = Redactor(erasure, CaptureClocks(), erasure.inserted_in(records))
    return [one for record in records for one in redactor(record)]


def test_wearer_before_an_incident_belongs_to_another() -> None:
    records = done(
        (1, OpenIncident("i0", "")), (2, bo("B")), (3, CloseIncident("i0")), (4, Unassign("B")),
        (10, ana("A")), (20, OPEN), (40, CLOSE),
    )  # fmt: skip
    erasure = erasure_of(records)
    assert (sorted(erasure.unit_ids), erasure.names) == (["A"], ("Ana",))


@pytest.mark.parametrize(
    ("actions", "reported"),
    [
        ([(20, OPEN)], "open"),
        ([], "knows no incident"),
        ([(10, OpenIncident("i0", "")), (20, CloseIncident("i0"))], "knows no incident"),
    ],
)
def test_open_or_unknown_incident_is_not_erased(
    actions: list[tuple[int, Action]], reported: str
) -> None:
    with pytest.raises(UserError, match=reported):
        erasure_of_incident(done(*actions), "i1")


def test_inserted_part_of_the_log_is_not_inserted_again() -> None:
    records = done((10, ana("A")), (11, bo("B")), (20, OPEN), (40, CLOSE))
    erasure = erasure_of(records)
    assert erasure.inserted_in(records) == set()
    header = Header(STATION_ID, 1, 1, 0)
    there = [
        (t_ns, OPERATOR.key(STATION_ID), encode(OperatorAction(header, name, "chief", action)))
        for t_ns, name, action in (
            (20, inserted_action_id("a20", "A"), Unassign("A")),
            (40, inserted_action_id("a40", "B"), worn(bo("B"))),
            (41, inserted_action_id("a201", "A"), Unassign("A")),
        )
    ]
    assert erasure.inserted_in(there) == {"a20-A", "a40-B"}
    forgotten = redacted(records, erasure)
    assert redacted(forgotten, erasure) == forgotten


def test_radio_during_overlapping_incidents_is_erased_with_the_last() -> None:
    records = done(
        (10, OPEN), (20, OpenIncident("i2", "", beside_others=True)),
        (30, OpenIncident("i3", "", beside_others=True)), (40, CloseIncident("i2")),
        (50, CloseIncident("i3")), (60, CLOSE), (70, OpenIncident("i4", "")),
    )  # fmt: skip
    erasure = erasure_of(records)
    assert erasure.times_alone(()) == [(10, 20), (50, 60)]
    assert erasure.times_alone({"i2"}) == [(10, 30), (50, 60)]
    assert erasure.times_alone({"i2", "i3"}) == [(10, 60)]
    inside = erasure_of_incident(records, "i2", is_whole=False)
    assert inside.times_alone(()) == []
    assert inside.times_alone({"i1", "i3"}) == [(20, 40)]


def test_action_of_a_person_is_no_inserted_one_whatever_the_units_name() -> None:
    own = f"{1:016x}-7"
    for action_id, action, inserted in (
        (own, Unassign("7"), False),
        (inserted_action_id(own, "7"), Unassign("7"), True),
        (inserted_action_id(own, "7"), ana("7"), True),
        (inserted_action_id(own, "7"), CLOSE, False),
        (inserted_action_id(own, "8"), Unassign("7"), False),
    ):
        done_by = OperatorAction(Header(STATION_ID, 1, 1, 0), action_id, "chief", action)
        assert is_inserted(done_by) is inserted


@pytest.mark.parametrize("sender", ["A", "A@tracker"])
def test_message_is_placed_by_the_least_delayed_one_before_it(sender: str) -> None:
    clocks = CaptureClocks()
    late = Header(sender, 7, 1, 10)
    assert clocks.captured_ns(900, late) is None
    for t_ns, delay_ns, captured_ns in ((50, 9, 119), (300, 12, 119), (301, 3, 113)):
        clocks.note(t_ns, Header(sender, 7, t_ns, t_ns - delay_ns - 100))
        assert clocks.captured_ns(900, late) == captured_ns
    assert clocks.captured_ns(105, late) == 105, "it was captured before it was logged"


def test_run_of_which_nothing_came_live_is_placed_by_the_unit_itself() -> None:
    clocks = CaptureClocks()
    clocks.note(50, Header("A", 7, 1, 10))
    assert clocks.captured_ns(900, Header("A", 8, 1, 10, 70, 0.1)) == 70
    assert clocks.captured_ns(900, Header("A", 8, 1, 10, 70, 0.0)) is None


def test_message_of_an_unknown_time_may_be_of_a_wearer_before_it_and_of_none_behind() -> None:
    erasure = erasure_of_person(done((10, ana("A")), (20, Unassign("A"))), "p1", (), NOW_NS)
    assert [erasure.may_cover("A", t_ns) for t_ns in (9, 10, 99)] == [False, True, True]
    assert not erasure.may_cover("B", 99)
