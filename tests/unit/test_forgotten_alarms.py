"""What alarms said of somebody, in the tables, once that person is forgotten."""

from __future__ import annotations

from pathlib import Path

from base_station.db.forgetting import forget_in
from base_station.db.models import Alarm, AlarmLife
from base_station.db.store import Store
from base_station.forgetting.erasure import Erasure, Wearing

FALL = {"alarm_id": "fall:FF-01:1", "state": "raised", "level": "fall", "by": ""}


def test_an_alarm_raised_anew_by_another_wearer_keeps_nothing_of_the_one_between(
    tmp_path: Path,
) -> None:
    """Three people wore the unit one after the other, and nobody resolved the alarm."""
    texts = {10: "Ana may have fallen", 20: "Bo may have fallen", 30: "Cem may have fallen"}
    bo = Erasure((Wearing("FF-01", 15, 25),), ("Bo",), person_id="p-bo")
    with Store(tmp_path / "station.sqlite") as store:
        with store.write() as session:
            session.add(
                Alarm(
                    **FALL, rule="fall", unit_id="FF-01", priority=1, text=texts[30],
                    raised_ns=10, changed_ns=30,
                )
            )  # fmt: skip
            session.add_all(AlarmLife(**FALL, t_ns=t_ns, text=text) for t_ns, text in texts.items())
        with store.write() as session:
            forget_in(session, bo)
        with store.read() as session:
            told = {one.t_ns: one.text for one in session.query(AlarmLife)}
    assert told == texts | {20: "(forgotten) may have fallen"}
