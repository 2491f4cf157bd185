"""Wearers of the demo react to the signals of their panels, and to a person at the terminal."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import closing
from pathlib import Path

import pytest

from deploy.demo.crew import Responder
from deploy.demo.wearers import Wearers
from edge.wearer.registry import open_button
from shared.clock import SystemClock
from tests.rig.waiting import until

RESPONDER = Responder(
    "FF-01", "Astrid", "Engine 1", "Search", "#000000", "bench:1", reacts_to=("evacuate",)
)


@pytest.fixture
def output(tmp_path: Path) -> Path:
    return tmp_path / "FF-01.txt"


@pytest.fixture
def wearers(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Wearers]:
    monkeypatch.setattr("deploy.demo.wearers._REACTION_S", 0.0)
    with Wearers([RESPONDER], tmp_path) as wearers:
        yield wearers


@pytest.fixture
def is_pressed(wearers: Wearers) -> Iterator[Callable[[str], bool]]:
    """Return whether the unit's agent has read this press."""
    flags = wearers.flags("FF-01")
    reader = open_button(flags[flags.index("--button") + 1], SystemClock())
    found: list[str] = []

    def is_pressed(button: str) -> bool:
        found.extend(press.button for press in reader.take())
        return button in found

    reader.start()
    with closing(reader):
        yield is_pressed


def test_signal_is_answered_and_shown_once(
    wearers: Wearers, is_pressed: Callable[[str], bool], output: Path
) -> None:
    assert wearers.step(1.0) == []
    output.write_text("log line\nFF-01: [evacuate] Evacuate.\nFF-01: [mes")
    assert wearers.step(2.0) == ["FF-01: [evacuate] Evacuate."]
    until(lambda: is_pressed("acknowledge"), "the press")
    output.write_text("log line\nFF-01: [evacuate] Evacuate.\nFF-01: [message] Message: x\n")
    assert wearers.step(3.0) == ["FF-01: [message] Message: x"]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("typed", "button"),
    [("FF-01 mayday", "mayday"), ("ff-01 OK\n", "acknowledge"), ("FF-01  cancel", "cancel")],
)
def test_typed_line_is_a_press(
    wearers: Wearers, is_pressed: Callable[[str], bool], typed: str, button: str
) -> None:
    assert wearers.obey(typed)
    until(lambda: is_pressed(button), "the press")


@pytest.mark.parametrize("typed", ["", "FF-01", "FF-09 ok", "FF-01 jump"])
def test_line_without_a_button_is_ignored(wearers: Wearers, typed: str) -> None:
    assert not wearers.obey(typed)
