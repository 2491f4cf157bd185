"""Order of an erasure in the log: events before it are judged, and those behind it stay."""

from __future__ import annotations

from base_station.core.erasure.erasure import Record
from base_station.core.erasure.erasure_order import OrderedPart, actions_before, last_order
from shared.channels import ALARM, OPERATOR, TICK
from shared.codec import encode
from shared.messages import STATION_ID, Header, OperatorAction
from shared.messages.station import Action, BeginErasure, Unassign

ANA = BeginErasure("person", "p1")


def done(t_ns: int, action: Action) -> Record:
    message = OperatorAction(Header(STATION_ID, 1, t_ns, 0), f"a{t_ns}", "ada", action)
    return t_ns, OPERATOR.key(STATION_ID), encode(message)


LOG = [
    done(1, Unassign("A")),
    done(2, ANA),
    done(3, BeginErasure("incident", "p1")),
    done(4, ANA),
    done(5, BeginErasure("person", "p2")),
]


def test_last_order_of_a_subject_counts() -> None:
    order = last_order(LOG, "person", "p1")
    assert order is not None
    assert (order.action_id, order.t_ns, order.by) == ("a4", 4, "ada")
    assert actions_before(LOG, order) == LOG[:3]
    assert last_order(LOG, "person", "p3") is None
    assert actions_before(LOG, None) == LOG


def test_events_behind_the_order_stay_and_what_is_derived_is_judged_to_the_end() -> None:
    before, behind = ((t_ns, TICK.key(STATION_ID), b"") for t_ns in (4, 6))
    alarm = (7, ALARM.key(STATION_ID), b"")
    log = [*LOG[:3], before, *LOG[3:], behind, alarm]
    part, whole = OrderedPart(last_order(LOG, "person", "p1")), OrderedPart(None)
    left = [one for record in log for one in part.redacted(record, lambda _: [])]
    assert left == [LOG[4], behind]
    assert [one for record in log for one in whole.redacted(record, lambda _: [])] == []
