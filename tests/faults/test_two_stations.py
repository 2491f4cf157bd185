"""Pair of stations with units: one dies and comes back, and the cable between them is cut."""

from __future__ import annotations

import json
import time
import urllib.request
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest

from edge.storage.journal.journal import Journal, JournalRow
from shared.channels import POSITION
from shared.clock import NS_PER_S
from shared.codec import encode
from shared.errors import BusError
from shared.messages import Header
from tests.bench.standby.command import kill_both
from tests.bench.standby.station_of_pair import Place, Station
from tests.bench.standby.two_stations import TwoStations
from tests.rig.lossy_link import CLEAN, DARK, LossyLink
from tests.rig.message_factory import position
from tests.rig.pacing import PATIENCE_S, wait_until
from tests.rig.settable_clock import MachineClock
from tests.rig.two_stations import two_stations

APART_S = 3.0
REPORTED_S = 3.0  # a beat that names a new unit comes within a fifth of that on a busy machine, too
DAY_S, HOUR_S = 86_400.0, 3_600.0
OLD_BOOT, BACKLOG = 0xABCD, 40_000


def texts(station: Station) -> list[str]:
    return [command["text"] for command in station.get("/commands")]


def tell_everyone(station: Station, text: str) -> None:
    station.post("/commands", {"kind": "text", "target": {"everyone": True}, "text": text})


def evacuate(station: Station, key: str) -> str:
    """The id of the command that this request made, now or before."""

    def post() -> str:
        request = urllib.request.Request(  # our own station's address
            f"{station.url}/api/v1/commands",
            method="POST",
            data=json.dumps({"kind": "evacuate", "target": {"everyone": True}}).encode(),
            headers={
                "Content-Type": "application/json",
                "Origin": station.url,
                "Cookie": station.logged_in().cookie,
                "Idempotency-Key": key,
            },
        )
        with urllib.request.urlopen(request, timeout=PATIENCE_S) as answer:
            return str(json.load(answer)["command_id"])

    return station.place.call(post)


def fill_journal(folder: Path, unit_id: str) -> None:
    """Fills the journal with messages of an hour without a station."""
    folder.mkdir(parents=True)
    journal = Journal(folder / "journal.sqlite", lambda: OLD_BOOT, time.time_ns(), 10**9)
    for first in range(1, BACKLOG, 1000):
        headers = [
            Header(unit_id, OLD_BOOT, seq, seq * 10**8) for seq in range(first, first + 1000)
        ]
        journal.append(
            [JournalRow(one.seq, POSITION, one.seq, encode(position(one))) for one in headers]
        )
    journal.close()


def count_old(station: Station) -> int:
    """Number of those messages in a station's log."""
    return sum(boot_id == OLD_BOOT for _, boot_id, _ in station.logged().messages)


def complete(two: TwoStations) -> None:
    """Wait until both logs have everything that the units have said by now."""
    stated = two.output()
    assert len(stated) > 100
    wait_until("nothing is missing", lambda: two.both_have(stated))


def end_and_compare(two: TwoStations, ends_first: Station) -> None:
    """No message is twice in a log, and one log is the beginning of the other."""
    two.stop_units()
    ends_first.stop()
    (ends_last,) = {two.first, two.second} - {ends_first}
    ends_last.stop()
    short, long = ends_first.logged(), ends_last.logged()
    assert (short.duplicates, long.duplicates) == (0, 0)
    assert short.events == long.events[: len(short.events)]


