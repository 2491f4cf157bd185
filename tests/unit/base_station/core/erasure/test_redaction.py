"""Names are removed from texts; names of others, and the program's own words, stay."""

from __future__ import annotations

import msgspec
import pytest

from base_station.core.erasure.erasure import CaptureClocks, Erasure, Wearing
from base_station.core.erasure.redaction import Redactor
from base_station.core.person_references import name_pattern
from base_station.core.state import ERASED_TEXT
from shared.channels import (
    ALARM,
    HEARTBEAT,
    OPERATOR,
    TEMPERATURE,
    Channel,
    backfilled_key,
    unread_key,
)
from shared.codec import decode, encode
from shared.mcap_log import DELTA_TOPIC
from shared.messages import (
    STATION_ID,
    AlarmChange,
    AlarmParameters,
    AlarmState,
    CommandKind,
    Header,
    Heartbeat,
    OperatorAction,
    Temperature,
)
from shared.messages.pins import SetMeeting, SetPin, StartTogether
from shared.messages.station import (
    Action,
    Assign,
    DoneApart,
    ResolveAlarm,
    SendCommand,
    SetStart,
    SetThresholds,
)

HEADER = Header(STATION_ID, 1, 1, 10, t_utc_ns=10)


@pytest.mark.parametrize(
    ("name", "text", "left"),
    [
        ("Al", "Alarm of Al: al is in the hall", "Alarm of #: # is in the hall"),
        ("Ana", "Ana, Anabel, Anas unit, Ana's, (ANA)", "#, Anabel, #s unit, #'s, (#)"),
        ("Cem Öz", "cem öz and Cem Özil", "# and Cem Özil"),
        ("J.", "J. says: FAJ.", "# says: FAJ."),
        ("FF-1", "FF-1, FF-10 and FF-1", "#, FF-10 and #"),
    ],
)
def test_name_is_a_whole_word(name: str, text: str, left: str) -> None:
    assert name_pattern((name,)).sub("#", text) == left


def test_no_names_match_nothing() -> None:
    assert name_pattern(()).search("anything") is None


def redacted(name: str, channel: Channel, message: AlarmChange | OperatorAction) -> object:
    redact = Redactor(Erasure((), (name,), person_id="p1"), CaptureClocks())
    ((_, _, payload),) = redact((10, channel.key(STATION_ID), encode(message)))
    return decode(channel, payload)


def test_person_named_like_an_alarm_leaves_alarms_unchanged() -> None:
    alarm = AlarmChange(
        HEADER,
        "heat:HEAT:5",
        "heat",
        "HEAT",
        1,
        AlarmState.RAISED,
        "heat",
        "Heat is hot",
        "Heat",
        5,
        5,
    )
    wanted = msgspec.structs.replace(alarm, text=f"{ERASED_TEXT} is hot", by=ERASED_TEXT)
    assert redacted("Heat", ALARM, alarm) == wanted
    with_code = msgspec.structs.replace(
        alarm, code="heat", parameters=AlarmParameters(member="Heat", reasons=("heat",))
    )
    assert redacted("Heat", ALARM, with_code) == msgspec.structs.replace(
        wanted, code="heat", parameters=AlarmParameters(member=ERASED_TEXT, reasons=("heat",))
    )
    ours = OperatorAction(HEADER, "a1", STATION_ID, SetThresholds({"heat.caution_degc": 80.0}))
    assert redacted("Heat", OPERATOR, ours) == ours


@pytest.mark.parametrize("length", range(1, 100))
def test_name_is_found_behind_any_byte(length: int) -> None:
    """In the encoding a text's length precedes it, and may look like a letter."""
    text = "Bo".ljust(length + 2, ".")
    stated = OperatorAction(
        HEADER, "a1", "eve", SendCommand("c1", CommandKind.TEXT, "FF-01", "", False, text, 0.0, 9.0)
    )
    found = redacted("Bo", OPERATOR, stated)
    assert isinstance(found, OperatorAction)
    assert isinstance(found.action, SendCommand)
    assert found.action.text == text.replace("Bo", ERASED_TEXT)


def test_ids_stay_so_that_references_match() -> None:
    stated = OperatorAction(HEADER, "a1", "eve", Assign("Max", "p2", "Max", "Max crew", ""))
    found = redacted("Max", OPERATOR, stated)
    assert isinstance(found, OperatorAction)
    assert found.action == Assign("Max", "p2", ERASED_TEXT, f"{ERASED_TEXT} crew", "")


def newer(unit_id: str, seq: int) -> bytes:
    """A message of a newer version that this program cannot read."""
    return encode(Temperature(Header(unit_id, 7, seq, 5, schema=99), 20.0))


