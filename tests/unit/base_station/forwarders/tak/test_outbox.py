"""Outbox to TAK: newest position of each person, alerts first, no unknown values."""

from __future__ import annotations

from collections.abc import Iterable
from xml.etree import ElementTree as ET

import msgspec

from base_station.forwarders.mailbox import Mailbox
from base_station.forwarders.tak.cot import CotEvents
from base_station.forwarders.tak.outbox import TakOutbox
from base_station.views.wire import AlarmView, Snapshot, UnitView
from shared.clock import NS_PER_S
from tests.rig.cot_schema import check_event
from tests.rig.tak_scene import T_MS, Scene, alarm, delta


class Desk:
    """An outbox with a settable clock."""

    def __init__(self, picture: Snapshot, *, breadcrumbs: bool = False) -> None:
        self.outbox = TakOutbox(
            CotEvents("muster", "Red", names=True), 1.0, breadcrumbs=breadcrumbs
        )
        self._mailbox = Mailbox()
        self.now_ns = 100 * NS_PER_S
        self.show(picture)
        self.outbox.begin_connection()

    @property
    def now_ms(self) -> int:
        return T_MS + self.now_ns // 10**6

    def show(self, picture: Snapshot) -> None:
        self._mailbox.put_picture(picture)

    def change(self, *units: UnitView, alarms: Iterable[AlarmView] = ()) -> None:
        self._mailbox.put_delta(delta(*units, alarms=tuple(alarms)))

    def sent(self, after_s: float = 0.0) -> list[ET.Element]:
        """Events that are sent now."""
        self.now_ns += round(after_s * NS_PER_S)
        self.outbox.apply(self._mailbox.take(), self.now_ms)
        return [check_event(one) for one in self.outbox.due(self.now_ns, self.now_ms)]

    def kinds(self, after_s: float = 0.0) -> list[tuple[str, str]]:
        return [(one.get("type", ""), one.get("uid", "")) for one in self.sent(after_s)]


PERSON = "a-f-G-U-C", "muster.FF-01"
RAISED = "b-a-o-tbl", "muster.FF-01-9-1-1"
CANCELLED = "b-a-o-can", "muster.FF-01-9-1-1"


def test_newest_of_many_positions_is_sent_when_it_is_due() -> None:
    scene = Scene()
    desk = Desk(scene.picture())
    assert desk.kinds() == [PERSON]
    desk.change(scene.moved(0.5, 0.1))
    assert desk.kinds(0.1) == [PERSON], "one may come early, so that nobody is held up"
    for step in range(1, 4):
        desk.change(scene.moved(float(step), 0.2 * step))
        assert desk.kinds(0.2) == []
    (event,) = desk.sent(0.3)
    assert float(event[0].get("lat", "")) > 52.50002, "that of three metres"
    assert desk.kinds(5.0) == [], "nothing new"


def test_without_an_anchor_nothing_is_sent() -> None:
    desk = Desk(Scene(anchor=False).picture())
    desk.change(alarms=[alarm()])
    assert desk.kinds() == []
    assert "no place on the Earth" in desk.outbox.hint
    desk.show(Scene().picture(alarms=(alarm(),)))
    assert desk.kinds(0.3) == [RAISED, PERSON], "it was kept until it had a place"


def test_outside_an_incident_only_emergencies_go_out() -> None:
    desk = Desk(Scene(incident=False).picture())
    assert desk.kinds() == []
    assert "incident" in desk.outbox.hint
    desk.change(alarms=[alarm()])
    assert desk.kinds() == [RAISED]


def test_units_of_others_and_switched_off_ones_are_not_sent() -> None:
    scene = Scene()
    desk = Desk(scene.picture(units=(scene.unit(registered=False),)))
    assert desk.kinds() == []
    desk.change(scene.unit(switched_off=True))
    assert desk.kinds() == []
    desk.change(scene.unit())
    assert desk.kinds() == [PERSON]


def test_unit_without_contact_is_sent_at_once_and_then_seldom_and_never_as_fresh() -> None:
    scene = Scene()
    desk = Desk(scene.picture())
    (first,) = desk.sent()
    desk.change(scene.unit(link="stale"))
    (stale,) = desk.sent(0.1)
    assert stale.get("time") == first.get("time")
    assert stale.get("stale") == first.get("stale")
    assert "link stale" in (stale.findtext("detail/remarks") or "")
    for _ in range(9):
        desk.change(scene.unit(link="stale"))
        assert desk.kinds(1.0) == []
    desk.change(scene.unit(link="stale"))
    assert desk.kinds(1.0) == [PERSON]


def test_new_connection_begins_with_all_present_positions() -> None:
    scene = Scene("FF-01", "FF-02")
    desk = Desk(scene.picture())
    assert len(desk.sent()) == 2
    for step in range(1, 100):
        desk.change(scene.moved(float(step), float(step)))
        desk.now_ns += NS_PER_S
    desk.outbox.begin_connection()
    events = {one.get("uid"): one for one in desk.sent()}
    assert set(events) == {"muster.FF-01", "muster.FF-02"}
    assert float(events["muster.FF-01"][0].get("lat", "")) > 52.5008


