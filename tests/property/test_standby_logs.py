"""Two logs that diverged are cut at their divergence, whatever their history."""

from __future__ import annotations

from collections.abc import Sequence

import pytest
from hypothesis import given
from hypothesis import strategies as st

from base_station.core.log_position import START, LogPosition
from base_station.standby.log_ancestry import find_divergence
from base_station.standby.protocol import LogAncestry
from shared.errors import ConfigError
from shared.messages.station import TakeOver

Event = tuple[int, str]  # time, event


class Log:
    """The events of one station, take-overs among them."""

    def __init__(self, events: Sequence[Event | TakeOver] = ()) -> None:
        self.events = list(events)

    def place(self, upto: int | None = None) -> LogPosition:
        here = START
        for event in self.events[:upto]:
            here = here.next(_time(event))
        return here

    def history(self) -> LogAncestry:
        take_overs = tuple(event for event in self.events if isinstance(event, TakeOver))
        log_id = _time(self.events[0]) if self.events else 0
        return LogAncestry(log_id, take_overs, self.place())

    def cut(self, place: LogPosition) -> None:
        self.events = [
            event for count, event in enumerate(self.events, 1) if self.place(count) <= place
        ]

    def take_over(self, term: int, station: str) -> None:
        place = self.place()
        self.events.append(TakeOver(term, station, place.t_ns, place.events))


def _time(event: Event | TakeOver) -> int:
    return event.after_t_ns + 1 if isinstance(event, TakeOver) else event[0]


STEPS = st.lists(
    st.tuples(st.sampled_from(["say", "fetch", "crash", "part", "meet"]), st.integers(0, 6)),
    max_size=30,
)


@given(STEPS)
def test_cut_after_any_history_makes_one_log_a_prefix_of_the_other(
    steps: list[tuple[str, int]],
) -> None:
    """``a`` and ``b`` lead in turn; the follower may have fetched less than all."""
    logs = {"a": Log(), "b": Log()}
    leads, term, time = "a", 1, 10
    logs["a"].take_over(1, "a")
    for step, amount in steps:
        follows = "b" if leads == "a" else "a"
        if step == "say":
            for number in range(amount):
                time += number % 2  # some events have the same time
                logs[leads].events.append((max(time, _time(logs[leads].events[-1])), f"{time}"))
        elif step == "fetch":
            _follow(logs[follows], logs[leads], most=amount)
        else:  # the other takes over; the former leader may write on until it learns of that
            term += 1
            logs[follows].take_over(term, follows)
            if step == "part":
                for number in range(amount):
                    last = _time(logs[leads].events[-1])
                    logs[leads].events.append((last + number % 2, f"apart {number}"))
            leads = follows
            if step == "meet":
                follows = "b" if leads == "a" else "a"
                _follow(logs[follows], logs[leads], most=amount)
    follows = "b" if leads == "a" else "a"
    _follow(logs[follows], logs[leads], most=10**6)
    assert logs[follows].events == logs[leads].events


def _follow(mine: Log, leader: Log, most: int) -> None:
    cut = find_divergence(mine.history(), leader.history())
    if cut is not None:
        mine.cut(cut)
    assert find_divergence(mine.history(), leader.history()) is None
    assert mine.events == leader.events[: len(mine.events)]
    mine.events += leader.events[len(mine.events) : len(mine.events) + most]


def test_empty_log_follows_any_log() -> None:
    assert find_divergence(LogAncestry(0, (), START), LogAncestry(5, (), LogPosition(9, 1))) is None


def test_log_of_another_station_is_refused() -> None:
    with pytest.raises(ConfigError, match="holds the log of another station"):
        find_divergence(
            LogAncestry(4, (), LogPosition(9, 1)), LogAncestry(5, (), LogPosition(9, 1))
        )
