"""A wearer's button as the kernel shows it, from its events to the station's alarm."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import closing
from importlib.util import find_spec
from pathlib import Path

import pytest

from tests.rig.emulated_button import NAME, AgentWithButton, has_umockdev_run
from tests.rig.shown_unit import ShownUnit
from tests.rig.station_command import Browser, Command
from tests.rig.waiting import until

pytestmark = [
    pytest.mark.skipif(
        not has_umockdev_run(), reason="no umockdev-run on this machine: install umockdev"
    ),
    pytest.mark.skipif(
        find_spec("evdev") is None, reason="no wheel of evdev-binary for this machine"
    ),
]
_LONGER_S = 7.0  # than two more maydays would take


@pytest.fixture
def shown(serve: Callable[..., Command], data: Path) -> Iterator[ShownUnit]:
    with Browser(serve().wait_ready(), data) as browser:
        browser.call("POST", "/units", json={"unit_id": "u1", "label": "u1"})
        with closing(ShownUnit(browser, "u1")) as shown:
            yield shown


@pytest.fixture
def started(port: int, tmp_path: Path) -> Callable[..., AgentWithButton]:
    def started(name: str, *, is_held: bool) -> AgentWithButton:
        return AgentWithButton(
            tmp_path / name,
            *("--unit", "u1", "--source", "bench:5", "--data", str(tmp_path / "edge")),
            *("--connect", f"tcp/127.0.0.1:{port}", "--button", f"evdev:{NAME}?key=KEY_POWER"),
            is_held=is_held,
        )

    return started


def test_held_button_is_one_mayday_kept_over_a_restart(shown, started) -> None:
    def is_mayday() -> bool:
        status = shown.card.get("status")
        return bool(status and status["mayday"])

    def count() -> int:
        return sum("mayday" in text.lower() for text in shown.alarms.values())

    with started("first", is_held=True) as agent:
        until(is_mayday, "the mayday in the unit's status")
        until(lambda: count() == 1, "the mayday's alarm")
        time.sleep(_LONGER_S)
        assert agent.log().count(": mayday\n") == 1, agent.log()
        assert "cannot be read" not in agent.log()
        assert count() == 1
    with started("second", is_held=False) as agent:
        until(lambda: f"{NAME} (KEY_POWER)" in agent.log(), "the button is open")
        shown.card = {}
        until(is_mayday, "the mayday after the restart")
        assert ": mayday\n" not in agent.log()
