"""A replay of recorded console messages equals a replay that decides again, and the live state:
every field of a console at every second.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import msgspec
import pytest

from base_station.engine.log_feed import FolderFeed
from base_station.replay.playback import Archive
from base_station.replay.recomputed_player import RecomputedPlayer
from base_station.replay.recorded_player import RecordedPlayer
from base_station.storage.checkpoints import Checkpoints
from base_station.storage.db.known_people import KnownPerson
from base_station.views.wire import Snapshot
from shared.channels import OPERATOR, POSITION, Qos, backfilled_key
from shared.codec import decode, encode
from shared.mcap_log import DELTA_TOPIC, SNAPSHOT_TOPIC, is_derived
from shared.messages import OperatorAction
from shared.messages.station import CloseIncident, ReportProblem
from tests.rig import message_factory
from tests.rig.console_log import reader, with_console
from tests.rig.eventful_incident import incident
from tests.rig.live_station import LiveStation, Screen, make_pipeline
from tests.rig.pinned_walk import pinned_walk
from tests.rig.shown_replay import VIEW, people, plain, shown_at
from tests.rig.station_script import Record, Script

FINE = 1e-3  # of whatever unit: numbers are recorded to a millimetre


def station_people(person_id: str) -> KnownPerson:
    """As ``LiveStation`` knows them."""
    return KnownPerson(f"person {person_id}", photo_url=f"/photos/{person_id}")


def eventful() -> Script:
    """About everything, and a gap that a journal fills."""
    script = incident()
    script.records.pop()  # it is not closed yet
    late = [
        message_factory.position(script.header("FF-01", 100.0 + second), north_m=float(second))
        for second in range(40)
    ]
    for second in range(60):
        script.now_s += 1.0
        if 20 <= second < 60:
            script.record(backfilled_key("FF-01", POSITION.suffix), encode(late[second - 20]))
        if second == 30:
            script.act(ReportProblem("disk", "there is little room for {person p1}"))
        script.tick()
    script.act(CloseIncident("i1"))
    return script


def pinned() -> Script:
    return pinned_walk(first_s=60, between_s=20, after_s=10).script


def players(records: Sequence[Record], folder: Path) -> tuple[RecordedPlayer, RecomputedPlayer]:
    plain = [record for record in records if not is_derived(record[1])]

    def from_time(t_ns: int) -> Iterator[Record]:
        return (record for record in plain if record[0] >= t_ns)

    archive = Archive(from_time, Checkpoints(folder), make_pipeline)
    return (
        RecordedPlayer(reader(records), Screen(), people),
        RecomputedPlayer(archive, Screen(), people),
    )


def is_same(one: Any, other: Any) -> bool:
    """To as much as is recorded."""
    if isinstance(one, float) and isinstance(other, float):
        return abs(one - other) <= FINE
    if isinstance(one, dict) and isinstance(other, dict):
        return one.keys() == other.keys() and all(is_same(one[key], other[key]) for key in one)
    if isinstance(one, list) and isinstance(other, list):
        return len(one) == len(other) and all(map(is_same, one, other))
    return bool(one == other)


def differing(one: Any, other: Any, path: str = "") -> Iterator[str]:
    """The fields that differ, for whoever reads a failure."""
    if isinstance(one, dict) and isinstance(other, dict) and one.keys() == other.keys():
        for key in one:
            yield from differing(one[key], other[key], f"{path}.{key}")
    elif isinstance(one, list) and isinstance(other, list) and len(one) == len(other):
        for number, (here, there) in enumerate(zip(one, other, strict=True)):
            yield from differing(here, there, f"{path}[{number}]")
    elif not is_same(one, other):
        yield f"{path}: {one!r} and {other!r}"


@pytest.mark.parametrize("script", [eventful, pinned], ids=["eventful", "pinned"])
def test_recorded_console_equals_a_recomputed_replay(script: Any, tmp_path: Path) -> None:
    reported: Script = script()
    records = with_console(reported.records, make_pipeline())
    times = [t_ns for t_ns, key, _ in records if key in {DELTA_TOPIC, SNAPSHOT_TOPIC}]
    assert sum(key == SNAPSHOT_TOPIC for _, key, _ in records) >= 2
    recorded, recomputed = players(records, tmp_path)
    for t_ns in times:
        played, drawn = shown_at(recorded, t_ns)
        again, drawn_again = shown_at(recomputed, t_ns)
        assert list(differing(played, again)) == [], t_ns
        assert drawn == drawn_again, t_ns


def undisturbed(station: LiveStation) -> tuple[int, Snapshot]:
    """Time of an action, and the picture behind it with no other event in between: a tick may raise
    an alarm, and a message that waited during the action is one nanosecond later in the log.
    """
    while True:
        done = station.act(ReportProblem("disk", "little room"))
        snapshot = station.snapshot()
        if station.pipeline.state.t_ns == done.t_ns:
            return done.t_ns, snapshot


def test_recorded_console_equals_the_live_console(tmp_path: Path) -> None:
    """Through bus, threads and log of a real engine."""
    reported = incident()
    actions = [decode(OPERATOR, one[2]) for one in reported.records if one[1].endswith("/operator")]
    messages = [one for one in reported.records if "/up/" in one[1] or "/alert/" in one[1]][:600]
    live: list[tuple[int, Snapshot]] = []
    with LiveStation(tmp_path) as station:
        for action in actions[:11]:
            assert isinstance(action, OperatorAction)
            station.act(action.action, action.by)
        for number, (_, key, payload) in enumerate(messages):
            station.bus.publish(key, payload, Qos.LIVE)
            if number % 200 == 199:
                live.append(undisturbed(station))
        station.act(CloseIncident("i1"))
    feed = FolderFeed(station.recorder.folder)
    recorded = RecordedPlayer(feed.everything, Screen(), station_people)
    for t_ns, snapshot in live:
        played, _ = shown_at(recorded, t_ns)
        then, _ = plain(msgspec.structs.replace(snapshot, replay=VIEW), {})
        for one in (played, then):
            del one["now_ms"], one["health"]  # a tick may have come between the two
        assert list(differing(played, then)) == []
