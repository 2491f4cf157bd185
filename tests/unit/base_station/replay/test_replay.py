"""A replay session: play, pause, seek, speed, and a console that follows it."""

from __future__ import annotations

import threading
from collections.abc import Callable, Collection, Iterable, Iterator
from dataclasses import replace
from itertools import count
from pathlib import Path

import msgspec
import pytest

from base_station.replay.playback import BURST, Archive
from base_station.replay.session import MOST_FLAWS, ReplaySession, ReplayWindow
from base_station.storage.checkpoints import Checkpoints
from base_station.storage.db.known_people import person_lookup
from base_station.views.wire import Snapshot, TrailPoint
from shared.channels import POSITION, backfilled_key
from shared.clock import NS_PER_MS, NS_PER_S, ManualClock, SystemClock
from shared.codec import encode
from shared.errors import ArchiveError, StoreError, UserError
from shared.messages.station import CloseIncident, OpenIncident, ReportProblem
from tests.rig import message_factory
from tests.rig.console_log import reader, with_console
from tests.rig.live_station import Screen, make_pipeline
from tests.rig.logged_walk import DURATION_S, MAYDAY_S, archive, walk_with_mayday
from tests.rig.shown_replay import requested_snapshot
from tests.rig.station_script import START_NS, Record, Script
from tests.rig.waiting import until


@pytest.fixture
def screen() -> Screen:
    return Screen()


@pytest.fixture(params=["decided again", "played as recorded"])
def source(tmp_path: Path, request: pytest.FixtureRequest) -> Archive:
    found = archive(walk_with_mayday(), tmp_path)
    if request.param == "decided again":
        return found
    return replace(found, console=reader(with_console(walk_with_mayday(), make_pipeline())))


@pytest.fixture
def session(source: Archive, screen: Screen) -> Iterator[ReplaySession]:
    window = ReplayWindow("i1", START_NS, START_NS + DURATION_S * NS_PER_S)
    session = ReplaySession(source, window, 1.0, screen, person_lookup({}), SystemClock())
    yield session
    session.close()


def at_s(session: ReplaySession) -> float:
    return session.view().at_ms / 1e3 - START_NS / NS_PER_S


def north_m(snapshot: Snapshot) -> float:
    (unit,) = snapshot.units
    assert unit.position is not None
    return unit.position.north_m


def test_seeking_forth_and_back_shows_that_instant(session: ReplaySession) -> None:
    session.pause()
    for second in (100, 30, 119, 61):
        session.seek(START_NS + second * NS_PER_S)
        seen = requested_snapshot(session)
        assert seen.replay is not None
        assert seen.replay.at_ms == START_NS // 10**6 + second * 1000
        assert north_m(seen) == pytest.approx(second - 1.0)
        assert bool(seen.alarms) == (second > MAYDAY_S)


def test_seek_is_a_new_picture_for_all_consoles(session: ReplaySession, screen: Screen) -> None:
    until(lambda: len(screen.resets) == 1)
    session.pause()
    session.seek(START_NS + 50 * NS_PER_S)
    until(lambda: len(screen.resets) == 2)
    assert north_m(screen.resets[-1]) == pytest.approx(49.0)


def test_lost_archive_stops_the_replay_which_continues_when_it_is_back(
    tmp_path: Path, screen: Screen
) -> None:
    records, away = with_console(walk_with_mayday(), make_pipeline()), threading.Event()
    read = reader(records)

    def read_archive(
        start_ns: int, end_ns: int | None, topics: Collection[str] | None
    ) -> Iterator[Record]:
        for record in read(start_ns, end_ns, topics):
            if away.is_set():
                raise ArchiveError("the archive is away")
            yield record

    source = replace(archive(walk_with_mayday(), tmp_path), console=read_archive)
    window = ReplayWindow("i1", START_NS, START_NS + DURATION_S * NS_PER_S)
    session = ReplaySession(source, window, 1.0, screen, person_lookup({}), SystemClock())
    try:
        until(lambda: len(screen.resets) == 1)
        away.set()
        session.seek(START_NS + 100 * NS_PER_S)
        until(lambda: session.view().flaws == ("the archive is away",))
        assert not session.view().playing
        assert north_m(requested_snapshot(session)) < 20.0, "it shows what it has"
        session.play()
        until(lambda: not session.view().playing, "it was asked in vain")
        away.clear()
        session.play()
        until(lambda: session.view().flaws == ())
        assert session.view().playing
        assert north_m(requested_snapshot(session)) == pytest.approx(99.0, abs=10.0)
    finally:
        session.close()


