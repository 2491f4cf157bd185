"""A replay of recorded console messages: where they are missing, and where the log is."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import pytest

from base_station.engine.console_recorder import ConsoleRecorder
from base_station.engine.ports import Trails
from base_station.replay.playback import Archive
from base_station.replay.recorded_player import RecordedPlayer
from base_station.replay.session import ReplaySession, ReplayWindow
from base_station.storage.db.known_people import KnownPerson, person_lookup
from base_station.views.wire import ReplayView, Snapshot
from shared.clock import NS_PER_MS, NS_PER_S, SystemClock
from shared.mcap_log import DELTA_TOPIC, SNAPSHOT_TOPIC, is_console
from shared.messages import EventKind
from shared.messages.station import Assign, CloseIncident, OpenIncident
from tests.rig.console_log import ListedLog, reader, with_console
from tests.rig.live_station import Screen, make_pipeline
from tests.rig.logged_walk import DURATION_S, archive, walk_with_mayday
from tests.rig.station_script import START_NS, Record, Script
from tests.rig.waiting import until

FROM_S, UNTIL_S = 40, 100
VIEW = ReplayView("i1", 0, 0, 0, 1.0, playing=False)
PEOPLE = person_lookup({"p1": KnownPerson("Ada", "blue", "leader", "/photo")})


def at(second: float) -> int:
    return START_NS + round(second * NS_PER_S)


def is_between(record: Record) -> bool:
    return at(FROM_S) < record[0] < at(UNTIL_S)


@pytest.fixture(scope="module")
def recorded() -> tuple[Record, ...]:
    return with_console(walk_with_mayday(), make_pipeline())


def player_of(records: Sequence[Record]) -> RecordedPlayer:
    return RecordedPlayer(reader(records), Screen(), PEOPLE)


def gone_to(player: RecordedPlayer, second: float) -> RecordedPlayer:
    for _ in player.seek(at(second)):
        pass
    return player


def shown(player: RecordedPlayer) -> Snapshot:
    assert not player.is_lost
    return player.snapshot(VIEW)[0]


def test_people_are_shown_with_present_names_and_the_log_has_none() -> None:
    script = Script()
    script.register("FF-01")
    script.act(Assign("FF-01", "p1", "", "", ""))
    script.act(OpenIncident("i1", "Mill Lane"))
    script.wait(70, lambda: script.position("FF-01", script.now_s, 0.0))
    script.event("FF-01", EventKind.MAYDAY)
    recorded = with_console(script.records, make_pipeline())
    assert any(b"{person p1}" in payload for _, key, payload in recorded if is_console(key))
    (unit,) = shown(gone_to(player_of(recorded), 70)).units
    assert unit.person is not None
    assert (unit.person.name, unit.person.crew, unit.person.photo_url) == ("Ada", "blue", "/photo")
    (alarm,) = shown(gone_to(player_of(recorded), 70)).alarms
    assert "Ada" in alarm.text


@pytest.mark.parametrize(
    ("second", "link"), [(40, "live"), (45, "live"), (51, "stale"), (71, "lost"), (99, "lost")]
)
def test_links_and_places_age_in_a_gap_of_the_log(
    recorded: Sequence[Record], second: int, link: str
) -> None:
    with_gap = [one for one in recorded if not is_between(one)]
    player = gone_to(player_of(with_gap), second)
    seen = shown(player)
    (unit,) = seen.units
    assert unit.link == link
    assert unit.position is not None
    grown_m = second - FROM_S if second - FROM_S >= 10 else 0
    before = shown(gone_to(player_of(with_gap), FROM_S)).units[0].position
    assert before is not None
    wider_m = unit.position.ellipse_major_m - before.ellipse_major_m
    assert wider_m == pytest.approx(grown_m, abs=1.5)
    if second - FROM_S > 5:
        assert seen.now_ms == at(second) // NS_PER_MS
        assert player.gap is not None
        assert (player.gap.from_ns, player.gap.until_ns) == (at(FROM_S), at(UNTIL_S))
    else:
        assert player.gap is None


def test_replay_continues_behind_a_gap(recorded: Sequence[Record]) -> None:
    with_gap = [one for one in recorded if not is_between(one)]
    player = gone_to(player_of(with_gap), 30)
    while player.advance(at(UNTIL_S + 5)):
        pass
    assert player.gap is None
    (unit,) = shown(player).units
    assert unit.link == "live"
    assert unit.position is not None
    assert unit.position.north_m == pytest.approx(UNTIL_S + 4.0, abs=0.1)


def test_log_that_ends_early_is_a_gap_too(recorded: Sequence[Record]) -> None:
    player = gone_to(player_of([one for one in recorded if one[0] <= at(FROM_S)]), 110)
    assert player.gap is not None
    assert (player.gap.from_ns, player.gap.until_ns) == (at(FROM_S), None)
    assert shown(player).units[0].link == "lost"


@pytest.mark.parametrize(
    "lost",
    [
        lambda record: is_console(record[1]),  # of an earlier version
        lambda record: is_console(record[1]) and is_between(record),
        lambda record: record[1] == SNAPSHOT_TOPIC and record[0] < at(1.5),
    ],
    ids=["everything", "a stretch", "the first keyframe"],
)
def test_stretch_without_console_messages_is_decided_again(
    recorded: Sequence[Record], lost: Callable[[Record], bool], tmp_path: Path
) -> None:
    records = [one for one in recorded if not lost(one)]
    assert gone_to(player_of(records), 70).is_lost
    source = replace(archive(walk_with_mayday(), tmp_path), console=reader(records))
    with session_of(source) as session:
        for second in (70, 20, 110):
            assert north_m(session, second) == pytest.approx(second - 1.0, abs=0.1)


def unreadable(record: Record) -> Record:
    t_ns, key, payload = record
    return t_ns, key, b'{"type":"delta","units":[{"new":1}]}' if key == DELTA_TOPIC else payload


@pytest.mark.parametrize("how", ["missing", "of another version"])
def test_replay_that_reaches_such_a_stretch_continues_by_deciding_again(
    recorded: Sequence[Record], how: str, tmp_path: Path
) -> None:
    records: list[Record] = []
    for one in recorded:
        if not (is_console(one[1]) and is_between(one)):
            records.append(one)
        elif how != "missing":
            records.append(unreadable(one))
    screen = Screen()
    source = replace(archive(walk_with_mayday(), tmp_path), console=reader(records))
    with session_of(source, screen) as session:
        session.seek(at(35))
        session.set_speed(50.0)
        session.play()
        until(lambda: not session.view().playing)
    deltas = [one for delta in screen.deltas for one in delta.units]
    snapshots = [one for snapshot in screen.resets for one in snapshot.units]
    seconds = {
        round(one.position.north_m) for one in (*deltas, *snapshots) if one.position is not None
    }
    assert any(FROM_S + 10 < second < UNTIL_S - 10 for second in seconds)


@pytest.mark.parametrize("second", [10, 70])
def test_recording_of_another_version_is_decided_again(
    recorded: Sequence[Record], second: int, tmp_path: Path
) -> None:
    others = [unreadable(one) for one in recorded]
    source = replace(archive(walk_with_mayday(), tmp_path), console=reader(others))
    with session_of(source) as session:
        assert north_m(session, second) == pytest.approx(second - 1.0, abs=0.1)


def test_full_disk_stops_recording_for_consoles_until_a_keyframe() -> None:
    script = Script()
    script.register("FF-01")
    log = ListedLog()
    recorder = ConsoleRecorder(script.pipeline, log)

    def walk(seconds: int) -> list[str]:
        del log.records[:]
        for _ in range(seconds):
            script.now_s += 1.0
            recorder.publisher.mark_changed(script.position("FF-01", script.now_s, 0.0))
            recorder.record()
        return [key for _, key, _ in log.records if not key.endswith("trail")]

    assert walk(3) == [], "no incident is open"
    script.act(OpenIncident("i1", "Mill Lane"))
    assert walk(3) == [SNAPSHOT_TOPIC, DELTA_TOPIC, DELTA_TOPIC]
    log.is_behind = True
    assert walk(3) == []
    log.is_behind = False
    assert walk(2) == [SNAPSHOT_TOPIC, DELTA_TOPIC]
    script.act(CloseIncident("i1"))
    assert walk(3) == [SNAPSHOT_TOPIC]


@contextmanager
def session_of(source: Archive, screen: Screen | None = None) -> Iterator[ReplaySession]:
    window = ReplayWindow("i1", START_NS, at(DURATION_S))
    session = ReplaySession(source, window, 1.0, screen or Screen(), PEOPLE, SystemClock())
    session.pause()
    try:
        yield session
    finally:
        session.close()


def north_m(session: ReplaySession, second: int) -> float:
    found: list[Snapshot] = []
    came = threading.Event()

    def take(snapshot: Snapshot, _: Trails) -> None:
        found.append(snapshot)
        came.set()

    session.seek(at(second))
    session.request_snapshot(take)
    assert came.wait(60.0)
    (unit,) = found[0].units
    assert unit.position is not None
    return unit.position.north_m
