"""What people asked for is told at once, whatever the disk makes of it."""

from __future__ import annotations

from pathlib import Path
from threading import Event, Thread
from typing import NamedTuple

import msgspec
import pytest

from base_station.wishes import Wishes
from shared.errors import ConfigError, StoreError
from tests.waiting import PATIENCE_S, until


class State(NamedTuple):
    is_over: bool = False


class Wish(msgspec.Struct):
    name: str
    state: State = State()
    share: float = 0.0


def wished(wishes: Wishes[Wish], name: str) -> Wish:
    return wishes.add(lambda _: Wish(name))


def test_how_things_stand_is_told_while_the_disk_hangs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The live picture tells it."""
    wishes = Wishes(tmp_path / "wishes.json", Wish)
    wished(wishes, "first")
    (first,) = wishes.under_way()
    asked, answers = Event(), Event()

    def hang(*_: object) -> None:
        asked.set()
        answers.wait()

    told: list[tuple[Wish, ...]] = []
    with monkeypatch.context() as patched:
        patched.setattr("base_station.wishes.write_atomically", hang)
        saving = Thread(target=wished, args=(wishes, "second"))
        saving.start()
        assert asked.wait(PATIENCE_S)
        looking = Thread(target=lambda: told.append(wishes.all()), daemon=True)
        looking.start()
        noting = Thread(target=lambda: wishes.note(first, save=False, share=0.5), daemon=True)
        noting.start()
        try:
            until(lambda: told and first.share, patience_s=10.0)
            assert [one.name for one in told[0]] == ["first"], "the second is not on the disk"
        finally:
            answers.set()
        saving.join()
    assert [one.name for one in wishes.all()] == ["first", "second"]
    assert wishes.note(first, save=True, share=1.0)
    again = Wishes(tmp_path / "wishes.json", Wish)
    assert [(one.name, one.share) for one in again.all()] == [("first", 1.0), ("second", 0.0)]


def test_of_those_that_are_over_the_last_are_told_and_all_that_are_not(tmp_path: Path) -> None:
    wishes = Wishes(tmp_path / "wishes.json", Wish)
    for number in range(50):
        wished(wishes, f"wish {number}")
        *_, last = wishes.under_way()
        if number != 3:
            wishes.note(last, save=False, state=State(is_over=True))
    over = [f"wish {number}" for number in range(30, 50)]
    assert [one.name for one in wishes.all()] == [*over[:-1], "wish 3", over[-1]]


def test_what_the_disk_does_not_take_is_not_wished(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    wishes = Wishes(tmp_path / "wishes.json", Wish)

    def refuse(*_: object) -> None:
        raise ConfigError("the disk is full")

    monkeypatch.setattr("base_station.wishes.write_atomically", refuse)
    with pytest.raises(StoreError, match="nothing is done: the disk is full"):
        wished(wishes, "first")
    assert wishes.all() == ()