def test_standby_takes_over_and_the_first_station_returns(
    tmp_path: Path, closing: ExitStack
) -> None:
    """In the middle of a long backlog, and though the two machines' clocks differ by a day and are
    both set back by an hour meanwhile.
    """
    two = two_stations(tmp_path, (Place(), Place()), closing)
    fill_journal(tmp_path / "units" / "anna", "anna")
    one, other = MachineClock(tmp_path, "first"), MachineClock(tmp_path, "second")
    other.set_ahead(DAY_S)
    with other.ticks():
        two.second.start()
    with one.ticks():
        two.first.start()
    wait_until("the second follows", lambda: two.first.leads() and two.second.follows())
    assert "ahead" in str(two.second.get("/health")["problems"])
    two.start_unit("anna", two.first)
    two.start_unit("bert", two.second)
    two.wait_received(two.first)
    two.first.post("/incidents", {"name": "Mill Lane"})
    evacuation = evacuate(two.first, "k1")
    wait_until("the second knows of it", lambda: two.second.get("/commands"))
    assert two.second.refuses("/incidents", {"name": "Other"})
    wait_until("the backlog comes", lambda: count_old(two.first) > 1000)
    two.first.kill()
    one.set_ahead(-HOUR_S)
    other.set_ahead(DAY_S - HOUR_S)
    assert count_old(two.first) < BACKLOG  # in the middle
    wait_until("the second leads", two.second.leads)
    assert [one["name"] for one in two.second.get("/incidents")] == ["Mill Lane"]
    assert evacuate(two.second, "k1") == evacuation, "it is the same request"
    again = evacuate(two.second, "k2")
    assert again != evacuation
    two.second.post(f"/commands/{again}/all-clear", {})
    tell_everyone(two.second, "come out")
    wait_until("the units answer", lambda: two.second.delivered("come out") == {"anna", "bert"})
    with one.ticks():
        two.first.start()
    wait_until("the first follows", two.first.follows)
    assert texts(two.first) == ["", "", "", "come out"]
    stands = {one["command_id"]: one["ended_ms"] is None for one in two.first.get("/commands")}
    assert (stands[evacuation], stands[again]) == (False, False), "the all clear ends both"
    complete(two)
    end_and_compare(two, two.first)
    times_ns = [t_ns for t_ns, _, _ in two.first.logged().events]
    assert times_ns == sorted(times_ns)
    assert times_ns[-1] - times_ns[0] < DAY_S / 24 * NS_PER_S


def test_kills_of_both_stations_leave_complete_logs(tmp_path: Path, closing: ExitStack) -> None:
    report = kill_both("both", tmp_path, units=2, closing=closing, rounds=1)
    assert report.stated > 100
    assert report.lost == report.duplicates == (0, 0)
    assert report.same_logs


@pytest.fixture(scope="module")
def apart(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[TwoStations, LossyLink]]:
    """Two stations with a cable between them, and one unit near the first."""
    with ExitStack() as closing:
        try:
            link = LossyLink(5, closing)
        except BusError as error:
            pytest.skip(str(error))
        first, second = (Place(one.address, one) for one in (link.station, link.units))
        two = two_stations(tmp_path_factory.mktemp("two"), (first, second), closing)
        two.start()
        two.start_unit("anna", two.first)
        two.wait_received(two.first)
        time.sleep(REPORTED_S)  # a standby that knows of no unit does not wait for one
        yield two, link


def test_standby_without_units_waits_for_an_operator(
    apart: tuple[TwoStations, LossyLink],
) -> None:
    two, link = apart
    link.set(DARK)
    wait_until(
        "it says that it is cut off",
        lambda: "probably cut off" in str(two.second.get("/health")["problems"]),
    )
    assert not two.second.leads()
    link.set(CLEAN)
    wait_until("the second follows again", two.second.follows)


def test_cut_cable_gives_two_leaders_and_its_repair_one(
    apart: tuple[TwoStations, LossyLink],
) -> None:
    two, link = apart
    two.start_unit("bert", two.second)
    two.wait_received(two.first)
    link.set(DARK)
    wait_until("the second leads too", two.second.leads)
    tell_everyone(two.first, "said at the first")
    tell_everyone(two.second, "said at the second")
    time.sleep(APART_S)
    assert two.first.leads()
    link.set(CLEAN)
    wait_until("the first follows", two.first.follows)
    wait_until("what was apart is told", lambda: "acted at first" in str(two.second.get("/alarms")))
    assert texts(two.second) == texts(two.first) == ["said at the second"]
    done = [entry for entry in two.second.get("/audit") if entry["action"] == "DoneApart"]
    assert len(done) == 1
    assert "said at the first" in done[0]["detail"]
    complete(two)
    end_and_compare(two, two.first)
