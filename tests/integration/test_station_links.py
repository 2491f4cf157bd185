"""Links that come and go at the live engine, by the tokens of units."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path

import pytest

from shared.bus import Subscription
from shared.channels import TICK, alive_key
from shared.clock import NS_PER_S
from shared.codec import decode
from shared.messages import STATION_ID, Header, Position
from shared.messages.station import RegisterUnit, Tick
from tests.rig.live_station import LiveStation
from tests.rig.waiting import until

MakePosition = Callable[..., Position]
U = "FF-01"


def link_up(station: LiveStation, unit_id: str = U) -> Subscription:
    return station.router.attach_unit().declare_alive(alive_key(unit_id))


def ticks(station: LiveStation) -> list[Tick]:
    key = TICK.key(STATION_ID)
    stated = [decode(TICK, stated) for _, its, stated in station.log.records() if its == key]
    return [tick for tick in stated if isinstance(tick, Tick)]


def unlinked(station: LiveStation) -> tuple[str, ...]:
    """As told last."""
    return next((tick.unlinked for tick in reversed(ticks(station))), ())


def shown_link(station: LiveStation) -> str:
    return next(unit.link for unit in station.snapshot().units if unit.unit_id == U)


def test_lost_link_is_shown_before_the_silence_timeout(
    tmp_path: Path, make_position: MakePosition
) -> None:
    with LiveStation(tmp_path) as station:
        station.act(RegisterUnit(U, "one"))
        station.publish(make_position())
        token = link_up(station)
        until(lambda: shown_link(station) == "live")
        token.close()
        until(lambda: shown_link(station) == "stale")
        assert unlinked(station) == (U,)
        station.publish(make_position(header=Header(U, 7, 9, 2 * NS_PER_S)))
        until(lambda: shown_link(station) == "live")


def test_successive_lost_links_do_not_stop_the_stations_time(
    tmp_path: Path,
) -> None:
    """Each is told by a tick that comes early; the next one comes when it would have come."""
    with LiveStation(tmp_path) as station:
        for number in range(8):
            station.act(RegisterUnit(f"FF-{number}", "one"))
            link_up(station, f"FF-{number}").close()
            until(lambda: len(unlinked(station)) > number)  # noqa: B023  # called in this turn
        before = len(ticks(station))
        until(lambda: len(ticks(station)) > before, "time goes on", 3.0)


def test_flapping_links_cause_few_ticks(tmp_path: Path, make_position: MakePosition) -> None:
    """Each is stepped and written, and costs what a second of all units does."""
    seconds = 2.0
    with LiveStation(tmp_path) as station:
        station.act(RegisterUnit(U, "one"))
        end_s, seq = time.monotonic() + seconds, 0
        while time.monotonic() < end_s:
            seq += 1
            link_up(station, f"FF-{seq}").close()
            station.publish(make_position(header=Header(U, 7, seq, seq)))  # the drive has a turn
            time.sleep(0.01)
        station.recorder.flush()
        assert len(ticks(station)) < seconds * 8


def test_silent_unit_with_a_link_is_asked_for_its_journal(
    tmp_path: Path, make_position: MakePosition, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Over a link that live data does not get through, say: it is not waited for."""
    monkeypatch.setattr("base_station.core.state.message_stream.STALE_AFTER_S", 0.1)
    with LiveStation(tmp_path) as station:
        for unit_id in (U, "FF-02", "FF-03"):
            station.act(RegisterUnit(unit_id, unit_id))
        station.publish(make_position())
        token, unheard = link_up(station), link_up(station, "FF-02")
        until(lambda: station.reported.keys() == {U, "FF-02"})
        assert shown_link(station) == "stale"
        assert [held.boot_id for held in station.reported[U]] == [make_position().header.boot_id]
        token.close()
        until(lambda: station.reported.keys() == {"FF-02"})
        unheard.close()
