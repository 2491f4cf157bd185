"""Gestures: meaning of presses, with any bounce of the contact and any polling rate."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from hypothesis import given
from hypothesis import strategies as st

from edge.samples import ACKNOWLEDGE, CANCEL, MAYDAY, ButtonPress
from edge.wearer.gestures import (
    HOLD_LEAST_NS,
    HOLD_NS,
    Gesture,
    GestureRecognizer,
)
from edge.wearer.interface import ContactChange
from shared.clock import NS_PER_MS, NS_PER_S

STUCK = "stuck"
BEGIN_NS = 5 * NS_PER_S
# (milliseconds pressed, milliseconds released after that) ...
Presses = list[tuple[int, int]]


def changes_of(presses: Presses) -> tuple[list[ContactChange], int]:
    """With the time at which the last one is over."""
    t_ns, changes = BEGIN_NS, []
    for pressed_ms, released_ms in presses:
        changes += [
            ContactChange(t_ns, is_pressed=True),
            ContactChange(t_ns + pressed_ms * NS_PER_MS, is_pressed=False),
        ]
        t_ns += (pressed_ms + released_ms) * NS_PER_MS
    return changes, t_ns


def gestures_of(presses: Presses, look_every_ms: int = 0) -> list[Gesture]:
    """``look_every_ms``: 0 for only when something changes, and at the end."""
    changes, end_ns = changes_of(presses)
    recognizer, found, now_ns = GestureRecognizer(), list[Gesture](), BEGIN_NS
    for change in changes:
        while look_every_ms and now_ns < change.t_ns:
            found += recognizer.advance(now_ns)
            now_ns += look_every_ms * NS_PER_MS
        found += recognizer.push(change)
    return [*found, *recognizer.advance(end_ns)]


def kinds(found: list[Gesture]) -> list[str]:
    return [one.button if isinstance(one, ButtonPress) else STUCK for one in found]


@pytest.mark.parametrize(
    ("presses", "meant"),
    [
        ([(29, 2000)], []),  # bounce
        ([(30, 2000)], [ACKNOWLEDGE]),
        ([(200, 2000)], [ACKNOWLEDGE]),
        ([(1000, 2000)], [ACKNOWLEDGE]),
        ([(1001, 2000)], []),
        ([(1999, 2000)], []),
        ([(2000, 2000)], [MAYDAY]),
        ([(9000, 2000)], [MAYDAY]),
        ([(200, 600), (200, 2000)], [CANCEL]),
        ([(200, 601), (200, 2000)], [ACKNOWLEDGE, ACKNOWLEDGE]),
        ([(200, 300), (200, 300), (200, 2000)], [CANCEL, ACKNOWLEDGE]),
        ([(200, 300), (200, 300), (200, 300), (200, 2000)], [CANCEL, CANCEL]),
        ([(200, 300), (1500, 2000)], [ACKNOWLEDGE]),
        ([(200, 300), (2500, 2000)], [ACKNOWLEDGE, MAYDAY]),
        ([(2500, 300), (200, 2000)], [MAYDAY, ACKNOWLEDGE]),
        ([(2500, 300), (200, 300), (200, 2000)], [MAYDAY, CANCEL]),
        ([(1500, 29), (1500, 2000)], [MAYDAY]),  # a loose contact
        ([(1500, 30), (1500, 2000)], []),
        ([(1990, 20), (25, 2000)], [MAYDAY]),  # held on, as it bounces
        ([(1990, 2000)], []),
        ([(5, 5), (5, 5), (2000, 2000)], [MAYDAY]),
        ([(200, 20), (5, 5), (5, 2000)], [ACKNOWLEDGE]),
        ([(60_001, 2000)], [MAYDAY, STUCK]),
        ([(600_000, 2000)], [MAYDAY, STUCK]),
        ([(600_000, 2000), (2100, 2000)], [MAYDAY, STUCK, MAYDAY]),
    ],
)
@pytest.mark.parametrize("look_every_ms", [0, 7])
def test_presses_are_recognised_as_gestures(
    presses: Presses, meant: list[str], look_every_ms: int
) -> None:
    assert kinds(gestures_of(presses, look_every_ms)) == meant


def test_a_mayday_does_not_wait_for_the_release() -> None:
    recognizer = GestureRecognizer()
    recognizer.push(ContactChange(BEGIN_NS, is_pressed=True))
    assert recognizer.advance(BEGIN_NS + HOLD_NS - 1) == []
    assert recognizer.advance(BEGIN_NS + HOLD_NS) == [ButtonPress(BEGIN_NS + HOLD_NS, MAYDAY)]
    assert recognizer.advance(BEGIN_NS + 2 * HOLD_NS) == []


def test_a_shorter_hold_can_be_set_and_less_than_that_is_abandoned() -> None:
    recognizer = GestureRecognizer(HOLD_LEAST_NS)
    recognizer.push(ContactChange(BEGIN_NS, is_pressed=True))
    assert recognizer.advance(BEGIN_NS + HOLD_LEAST_NS - 1) == []
    called = ButtonPress(BEGIN_NS + HOLD_LEAST_NS, MAYDAY)
    assert recognizer.advance(BEGIN_NS + HOLD_LEAST_NS) == [called]
    assert recognizer.advance(BEGIN_NS + 2 * HOLD_NS) == []
    abandoned = GestureRecognizer(HOLD_LEAST_NS)
    abandoned.push(ContactChange(BEGIN_NS, is_pressed=True))
    abandoned.push(ContactChange(BEGIN_NS + HOLD_LEAST_NS - 1, is_pressed=False))
    assert abandoned.advance(BEGIN_NS + 2 * HOLD_NS) == []


PRESSES = st.lists(
    st.tuples(
        st.one_of(st.integers(1, 100), st.integers(900, 1100), st.integers(1900, 70_000)),
        st.one_of(st.integers(1, 100), st.integers(500, 700), st.integers(1000, 5000)),
    ),
    max_size=12,
)


def holds_ms(presses: Presses) -> Iterator[int]:
    """Durations of closed contacts, except those shorter than 30 ms."""
    begun_ms: int | None = None
    t_ms = 0
    for pressed_ms, released_ms in presses:
        if begun_ms is None and pressed_ms >= 30:
            begun_ms = t_ms
        t_ms += pressed_ms
        if begun_ms is not None and released_ms >= 30:
            yield t_ms - begun_ms
            begun_ms = None
        t_ms += released_ms


@given(PRESSES)
def test_a_mayday_is_a_hold_of_two_seconds_and_each_gives_one(presses: Presses) -> None:
    found = gestures_of([*presses, (1, 5000)])
    held_ms = list(holds_ms([*presses, (1, 5000)]))
    assert kinds(found).count(MAYDAY) == sum(one >= 2000 for one in held_ms)
    assert kinds(found).count(STUCK) == sum(one > 60_000 for one in held_ms)


@given(PRESSES)
def test_each_short_press_means_something_once(presses: Presses) -> None:
    found = kinds(gestures_of([*presses, (1, 5000)]))
    short = sum(one <= 1000 for one in holds_ms([*presses, (1, 5000)]))
    assert found.count(ACKNOWLEDGE) + 2 * found.count(CANCEL) == short


@given(PRESSES, st.integers(1, 400))
def test_how_often_it_is_looked_at_changes_nothing(presses: Presses, look_every_ms: int) -> None:
    """A machine that is busy for a second makes no mayday of a press, nor loses one."""
    begun = [(one, after) for one, after in presses if one < 5000]
    assert gestures_of(begun, look_every_ms) == gestures_of(begun)


@given(PRESSES)
def test_gestures_come_in_order_of_time(presses: Presses) -> None:
    times = [one.t_ns for one in gestures_of([*presses, (1, 5000)])]
    assert times == sorted(times)


class TestAButtonThatComesAndGoes:
    def setup_method(self) -> None:
        self.recognizer = GestureRecognizer()

    def at(self, seconds: float) -> int:
        return BEGIN_NS + round(seconds * NS_PER_S)

    def state(self, seconds: float, *, is_pressed: bool) -> list[str]:
        change = ContactChange(self.at(seconds), is_pressed=is_pressed)
        return kinds(self.recognizer.push(change))

    def lose(self, seconds: float) -> list[str]:
        return kinds(self.recognizer.lose(self.at(seconds)))

    def advance(self, seconds: float) -> list[str]:
        return kinds(self.recognizer.advance(self.at(seconds)))

    def test_a_hold_that_is_broken_off_is_no_mayday(self) -> None:
        self.state(0.0, is_pressed=True)
        assert self.lose(1.9) == []
        assert self.advance(30.0) == []
        assert not self.recognizer.is_undecided

    def test_button_found_pressed_counts_as_held_from_then_on(self) -> None:
        self.state(0.0, is_pressed=True)
        self.lose(1.0)
        self.state(3.0, is_pressed=True)
        assert self.advance(4.9) == []
        assert self.advance(5.0) == [MAYDAY]

    def test_a_stuck_one_that_comes_back_gives_no_second_mayday(self) -> None:
        self.state(0.0, is_pressed=True)
        assert self.lose(10.0) == [MAYDAY]
        for begin_s in (20.0, 40.0):
            self.state(begin_s, is_pressed=True)
            assert self.lose(begin_s + 10.0) == []
        self.state(60.0, is_pressed=False)
        self.state(61.0, is_pressed=True)
        assert self.advance(64.0) == [MAYDAY]

    def test_button_that_returns_released_starts_anew(self) -> None:
        self.state(0.0, is_pressed=True)
        assert self.lose(10.0) == [MAYDAY]
        self.state(20.0, is_pressed=False)
        self.lose(21.0)
        self.state(30.0, is_pressed=True)
        assert self.advance(33.0) == [MAYDAY]

    def test_a_press_before_it_went_is_not_lost(self) -> None:
        self.state(0.0, is_pressed=True)
        self.state(0.2, is_pressed=False)
        assert self.lose(0.4) == []
        assert self.recognizer.is_undecided
        assert self.advance(2.0) == [ACKNOWLEDGE]


def test_recogniser_is_undecided_until_a_gesture_is_complete_or_impossible() -> None:
    recognizer = GestureRecognizer()
    seen = []
    for t_ms, is_pressed in ((0, True), (3100, True), (3200, False), (3300, False)):
        recognizer.push(ContactChange(BEGIN_NS + t_ms * NS_PER_MS, is_pressed=is_pressed))
        seen.append(recognizer.is_undecided)
    assert seen == [True, False, True, False]