def test_long_seek_reports_its_target(
    session: ReplaySession, screen: Screen, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A console without messages for long shows its link as lost."""
    until(lambda: len(screen.resets) == 1)
    monkeypatch.setattr("base_station.replay.session.PAUSED_S", 0.0)
    monkeypatch.setattr("base_station.replay.playback.BURST", 1)
    monkeypatch.setattr("base_station.replay.recorded_player.BURST", 1)
    session.seek(START_NS + 100 * NS_PER_S)
    until(lambda: len(screen.resets) == 2)
    under_way = [delta.replay for delta in screen.deltas if delta.replay and delta.replay.seeking]
    assert len(under_way) > 10
    assert {replay.at_ms for replay in under_way} == {START_NS // 10**6 + 100_000}
    arrived = screen.resets[-1].replay
    assert arrived is not None
    assert not arrived.seeking


def test_replay_plays_to_the_end_and_stops_there(session: ReplaySession, screen: Screen) -> None:
    session.set_speed(1000.0)
    until(lambda: any(d.replay is not None and not d.replay.playing for d in screen.deltas))
    assert at_s(session) == DURATION_S
    assert any(alarm.rule == "mayday" for delta in screen.deltas for alarm in delta.alarms)
    assert [delta.seq for delta in screen.deltas] == list(range(1, len(screen.deltas) + 1))
    assert all(delta.replay is not None for delta in screen.deltas)


def test_messages_of_once_a_second_are_replayed(tmp_path: Path, screen: Screen) -> None:
    """Messages of a gap that the journal filled, and of problems of the station."""
    script, missed = Script(), []
    script.register("FF-01")
    script.act(OpenIncident("i1", "Mill Lane"))
    for second in range(DURATION_S):
        script.now_s += 1.0
        own = message_factory.position(script.header("FF-01"), north_m=float(second))
        if 40 <= second < 60:
            missed.append(own)
        else:
            script.say(own)
        if second == 80:
            script.act(ReportProblem("disk", "there is little room"))
            for late in missed:
                script.record(backfilled_key("FF-01", POSITION.suffix), encode(late))
        script.tick()
    clock = ManualClock()
    window = ReplayWindow("i1", START_NS, START_NS + DURATION_S * NS_PER_S)
    source = archive(script.records, tmp_path)
    session = ReplaySession(source, window, 1.0, screen, person_lookup({}), clock)
    until(lambda: len(screen.resets) == 1)
    session.seek(START_NS + 70 * NS_PER_S)
    until(lambda: len(screen.resets) == 2)
    clock.advance(15.0)
    until(lambda: at_s(session) == 85.0)
    clock.advance(1.0)
    until(lambda: at_s(session) == 86.0)
    requested_snapshot(session)
    session.close()
    reported = [delta.trails["FF-01"] for delta in screen.deltas if delta.trails]
    assert reported
    drawn = msgspec.json.decode(reported[-1], type=list[TrailPoint])
    filled = [point for point in drawn if 42.0 < point.t_ms / 1e3 - START_NS / NS_PER_S < 60.0]
    assert len(filled) >= 8
    problems = [delta.health.problems for delta in screen.deltas if delta.health]
    assert problems[-1] == ("there is little room",)


def test_play_at_the_end_begins_again(session: ReplaySession) -> None:
    session.pause()
    session.seek(START_NS + 10**6 * NS_PER_S)
    assert at_s(session) == DURATION_S, "behind the end is the end"
    session.play()
    until(lambda: 0.0 < at_s(session) < 60.0)


def test_replay_states_its_span_and_stays_within(session: ReplaySession) -> None:
    view = session.view()
    assert (view.start_ms, view.end_ms) == (
        START_NS // 10**6,
        START_NS // 10**6 + DURATION_S * 1000,
    )
    session.pause()
    session.seek(START_NS - 50 * NS_PER_S)
    assert at_s(session) == 0.0
    (unit,) = requested_snapshot(session).units
    assert unit.position is None


def test_seek_to_the_end_by_milliseconds_is_at_the_end_and_play_begins_again(
    tmp_path: Path, screen: Screen
) -> None:
    """Consoles send whole milliseconds, and hardly an incident is closed on one."""
    script = Script()
    script.act(OpenIncident("i1", "Mill Lane"))
    script.now_s = 7.000_345_678
    script.act(CloseIncident("i1"))
    window, source = ReplayWindow("i1", START_NS, script.t_ns), archive(script.records, tmp_path)
    session = ReplaySession(source, window, 1.0, screen, person_lookup({}), ManualClock())
    session.pause()
    session.seek(session.view().end_ms * NS_PER_MS)
    incident = requested_snapshot(session).incident
    session.play()
    requested_snapshot(session)
    again_s = at_s(session)
    session.close()
    assert incident is not None
    assert incident.closed_ms is not None
    assert again_s == 0.0


def test_pace_is_the_requested_speed(tmp_path: Path, screen: Screen) -> None:
    clock = ManualClock()
    window = ReplayWindow("i1", START_NS, START_NS + DURATION_S * NS_PER_S)
    source = archive(walk_with_mayday(), tmp_path)
    session = ReplaySession(source, window, 1.0, screen, person_lookup({}), clock)
    until(lambda: len(screen.resets) == 1)
    session.set_speed(32.0)
    clock.advance(1.0)
    until(lambda: at_s(session) == 32.0)
    session.pause()
    requested_snapshot(session)
    reported = len(screen.deltas)
    threading.Event().wait(0.3)
    assert at_s(session) == 32.0
    assert len(screen.deltas) <= reported + 3, "it rests"
    session.close()


def slow_archive(clock: ManualClock, folder: Path) -> Archive:
    """Reading a record takes a tenth of a second."""

    def slowly(t_ns: int) -> Iterable[Record]:
        for record in walk_with_mayday():
            if record[0] >= t_ns:
                clock.advance(0.1)
                yield record

    return Archive(slowly, Checkpoints(folder), make_pipeline)


def test_speed_beyond_this_machine_shows_the_passed_states(
    tmp_path: Path, screen: Screen, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("base_station.replay.session.DELTA_S", 0.001)
    monkeypatch.setattr("base_station.replay.playback.BURST", 1)
    clock = ManualClock()
    window = ReplayWindow("i1", START_NS, START_NS + DURATION_S * NS_PER_S)
    session = ReplaySession(
        slow_archive(clock, tmp_path), window, 1000.0, screen, person_lookup({}), clock
    )
    until(lambda: len(screen.resets) == 1)
    clock.advance(1.0)
    until(lambda: not session.view().playing)
    session.close()
    shown_ms = [delta.replay.at_ms for delta in screen.deltas if delta.replay]
    assert shown_ms == sorted(shown_ms)
    assert len(set(shown_ms)) >= DURATION_S


def test_long_seek_is_not_played_afterwards(tmp_path: Path, screen: Screen) -> None:
    """A seek to the next alarm shows the alarm, however long the station reads to get there."""
    clock = ManualClock()
    window = ReplayWindow("i1", START_NS, START_NS + DURATION_S * NS_PER_S)
    slow = slow_archive(clock, tmp_path)
    session = ReplaySession(slow, window, 1.0, screen, person_lookup({}), clock)
    until(lambda: len(screen.resets) == 1)
    session.seek(START_NS + MAYDAY_S * NS_PER_S)
    until(lambda: len(screen.resets) == 2)
    requested_snapshot(session)
    sought_s, clock_s = at_s(session), clock.monotonic_ns() / NS_PER_S
    session.close()
    assert clock_s > 10.0
    assert MAYDAY_S <= sought_s < MAYDAY_S + 1.0, "a record is looked at for flaws meanwhile"


def test_replay_closed_during_a_seek_ends(
    tmp_path: Path, screen: Screen, caplog: pytest.LogCaptureFixture
) -> None:
    """It does not continue from a place that was never shown."""
    clock = ManualClock()
    reached, go_on = threading.Event(), threading.Event()

    def waiting(t_ns: int) -> Iterator[Record]:
        for record in walk_with_mayday():
            if record[0] > START_NS + 90 * NS_PER_S and not reached.is_set():
                reached.set()
                go_on.wait(10.0)
            clock.advance(0.01)
            yield record

    window = ReplayWindow("i1", START_NS + 100 * NS_PER_S, START_NS + DURATION_S * NS_PER_S)
    source = Archive(waiting, Checkpoints(tmp_path), make_pipeline)
    session = ReplaySession(source, window, 1.0, screen, person_lookup({}), clock)
    assert reached.wait(10.0)
    session._closed.set()  # as ``close``, which would wait for it
    go_on.set()
    session.close()
    assert caplog.text == ""
    assert screen.resets == []


def test_endless_seek_is_given_up_for_another_and_for_closing(
    tmp_path: Path, screen: Screen
) -> None:
    """Meanwhile a console that joins is shown the target."""
    _, key, payload = walk_with_mayday()[-1]
    read = 0

    def endless(t_ns: int) -> Iterator[Record]:
        nonlocal read
        for second in count():
            read += 1
            clock.advance(0.001)
            if (at_ns := START_NS + second * NS_PER_S) >= t_ns:
                yield at_ns, key, payload

    def under_way() -> None:
        before = read
        session.seek(window.end_ns)
        until(lambda: read > before + 2 * BURST)
        joining = requested_snapshot(session).replay
        assert joining is not None
        assert joining.seeking

    clock = ManualClock()
    threads = set(threading.enumerate())
    window = ReplayWindow("i1", START_NS, START_NS + 10**9 * NS_PER_S)
    source = Archive(endless, Checkpoints(tmp_path), make_pipeline)
    session = ReplaySession(source, window, 1.0, screen, person_lookup({}), clock)
    session.pause()
    under_way()
    session.seek(START_NS + 10 * NS_PER_S)
    until(lambda: requested_snapshot(session).now_ms == START_NS // 10**6 + 10_000)
    under_way()
    session.close()
    assert session.is_over
    assert "replay" not in {thread.name for thread in set(threading.enumerate()) - threads}


def test_resumed_replay_continues_from_its_pause(tmp_path: Path, screen: Screen) -> None:
    clock = ManualClock()
    window = ReplayWindow("i1", START_NS, START_NS + DURATION_S * NS_PER_S)
    session = ReplaySession(
        archive(walk_with_mayday(), tmp_path), window, 1.0, screen, person_lookup({}), clock
    )
    session.pause()
    session.seek(START_NS + 40 * NS_PER_S)
    requested_snapshot(session)
    clock.advance(30.0)
    requested_snapshot(session)
    paused_s = at_s(session)
    clock.advance(30.0)
    session.play()
    requested_snapshot(session)
    resumed_s = at_s(session)
    clock.advance(10.0)
    until(lambda: at_s(session) >= 50.0)
    played_s = at_s(session)
    session.close()
    assert (paused_s, resumed_s, played_s) == (40.0, 40.0, 50.0)


@pytest.mark.parametrize("speed", [0.0, -1.0, float("nan"), float("inf"), 0.1])
def test_impossible_speed_is_refused_with_a_sentence(session: ReplaySession, speed: float) -> None:
    with pytest.raises(UserError, match="times real time"):
        session.set_speed(speed)


def test_empty_log_is_an_empty_picture(tmp_path: Path, screen: Screen) -> None:
    window = ReplayWindow("i1", START_NS, START_NS + NS_PER_S)
    session = ReplaySession(
        archive([], tmp_path), window, 1.0, screen, person_lookup({}), SystemClock()
    )
    assert requested_snapshot(session).units == ()
    session.close()


@pytest.mark.parametrize("playing", [False, True])
@pytest.mark.parametrize("saving", [False, True])
def test_person_erased_meanwhile_is_shown_no_more(
    tmp_path: Path, screen: Screen, playing: bool, saving: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The replay stays at its time, on the changed log."""
    monkeypatch.setattr("base_station.replay.playback.SAVED_APART", 10)
    own = Checkpoints(tmp_path / "own") if saving else None
    log = list(walk_with_mayday())
    changes = count()
    changed = [next(changes)]

    def watch() -> Callable[[], bool]:
        now = changed[0]
        return lambda: changed[0] != now

    source = Archive(lambda t_ns: (one for one in log if one[0] >= t_ns), Checkpoints(tmp_path),
                     make_pipeline, watch, own)  # fmt: skip
    window = ReplayWindow("i1", START_NS, START_NS + DURATION_S * NS_PER_S)
    clock = ManualClock()
    monkeypatch.setattr("base_station.replay.playback.BURST", 7)
    session = ReplaySession(source, window, 1.0, screen, person_lookup({}), clock)
    session.seek(START_NS + 100 * NS_PER_S)
    if not playing:
        session.pause()
    assert [alarm.text for alarm in requested_snapshot(session).alarms] == ["Mayday from Ada"]
    clock.advance(2.0)
    assert requested_snapshot(session).alarms != (), "what stays as it was is not read again"
    began = len(screen.resets)
    log[:] = [(t_ns, key, payload.replace(b"Ada", b"Eve")) for t_ns, key, payload in log]
    changed[0] = next(changes)
    clock.advance(2.0)
    until(lambda: len(screen.resets) > began, "everybody begins anew")
    shown = requested_snapshot(session)
    assert [alarm.text for alarm in shown.alarms] == ["Mayday from Eve"]
    assert at_s(session) >= 100.0 if playing else at_s(session) == 100.0
    clock.advance(2.0)
    requested_snapshot(session)
    assert len(screen.resets) == began + 1, "once"
    session.close()


def test_failed_replay_is_over(
    tmp_path: Path, screen: Screen, caplog: pytest.LogCaptureFixture
) -> None:
    def torn(_t_ns: int) -> Iterable[Record]:
        yield from walk_with_mayday()[:20]
        raise StoreError("the log cannot be read")

    window = ReplayWindow("i1", START_NS, START_NS + DURATION_S * NS_PER_S)
    source = Archive(torn, Checkpoints(tmp_path), make_pipeline)
    session = ReplaySession(source, window, 1000.0, screen, person_lookup({}), SystemClock())
    until(lambda: session.is_over)
    session.close()
    assert "the replay of i1 broke off" in caplog.text
    assert "the log cannot be read" in caplog.text


def test_hanging_disk_does_not_block_begin_and_end_of_replays(
    tmp_path: Path, screen: Screen, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Begin and end use the same table as all others."""
    monkeypatch.setattr("base_station.replay.session.GRACE_S", 0.1)
    comes_back, waited = threading.Event(), []

    def hanging(_t_ns: int) -> Iterable[Record]:
        waited.append(comes_back.wait(10.0))
        yield from walk_with_mayday()

    window = ReplayWindow("i1", START_NS, START_NS + DURATION_S * NS_PER_S)
    source = Archive(hanging, Checkpoints(tmp_path), make_pipeline)
    session = ReplaySession(source, window, 1.0, screen, person_lookup({}), SystemClock())
    session.pause()
    assert session.view().incident_id == "i1"
    session.close()
    assert waited == []
    comes_back.set()
    until(lambda: waited == [True])


def test_replay_continues_where_a_change_of_the_past_cannot_be_checked(
    tmp_path: Path, screen: Screen
) -> None:
    """A segment may be removed while it is checked."""
    looks = []

    def gone() -> bool:
        looks.append(1)
        raise FileNotFoundError(2, "No such file or directory")

    clock = ManualClock()
    window = ReplayWindow("i1", START_NS, START_NS + DURATION_S * NS_PER_S)
    records = list(walk_with_mayday())
    source = Archive(lambda _: iter(records), Checkpoints(tmp_path), make_pipeline, lambda: gone)
    session = ReplaySession(source, window, 1.0, screen, person_lookup({}), clock)
    until(lambda: len(screen.resets) == 1)
    for looked in range(1, 4):
        clock.advance(2.0)
        until(lambda n=looked: len(looks) >= n)  # type: ignore[misc]
    requested_snapshot(session)
    assert not session.is_over
    session.close()


def test_replay_reports_differences_of_its_log(tmp_path: Path, screen: Screen) -> None:
    """Also those passed on the way; a viewer does not see the terminal."""
    flaws = ["segment 2 of the log is missing"]
    source = replace(archive(walk_with_mayday(), tmp_path), flaws=lambda: flaws)
    window = ReplayWindow("i1", START_NS, START_NS + DURATION_S * NS_PER_S)
    session = ReplaySession(source, window, 1.0, screen, person_lookup({}), SystemClock())
    try:
        flaws.append("a part of the log cannot be read")
        shown = requested_snapshot(session).replay
        assert shown is not None
        assert shown.flaws == tuple(flaws)
        flaws.extend(f"part {number}" for number in range(1000))
        assert len(session.view().flaws) == MOST_FLAWS + 1, "it is said with every change"
        assert session.view().flaws[-1] == "and 982 more, which the terminal names"
    finally:
        session.close()