def test_emergencies_go_before_people_and_are_repeated_until_they_are_cancelled() -> None:
    scene = Scene()
    desk = Desk(scene.picture())
    desk.sent()
    desk.change(scene.moved(1.0, 1.0), alarms=[alarm(), alarm(rule="fall")])
    events = desk.sent(2.0)
    assert [one.get("type") for one in events] == ["b-a-o-tbl", "a-f-G-U-C"]
    assert "fall, mayday" in (events[0].findtext("detail/remarks") or "")
    assert desk.kinds(9.0) == []
    assert desk.kinds(1.0) == [RAISED]
    desk.change(alarms=[alarm(state="resolved")])
    assert desk.kinds() == [RAISED], "the fall is not resolved"
    desk.change(alarms=[alarm(rule="fall", state="acknowledged")])
    assert desk.kinds(10.0) == [RAISED]
    desk.change(alarms=[alarm(rule="fall", state="resolved")])
    cancelled = [desk.kinds(10.0) for _ in range(7)]
    assert cancelled == [[CANCELLED]] * 6 + [[]]


def test_emergency_that_was_never_sent_needs_no_cancellation() -> None:
    desk = Desk(Scene().picture())
    desk.sent()
    desk.change(alarms=[alarm(), alarm(state="resolved")])
    assert desk.kinds() == []


def test_emergency_is_raised_again_after_its_cancellation() -> None:
    desk = Desk(Scene().picture(alarms=(alarm(),)))
    assert RAISED in desk.kinds()
    desk.change(alarms=[alarm(state="resolved")])
    assert desk.kinds() == [CANCELLED]
    again = msgspec.structs.replace(alarm(), alarm_id="mayday|FF-01|2")
    desk.change(alarms=[again])
    assert desk.kinds() == [RAISED]
    assert desk.kinds(10.0) == [RAISED]


def test_emergency_ended_while_the_station_was_off_is_cancelled() -> None:
    resolved = msgspec.structs.replace(alarm(state="resolved"), changed_ms=T_MS + 90_000)
    desk = Desk(Scene().picture(alarms=(resolved,)))
    assert desk.kinds() == [CANCELLED, PERSON]
    long_ago = msgspec.structs.replace(alarm(state="resolved"), changed_ms=T_MS - 900_000)
    assert Desk(Scene().picture(alarms=(long_ago,))).kinds() == [PERSON]


def test_emergency_missing_in_a_new_snapshot_is_over() -> None:
    desk = Desk(Scene().picture(alarms=(alarm(),)))
    desk.sent()
    desk.show(Scene().picture())
    assert CANCELLED in desk.kinds()


def test_only_alarms_of_units_are_emergencies() -> None:
    desk = Desk(Scene().picture())
    desk.sent()
    desk.change(alarms=[alarm(rule="battery", priority=2), alarm(unit_id="")])
    assert desk.kinds() == []


def test_emergency_without_a_position_is_sent() -> None:
    scene = Scene()
    picture = scene.picture(units=(scene.unit(position=None),), alarms=(alarm(),))
    desk = Desk(picture)
    assert desk.kinds() == []
    assert "FF-01" in desk.outbox.hint
    desk.change(scene.unit())
    assert RAISED in desk.kinds(0.3)


def test_breadcrumbs_follow_a_moving_person() -> None:
    scene = Scene()
    desk = Desk(scene.picture(), breadcrumbs=True)
    assert desk.kinds() == [PERSON]
    for step in range(1, 4):
        desk.change(scene.moved(3.0 * step, float(step)))
        kinds = desk.kinds(1.0)
        assert kinds == [PERSON, ("u-d-f", "muster.FF-01-way")][: 2 if step == 1 else 1]
    desk.change(scene.moved(9.5, 30.0))
    events = desk.sent(20.0)
    assert [len(one.findall("detail/link")) for one in events] == [0, 4]


def test_slow_server_is_sent_everybody_in_turn() -> None:
    """The person sent longest ago goes first."""
    scene = Scene("FF-01", "FF-02", "FF-03")
    desk = Desk(scene.picture())
    first = next(desk.outbox.due(desk.now_ns, desk.now_ms), None)
    assert first is None, "nothing was applied yet"
    desk.outbox.apply(desk._mailbox.take(), desk.now_ms)
    seen = []
    for step in range(6):
        desk.change(*(scene.moved(1.0, 10.0 + step, f"FF-0{one}") for one in (1, 2, 3)))
        desk.outbox.apply(desk._mailbox.take(), desk.now_ms)
        event = next(desk.outbox.due(desk.now_ns, desk.now_ms))
        seen.append(check_event(event).get("uid"))
        desk.now_ns += 2 * NS_PER_S
    assert seen == 2 * ["muster.FF-01", "muster.FF-02", "muster.FF-03"]


def test_next_send_time_is_that_of_waiting_events() -> None:
    scene = Scene()
    desk = Desk(scene.picture())
    desk.sent()
    assert desk.outbox.next_due_ns(desk.now_ns) == desk.now_ns + NS_PER_S
    desk.change(scene.moved(1.0, 1.0), alarms=[alarm()])
    desk.sent()
    desk.change(scene.moved(2.0, 1.2))
    desk.sent(0.25)
    assert desk.outbox.next_due_ns(desk.now_ns) == desk.now_ns + round(0.75 * NS_PER_S)