@pytest.mark.parametrize(
    ("key", "t_ns", "stays"),
    [
        (TEMPERATURE.key("anna"), 100, True),
        (TEMPERATURE.key("anna"), 150, False),
        (backfilled_key("anna", TEMPERATURE.suffix), 300, False),
        (unread_key("anna", 7, 3, TEMPERATURE.suffix), 300, False),
        (TEMPERATURE.key("bert"), 150, True),
        (backfilled_key("bert", TEMPERATURE.suffix), 150, True),
    ],
)
def test_unreadable_message_is_reduced_to_a_sign_of_life(key: str, t_ns: int, stays: bool) -> None:
    redact = Redactor(
        Erasure((Wearing("anna", 110, 200),), ("Ada",), person_id="p1"), CaptureClocks()
    )
    record = (t_ns, key, newer(key.split("/")[2], 3))
    ((left_ns, left_key, payload),) = redact(record)
    assert left_ns == t_ns
    if stays:
        assert (left_key, payload) == record[1:]
        return
    assert left_key == backfilled_key("anna", HEARTBEAT.suffix)
    assert decode(HEARTBEAT, payload) == Heartbeat(Header("anna", 7, 3, 0), 0, 0)


@pytest.mark.parametrize(
    ("boot_id", "utc_ns", "utc_std_s", "stays"),
    [
        (7, 0, 0.0, False),  # received live: captured at 150
        (8, 0, 0.0, False),  # unknown
        (8, 150, 0.1, False),
        (8, 250, 0.1, True),
        (8, 250, 0.0, False),  # by a clock that was never set
    ],
)
def test_backfilled_messages_of_the_erased_wearer_are_erased(
    boot_id: int, utc_ns: int, utc_std_s: float, stays: bool
) -> None:
    clocks = CaptureClocks()
    clocks.note(140, Header("anna", 7, 1, 40))
    redact = Redactor(Erasure((Wearing("anna", 110, 200),), ("Ada",), person_id="p1"), clocks)
    header = Header("anna", boot_id, 3, 50, utc_ns, utc_std_s)
    record = 300, backfilled_key("anna", TEMPERATURE.suffix), encode(Temperature(header, 20.0))
    ((_, key, payload),) = redact(record)
    assert ((300, key, payload) == record) == stays
    assert stays or isinstance(decode(HEARTBEAT, payload), Heartbeat)


def test_backfilled_messages_of_another_unit_stay() -> None:
    redact = Redactor(
        Erasure((Wearing("anna", 110, 200),), ("Ada",), person_id="p1"), CaptureClocks()
    )
    message = encode(Temperature(Header("bert", 8, 3, 50), 20.0))
    record = 150, backfilled_key("bert", TEMPERATURE.suffix), message
    assert redact(record) == [record]


def pin(unit_id: str, t_ns: int) -> SetPin:
    return SetPin("p", unit_id, t_ns, 3.0, 4.0, 1.0, 0, None, 0.3, "")


def together(*unit_ids: str, t_ns: int) -> StartTogether:
    return StartTogether("p", unit_ids, t_ns, 3.0, 4.0, 1.0, 0, None, 0.3, "")


def met(unit_id: str, other_id: str, t_ns: int) -> SetMeeting:
    return SetMeeting("p", unit_id, other_id, t_ns, 1.0, "")


def start(unit_id: str) -> SetStart:
    return SetStart(unit_id, 3.0, 4.0, 0.0, 0.1, 0.5, 0.1)


@pytest.mark.parametrize(
    ("logged_ns", "action", "left"),
    [
        (150, start("anna"), None),
        (150, start("bert"), start("bert")),
        (250, start("anna"), start("anna")),
        (150, pin("anna", 0), None),
        (250, pin("anna", 150), None),  # of the time when she wore it, sent later
        (150, pin("anna", 50), None),  # of before, sent while she wore it
        (250, pin("anna", 0), pin("anna", 0)),
        (250, pin("anna", 220), pin("anna", 220)),
        (150, met("bert", "anna", 0), None),
        (150, met("anna", "bert", 0), None),
        (250, met("bert", "anna", 150), None),
        (150, met("bert", "carl", 0), met("bert", "carl", 0)),
        (150, together("anna", "bert", t_ns=0), together("bert", t_ns=0)),
        (250, together("anna", "bert", t_ns=150), together("bert", t_ns=150)),
        (150, together("anna", "bert", t_ns=50), together("bert", t_ns=50)),
        (150, together("anna", t_ns=0), None),
        (250, together("anna", "bert", t_ns=220), together("anna", "bert", t_ns=220)),
    ],
)
def test_reported_places_of_the_erased_person_are_removed_and_others_stay(
    logged_ns: int, action: Action, left: Action | None
) -> None:
    redact = Redactor(
        Erasure((Wearing("anna", 110, 200),), ("Ada",), person_id="p1"), CaptureClocks()
    )

    def record(done: Action) -> tuple[int, str, bytes]:
        message = OperatorAction(HEADER, "a-1", "chief", done)
        return logged_ns, OPERATOR.key(STATION_ID), encode(message)

    assert redact(record(action)) == ([] if left is None else [record(left)])


def apart(logged_ns: int, what: str) -> DoneApart:
    """Separate actions by an operator with the name of the erased person: the operator stays."""
    return DoneApart("ada", logged_ns, "Ada", what)


PERSON = Erasure((Wearing("anna", 110, 200),), ("Ada",), person_id="p1")
INCIDENT = Erasure(
    (Wearing("anna", 110, 200),), ("Ada",), incident_id="i1", from_ns=110, until_ns=200
)


