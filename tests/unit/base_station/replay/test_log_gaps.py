"""A gap of the log in a replay: time advances in it, and nothing in it looks current."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from base_station.replay.playback import Playback
from base_station.replay.record_gaps import RecordGap
from base_station.replay.session import ReplaySession, ReplayWindow
from base_station.storage.db.known_people import person_lookup
from base_station.views.wire import GapView
from shared.clock import NS_PER_MS, NS_PER_S, SystemClock
from tests.rig.live_station import Screen
from tests.rig.logged_walk import archive, walk_with_mayday
from tests.rig.shown_replay import requested_snapshot
from tests.rig.station_script import START_NS, Record
from tests.rig.waiting import until

FROM_S, UNTIL_S, END_S = 40, 100, 120  # the log has nothing between the first two


def at(second: float) -> int:
    return START_NS + round(second * NS_PER_S)


def with_hole() -> tuple[Record, ...]:
    return tuple(one for one in walk_with_mayday() if not at(FROM_S) < one[0] < at(UNTIL_S))


def gone_to(playback: Playback, second: float) -> Playback:
    for _ in playback.seek(at(second)):
        pass
    playback.show_unrecorded()
    return playback


@pytest.fixture
def playback(tmp_path: Path) -> Playback:
    return Playback(archive(with_hole(), tmp_path))


@pytest.mark.parametrize(
    ("second", "link"), [(40, "live"), (45, "live"), (51, "stale"), (71, "lost"), (99, "lost")]
)
def test_links_and_places_age_in_a_gap(playback: Playback, second: int, link: str) -> None:
    state = gone_to(playback, second).pipeline.state
    unit = state.units["FF-01"]
    assert unit.link == link
    assert state.t_ns == at(second)
    assert unit.place.fused is not None
    assert state.t_ns - unit.place.fused.t_meas_ns >= (second - FROM_S) * NS_PER_S
    assert not state.alarms, "nothing is decided of what is not known"
    is_in = second > FROM_S
    assert playback.gap == (RecordGap(at(FROM_S), at(UNTIL_S)) if is_in else None)


def test_decisions_behind_a_gap_are_those_without_a_seek_into_it(
    playback: Playback, tmp_path: Path
) -> None:
    plain = Playback(archive(with_hole(), tmp_path / "plain"))
    for second in (45, 75, 99):
        gone_to(playback, second)
    for second in (100, 101, 119):
        gone_to(playback, second)
        for _ in plain.seek(at(second)):
            pass
        assert playback.gap is None
        assert playback.pipeline.checkpoint() == plain.pipeline.checkpoint()
    assert gone_to(playback, 50).pipeline.state.units["FF-01"].link == "stale", "back into it"


def test_log_that_ends_early_or_begins_late_has_a_gap_too(tmp_path: Path) -> None:
    end = Playback(archive([one for one in with_hole() if one[0] <= at(FROM_S)], tmp_path))
    assert gone_to(end, 110).gap == RecordGap(at(FROM_S), None)
    assert end.pipeline.state.units["FF-01"].link == "lost"
    begin = Playback(archive([one for one in with_hole() if one[0] >= at(UNTIL_S)], tmp_path))
    assert gone_to(begin, 50).gap == RecordGap(0, at(UNTIL_S))
    assert gone_to(begin, 110).gap is None


def test_whole_log_has_no_gap(tmp_path: Path) -> None:
    playback = Playback(archive(walk_with_mayday(), tmp_path))
    for second in range(0, END_S, 3):
        assert gone_to(playback, second + 0.5).gap is None


@pytest.fixture
def screen() -> Screen:
    return Screen()


@pytest.fixture
def session(tmp_path: Path, screen: Screen) -> Iterator[ReplaySession]:
    window = ReplayWindow("i1", START_NS, at(END_S))
    session = ReplaySession(
        archive(with_hole(), tmp_path), window, 1.0, screen, person_lookup({}), SystemClock()
    )
    yield session
    session.close()


def test_seek_into_a_gap_is_reported(session: ReplaySession) -> None:
    session.pause()
    session.seek(at(97.7))
    seen = requested_snapshot(session)
    assert seen.now_ms == at(97.7) // NS_PER_MS
    assert [unit.link for unit in seen.units] == ["lost"]
    assert seen.replay is not None
    assert seen.replay.gap == GapView(at(FROM_S) // NS_PER_MS, at(UNTIL_S) // NS_PER_MS)


def test_replay_plays_through_a_gap(session: ReplaySession, screen: Screen) -> None:
    session.set_speed(25.0)  # a busy machine passes over a state of a second
    until(lambda: any(d.replay is not None and not d.replay.playing for d in screen.deltas))
    inside = [one for one in screen.deltas if one.replay is not None and one.replay.gap is not None]
    assert len({one.now_ms for one in inside}) > 3, "its clock goes on"
    links = [unit.link for one in inside for unit in one.units]
    assert links.index("stale") < links.index("lost")
    assert session.view().gap is None
    (unit,) = requested_snapshot(session).units
    assert unit.link == "live"