@pytest.mark.parametrize(
    ("t_ns", "unit_id", "raised_ns", "left"),
    [
        (250, "anna", 250, ERASED_TEXT),  # sent in the incident, perhaps, and received after it
        (250, "bert", 250, "Ada"),
        (250, "bert", 150, ERASED_TEXT),
        (350, "anna", 350, "Ada"),  # of the next one
        (350, "anna", 250, ERASED_TEXT),
    ],
)
def test_alarms_and_notes_about_an_erased_incident_contain_no_name(
    t_ns: int, unit_id: str, raised_ns: int, left: str
) -> None:
    redact = Redactor(msgspec.structs.replace(INCIDENT, about_until_ns=300), CaptureClocks())
    alarm = AlarmChange(
        HEADER, f"fall:{unit_id}:{raised_ns}", "fall", unit_id, 1, AlarmState.RAISED, "fall",
        "Ada may have fallen", "eve: spoke to Ada", raised_ns, raised_ns,
    )  # fmt: skip
    ((_, _, payload),) = redact((t_ns, ALARM.key(STATION_ID), encode(alarm)))
    stated = f"{left} may have fallen", f"eve: spoke to {left}"
    assert encode(msgspec.structs.replace(alarm, text=stated[0], by=stated[1])) == payload
    noted = ResolveAlarm(alarm.alarm_id, "spoke to Ada")
    done = OperatorAction(HEADER, "a-1", "Ada", noted)
    ((_, _, payload),) = redact((t_ns, OPERATOR.key(STATION_ID), encode(done)))
    reported = msgspec.structs.replace(noted, note=f"spoke to {left}")
    assert encode(msgspec.structs.replace(done, action=reported)) == payload


@pytest.mark.parametrize(
    ("t_ns", "shown", "stays"),
    [
        (100, b"{}", True),
        (120, b"{}", False),
        (250, b"{}", False),  # the trail stays until the next incident
        (350, b"{}", True),
        (350, b'{"text": "{person p1} may have fallen"}', False),
    ],
)
def test_console_snapshots_that_show_an_erased_person_are_removed(
    t_ns: int, shown: bytes, stays: bool
) -> None:
    person = Erasure(
        (Wearing("anna", 110, 200),),
        (),
        person_id="p1",
        openings_ns=(100, 300),
        person_ids=frozenset({"p1"}),
    )
    record = (t_ns, DELTA_TOPIC, shown)
    assert Redactor(person, CaptureClocks())(record) == ([record] if stays else [])


@pytest.mark.parametrize(
    ("erasure", "record_ns", "logged_ns", "what", "left"),
    [
        (PERSON, 300, 150, "SetPin p, anna, 3.0, 4.0", ERASED_TEXT),
        (PERSON, 300, 250, "SetPin p, anna, 150, 3.0, 4.0", ERASED_TEXT),
        (PERSON, 150, 50, "SetStart anna, 3.0, 4.0", ERASED_TEXT),
        (PERSON, 300, 150, "SetMeeting p, bert, anna, 1.0", ERASED_TEXT),
        (PERSON, 300, 150, "StartTogether p, bert, anna, 3.0", ERASED_TEXT),
        (PERSON, 300, 150, "SetPin p, bert, 3.0, 4.0", "SetPin p, bert, 3.0, 4.0"),
        (PERSON, 300, 250, "SetPin p, anna, 3.0, 4.0", "SetPin p, anna, 3.0, 4.0"),
        (PERSON, 300, 150, "CheckIn anna, False", "CheckIn anna, False"),
        (PERSON, 300, 250, "Assign carl, p1, Ada, red", ERASED_TEXT),
        (PERSON, 300, 150, "Assign carl, p2, Cem, red", "Assign carl, p2, Cem, red"),
        (PERSON, 300, 150, "AcknowledgeAlarm fall:Ada", f"AcknowledgeAlarm fall:{ERASED_TEXT}"),
        (INCIDENT, 150, 150, "Assign carl, p2, Cem, ", ERASED_TEXT),
        (INCIDENT, 300, 250, "Assign carl, p2, Cem, ", "Assign carl, p2, Cem, "),
        (INCIDENT, 150, 150, "SetPin p, anna, 3.0, 4.0", ERASED_TEXT),
        (INCIDENT, 300, 150, "SendCommand text, Ada!", f"SendCommand text, {ERASED_TEXT}!"),
        (INCIDENT, 300, 250, "SendCommand text, Ada!", "SendCommand text, Ada!"),
    ],
)
def test_separate_actions_keep_nothing_of_the_forgotten_person(
    erasure: Erasure, record_ns: int, logged_ns: int, what: str, left: str
) -> None:
    action = OperatorAction(HEADER, "a-1", STATION_ID, apart(logged_ns, what))
    record = record_ns, OPERATOR.key(STATION_ID), encode(action)
    ((_, _, payload),) = Redactor(erasure, CaptureClocks())(record)
    found = decode(OPERATOR, payload)
    assert isinstance(found, OperatorAction)
    assert found.action == apart(logged_ns, left)
