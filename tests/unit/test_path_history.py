"""The thinned path of a unit: what is kept, where it breaks, what comes late, how it is saved."""

from __future__ import annotations

import math
from collections.abc import Callable

import msgspec
import numpy as np
import pytest

from base_station.fusion.path.history import PathHistory
from base_station.fusion.path.led import Led
from base_station.fusion.path.moved import Moved
from base_station.fusion.path.packed import CHUNK, MOST_CHUNKS
from base_station.fusion.path.points import BREAK, DOUBTFUL, RESTART
from base_station.fusion.path.straight import OFF_M
from base_station.fusion.port import Estimate, PlaceFix, Start
from shared.clock import NS_PER_S
from shared.messages import Header, Position
from shared.quality import Quality

SECONDS = (MOST_CHUNKS + 16) * CHUNK
MakePosition = Callable[[], Position]


@pytest.fixture
def at(make_position: MakePosition) -> Callable[..., Position]:
    def make(t_s: float, north_m: float, boot_id: int = 1, **changes: object) -> Position:
        header = Header("FF-01", boot_id, 1, round(t_s * NS_PER_S))
        changes = {"north_m": north_m, "east_m": 0.0, "quality": Quality.GOOD} | changes
        return msgspec.structs.replace(make_position(), header=header, **changes)

    return make


def walked(at: Callable[..., Position], seconds: int, mps: float = 1.0) -> PathHistory:
    history = PathHistory()
    for tenth in range(seconds * 5):
        history.note(at(tenth / 5, mps * tenth / 5), round(tenth / 5 * NS_PER_S), jumped=False)
    return history


def test_a_point_a_metre_and_the_newest_place(at: Callable[..., Position]) -> None:
    arrays = walked(at, 100).arrays()
    assert 90 <= len(arrays) <= 110
    assert arrays.own_m[-1, 0] == pytest.approx(99.8)
    assert arrays.t_ns[-1] == round(99.8 * NS_PER_S)
    assert arrays.moving_s.sum() == pytest.approx(99.8)
    assert (np.diff(arrays.t_ns) > 0).all()


def test_somebody_at_rest_leaves_a_point_now_and_then(at: Callable[..., Position]) -> None:
    arrays = walked(at, 120, mps=0.0).arrays()
    assert 10 <= len(arrays) <= 15
    assert arrays.moving_s.sum() == 0.0


def test_nobody_was_elsewhere_between_two_points(at: Callable[..., Position]) -> None:
    """Corners, rests and other paces: a straight line in time is near where somebody was."""
    rng, history = np.random.default_rng(5), PathHistory()
    place, velocity, times, places = np.zeros(2), np.zeros(2), [], []
    for step in range(3000):
        if rng.random() < 0.05:
            velocity = rng.normal(0.0, 0.8, 2) * (rng.random() < 0.7)
        place = place + 0.2 * velocity
        position = at(0.2 * step, float(place[0]), east_m=float(place[1]))
        history.note(position, position.header.t_mono_ns, jumped=False)
        times.append(position.header.t_mono_ns)
        places.append(place)
    arrays = history.arrays()
    off = [
        np.interp(times, arrays.t_ns, arrays.own_m[:, axis]) - np.array(places)[:, axis]
        for axis in (0, 1)
    ]
    assert np.percentile(np.abs(off), 95.0) < OFF_M
    assert len(arrays) < 0.2 * len(times)


def test_a_foot_that_goes_by_fits_and_starts_is_a_walk(at: Callable[..., Position]) -> None:
    """Strides of 1.3 m: six tenths of each the foot stands."""
    history = PathHistory()
    for tenth in range(3000):
        strides, part = divmod(tenth / 5, 1.1)
        north_m = 1.3 * (strides + np.clip((part - 0.6) / 0.45, 0.0, 1.0))
        history.note(at(tenth / 5, float(north_m)), round(tenth / 5 * NS_PER_S), jumped=False)
    assert len(history.arrays()) < 1.05 * 600.0 / 1.1 * 1.3


def test_breaks_and_doubts_stand_where_they_were(at: Callable[..., Position]) -> None:
    history = PathHistory()
    for t_s, north_m, boot_id, jumped in (
        (0.0, 0.0, 1, False),
        (1.0, 0.2, 1, False),
        (2.0, 50.0, 1, True),
        (3.0, 0.0, 2, False),
    ):
        history.note(at(t_s, north_m, boot_id), round(t_s * NS_PER_S), jumped)
    history.note(at(4.0, 0.1, 2, quality=Quality.DEGRADED), 4 * NS_PER_S, jumped=False)
    arrays = history.arrays()
    flags = arrays.flags.tolist()
    assert arrays.moving_s.sum() == 2.0, "how long a jump took nobody knows"
    assert flags.count(BREAK) == 1
    assert flags.count(RESTART) == 1
    assert flags[-1] == DOUBTFUL


def test_it_is_written_out_and_read_back_the_same(at: Callable[..., Position]) -> None:
    history = walked(at, 600)
    history.fix(PlaceFix(0, 1.5, -2.5, 0.0, 3.0, None), 7 * NS_PER_S)
    history.begin_with(Start(1.0, 2.0, 0.0, 0.1, 0.5, 0.2))
    again = msgspec.msgpack.decode(msgspec.msgpack.encode(history), type=PathHistory)
    assert again == history
    assert history.packed
    one, two = again.arrays(), history.arrays()
    assert np.array_equal(one.own_m, two.own_m)
    assert np.array_equal(one.fix_m, two.fix_m)


def test_a_long_path_is_thinned_where_it_is_old(at: Callable[..., Position]) -> None:
    history = PathHistory()
    for second in range(SECONDS):
        history.note(at(float(second), 1.1 * second), second * NS_PER_S, jumped=False)
    arrays = history.arrays()
    assert arrays.t_ns[0] == 0
    assert arrays.t_ns[-1] == (SECONDS - 1) * NS_PER_S
    assert arrays.moving_s.sum() == pytest.approx(SECONDS - 1)
    apart_s = np.diff(arrays.t_ns) / NS_PER_S
    assert apart_s[: 8 * CHUNK].mean() == pytest.approx(2.0, rel=0.02)
    assert (apart_s[-MOST_CHUNKS * CHUNK :] == 1.0).all()


def test_a_heading_of_many_turns_breaks_nothing(at: Callable[..., Position]) -> None:
    history = PathHistory()
    for second in range(3 * CHUNK):
        position = at(second, float(second), heading_rad=math.tau * 60_000.0)
        history.note(position, second * NS_PER_S, jumped=False)
    assert history.packed


def test_fixes_close_by_are_one(at: Callable[..., Position]) -> None:
    history = walked(at, 10)
    for tenth in range(50):
        history.fix(PlaceFix(0, 1.0, 2.0, 0.0, 3.0, None), round(tenth / 5 * NS_PER_S))
    assert len(history.arrays().fix_t_ns) == 5


def test_what_comes_late_fills_a_gap(at: Callable[..., Position]) -> None:
    history = PathHistory()
    for t_s in (0, 1, 2, 22, 23):
        history.note(at(float(t_s), 1.0 * t_s), t_s * NS_PER_S, jumped=False)
    before = history.arrays()
    fill(history, at(12.0, 12.0))
    fill(history, at(12.5, 12.5))
    fill(history, at(17.0, 17.0, quality=Quality.DEGRADED))
    fill(history, at(15.0, 15.0, boot_id=9))
    after = history.arrays()
    assert len(after) == len(before) + 2
    row = after.own_m[:, 0].tolist().index(12.0)
    assert after.flags[row : row + 2].tolist() == [0, DOUBTFUL]
    assert after.down_m[row] == -12.0, "as it was estimated for that time"
    assert after.moving_s[row] == pytest.approx(10.0), "half of the way"
    assert after.moving_s.sum() == pytest.approx(before.moving_s.sum())


def fill(history: PathHistory, position: Position) -> None:
    """The wearer climbed a metre a second."""
    t_ns = position.header.t_mono_ns
    down_m = -t_ns / NS_PER_S
    place = position.north_m, position.east_m, down_m, 0.5, 0.5, 0.5
    estimate = Estimate(t_ns, *place, 0.0, 0.0, 0.1, Quality.GOOD, "", None)
    history.fill(position, t_ns, estimate, 0)


def test_a_run_of_which_the_end_was_heard_first_begins_where_it_began(
    at: Callable[..., Position],
) -> None:
    """An hour of the journal, the newest first, while the wearer walks on."""
    history = PathHistory()
    history.begin_with(Start(0.0, 0.0, 0.0, 0.0, 0.5, 0.2))
    heard_s = 3600
    for second in range(240):
        history.note(at(heard_s + second, heard_s + second), (heard_s + second) * NS_PER_S, False)
        for late_s in range(heard_s - 15 * second, heard_s - 15 * (second + 1), -1):
            fill(history, at(late_s, late_s))
    arrays = history.arrays()
    assert history.begin_ns == history.boot_begin_ns == 2 * NS_PER_S
    assert history.start_ns == history.begin_ns, "nobody had been heard when that was said"
    assert np.diff(arrays.t_ns).max() <= 2 * NS_PER_S
    assert (np.diff(arrays.t_ns) > 0).all()
    assert arrays.moving_s.sum() == pytest.approx(3600 + 239 - 2)
    for second in range(400):
        history.note(at(3840 + second, 3840 + second), (3840 + second) * NS_PER_S, False)
    assert len(history.points) <= 2 * CHUNK, "packed once nothing comes late any more"


def test_a_run_that_was_heard_late_begins_after_the_one_before(
    at: Callable[..., Position],
) -> None:
    history = PathHistory()
    history.note(at(0.0, 5.0), 0, jumped=False)
    history.note(at(60.0, 30.0, boot_id=2), 60 * NS_PER_S, jumped=False)
    history.note(at(61.0, 31.0, boot_id=2), 61 * NS_PER_S, jumped=False)
    history.begin_with(Start(1.0, 2.0, 0.0, 0.1, 0.5, 0.2))
    for late_s in (50.0, 40.0, 45.0):
        fill(history, at(late_s, late_s - 30.0, boot_id=2))
    arrays = history.arrays()
    assert arrays.own_m[:, 0].tolist() == [5.0, 10.0, 15.0, 20.0, 30.0, 31.0]
    assert np.flatnonzero(arrays.flags & RESTART).tolist() == [1]
    assert history.start_ns == 40 * NS_PER_S


def test_what_was_before_an_incident_is_not_brought_back(at: Callable[..., Position]) -> None:
    history = PathHistory()
    history.note(at(60.0, 60.0), 60 * NS_PER_S, jumped=False)
    history.begin_incident(60 * NS_PER_S, 30 * NS_PER_S)
    fill(history, at(20.0, 20.0))
    assert history.begin_ns == 60 * NS_PER_S
    fill(history, at(40.0, 40.0))
    assert history.begin_ns == 40 * NS_PER_S


def test_a_moved_frame_moves_what_is_of_the_frame_only(at: Callable[..., Position]) -> None:
    history = walked(at, 300)
    history.fix(PlaceFix(0, 10.0, 0.0, 0.0, 3.0, None), NS_PER_S)
    history.begin_with(Start(10.0, 0.0, 1.0, 0.0, 0.5, 0.2))
    before = history.arrays()
    history.reframe(math.pi / 2.0, 1.0, 2.0, 3.0)
    after = history.arrays()
    assert np.array_equal(after.own_m, before.own_m)
    assert after.fix_m[0].tolist() == pytest.approx([1.0, 12.0], abs=1e-3)
    assert after.down_m == pytest.approx(before.down_m + 3.0), "packed or not"
    start = history.start
    assert start is not None
    assert (start.north_m, start.east_m, start.down_m) == pytest.approx((1.0, 12.0, 4.0))
    assert start.heading_rad == pytest.approx(math.pi / 2.0)


def test_a_frame_that_is_moved_twice_moves_whatever_was_packed_when(
    at: Callable[..., Position],
) -> None:
    history, place = PathHistory(), Moved()
    moves = {400: Moved(0.5, 10.0, -4.0, 3.0), 800: Moved(-0.2, 1.0, 2.0, -5.0)}
    for second in range(1200):
        if second in moves:
            history.reframe(*msgspec.structs.astuple(moves[second]))
            place = place.and_then(moves[second])
        history.note(at(float(second), float(second)), second * NS_PER_S, jumped=False)
        north_m, east_m = place.place(float(second), 5.0)
        stds_m = 1.0, 1.0, 1.0
        shown = Estimate(
            0, north_m, east_m, place.down_m, *stds_m, 0.0, 0.0, 0.1, Quality.GOOD, "", None
        )
        history.show(shown, None)
    assert len(history.packed.chunks) > 4
    arrays = history.arrays()
    north_m, east_m = moves[800].place(*moves[400].place(1000.0, 5.0))
    row = int(np.searchsorted(arrays.t_ns, 1000 * NS_PER_S))
    assert arrays.shown_m[row].tolist() == pytest.approx([north_m, east_m], abs=0.05)
    expected_m = [place.place(own_north_m, 5.0) for own_north_m in arrays.own_m[:, 0].tolist()]
    assert arrays.shown_m == pytest.approx(np.array(expected_m), abs=0.05)
    assert arrays.down_m == pytest.approx(-2.0, abs=0.02)


def test_where_a_run_led_is_shown_there_and_what_was_before_it_stays(
    at: Callable[..., Position],
) -> None:
    """Packed or not, in a frame that has moved since."""
    history = walked(at, 800)
    history.reframe(0.4, 3.0, -2.0, 1.5)
    before, begin_ns = history.arrays(), 100 * NS_PER_S
    assert history.packed
    assert history.packed.begin < begin_ns // 1_000_000
    history.lead(Led(begin_ns, 50.0, -20.0, 0.6, 0.8, 2.5))
    after = history.arrays()
    run = before.t_ns >= begin_ns
    own_m = before.own_m[run]
    assert np.array_equal(after.shown_m[~run], before.shown_m[~run])
    assert np.array_equal(after.down_m[~run], before.down_m[~run])
    north_m = 50.0 + 0.6 * own_m[:, 0] - 0.8 * own_m[:, 1]
    east_m = -20.0 + 0.8 * own_m[:, 0] + 0.6 * own_m[:, 1]
    assert after.shown_m[run] == pytest.approx(np.column_stack((north_m, east_m)), abs=0.03)
    assert after.down_m[run] == pytest.approx(before.down_m[run] + 2.5, abs=0.011)
    assert np.array_equal(after.own_m, before.own_m)


def test_fixes_that_lie_elsewhere_move_in_the_frame_as_it_is_now(
    at: Callable[..., Position],
) -> None:
    history = walked(at, 20)
    assert not history.move_fixes(0.3, 1.0, 2.0)
    for second in range(0, 800, 2):
        history.fix(PlaceFix(0, 0.1 * second, 5.0, 0.0, 3.0, None), second * NS_PER_S)
    history.reframe(0.4, 3.0, -2.0, 0.0)
    before = history.arrays()
    assert history.fixes.packed
    assert history.move_fixes(-0.7, 10.0, 4.0)
    assert history.is_refixed
    after = history.arrays()
    expected_m = [Moved(-0.7, 10.0, 4.0).place(*place_m) for place_m in before.fix_m.tolist()]
    assert after.fix_m == pytest.approx(np.array(expected_m), abs=0.04)
    assert np.array_equal(after.shown_m, before.shown_m)
    assert not after.shown_std_m.any(), "what was estimated with them tells nothing"


def test_what_is_undone_is_where_it_was() -> None:
    move = Moved(0.8, 30.0, -7.0, 2.0)
    assert move.undone().place(*move.place(4.0, 9.0)) == pytest.approx((4.0, 9.0))
    same = msgspec.structs.astuple(move.and_then(move.undone()))
    assert same == pytest.approx((0.0,) * 4, abs=1e-9)


def test_times_that_go_back_stay_apart_and_in_order(at: Callable[..., Position]) -> None:
    history = PathHistory()
    assert (history.begin_ns, history.end_ns, history.shown_m) == (None, None, None)
    for t_s in (100, 20, 21, 22, 101):
        history.note(at(float(t_s), 2.0 * t_s), t_s * NS_PER_S, jumped=False)
    times_ns = history.arrays().t_ns
    assert (np.diff(times_ns) > 0).all()
    assert (times_ns[0], times_ns[-1]) == (100 * NS_PER_S, 101 * NS_PER_S)


def test_trimmed_it_begins_later(at: Callable[..., Position]) -> None:
    history = walked(at, 400)
    for second in range(0, 400, 2):
        history.fix(PlaceFix(0, 10.0, 0.0, 0.0, 3.0, None), second * NS_PER_S)
    history.begin_incident(400 * NS_PER_S, 200 * NS_PER_S)
    assert history.begin_ns == pytest.approx(200 * NS_PER_S, abs=2 * NS_PER_S)
    assert history.arrays().fix_t_ns.min() >= 200 * NS_PER_S
    history.begin_incident(10**18, 10**18)
    assert history.begin_ns is None
    assert len(history.arrays().fix_t_ns) == 0
    assert len(history.arrays()) == 0


ODD_NS = 400_001  # of a millisecond: packed times have none


def two_runs(at: Callable[..., Position], seconds: int) -> PathHistory:
    """Half a minute, and as long as that from a minute on; a fix every two seconds."""
    history = PathHistory()
    for boot_id, begin_s, lasted_s in ((1, 0, 30), (2, 60, seconds)):
        for second in range(begin_s, begin_s + lasted_s):
            t_ns = second * NS_PER_S + ODD_NS
            history.note(at(float(second), 1.0 * second, boot_id), t_ns, jumped=False)
            history.fix(PlaceFix(0, 10.0, 0.0, 0.0, 3.0, None), t_ns)
    return history


@pytest.mark.parametrize("seconds", [30, 600], ids=["as it is", "packed"])
def test_an_incident_begins_with_the_run_that_goes_on_in_it(
    at: Callable[..., Position], seconds: int
) -> None:
    history = two_runs(at, seconds)
    history.begin_incident((60 + seconds) * NS_PER_S, 0)
    assert bool(history.packed) is (seconds == 600)
    arrays = history.arrays()
    assert arrays.own_m[0, 0] == 60.0, "all of it"
    assert arrays.fix_t_ns[0] == 60 * NS_PER_S
    assert len(history.arrays()) >= seconds - 1


def test_a_run_that_was_over_before_an_incident_is_no_part_of_its_path(
    at: Callable[..., Position],
) -> None:
    history = two_runs(at, 600)
    history.begin_incident(700 * NS_PER_S, 0)
    assert history.begin_ns is not None
    assert history.note(at(720.0, 0.0, boot_id=3), 720 * NS_PER_S, jumped=False)
    assert history.begin_ns == history.end_ns == 720 * NS_PER_S
    assert not history.fixes
    assert not history.note(at(721.0, 0.0, boot_id=3), 721 * NS_PER_S, jumped=False)
    assert not history.note(at(722.0, 0.0, boot_id=4), 722 * NS_PER_S, jumped=False)
    assert history.begin_ns == 720 * NS_PER_S, "what is of the incident stays"
    assert np.count_nonzero(history.arrays().flags & RESTART) == 1


def test_a_start_is_of_the_path_as_long_as_its_run_is(at: Callable[..., Position]) -> None:
    start, history, held = Start(1.0, 2.0, 0.0, 0.1, 0.5, 0.2), PathHistory(), []
    history.begin_with(start)
    history.note(at(1.0, 0.0), NS_PER_S, jumped=False)
    history.begin_incident(2 * NS_PER_S, 2 * NS_PER_S)
    history.note(at(3.0, 1.0), 3 * NS_PER_S, jumped=False)
    held.append(history.start_in_path)
    history.note(at(4.0, 0.0, boot_id=2), 4 * NS_PER_S, jumped=False)
    held.append(history.start_in_path)
    history.begin_incident(5 * NS_PER_S, 2 * NS_PER_S)
    held.append(history.start_in_path)
    history.begin_with(start)
    held.append(history.start_in_path)
    history.note(at(6.0, 0.0, boot_id=3), 6 * NS_PER_S, jumped=False)
    held.append(history.start_in_path)
    assert held == [start, start, None, start, None]
    assert history.start == start, "a receiver that stays where it is stands there whatever runs"


def test_a_run_that_seems_to_begin_before_the_last_one_ended_begins_behind_it(
    at: Callable[..., Position],
) -> None:
    """The messages of the first were held up on their way, and its clock is taken to be late."""
    history = PathHistory()
    for second in range(10):
        history.note(at(float(second), 1.0 * second), second * NS_PER_S, jumped=False)
    history.note(at(7.0, 0.0, boot_id=2), 7 * NS_PER_S, jumped=False)
    history.begin_with(Start(1.0, 2.0, 0.0, 0.1, 0.5, 0.2))
    arrays = history.arrays()
    (restart,) = np.flatnonzero(arrays.flags & RESTART)
    assert arrays.t_ns[restart] == history.start_ns == history.boot_begin_ns
    history.lead(Led(history.boot_begin_ns, 50.0, -20.0, 1.0, 0.0, 0.0))
    assert history.arrays().shown_m[restart - 1].tolist() == [0.0, 0.0]


def test_an_anchor_on_another_world_saturates_and_does_not_wrap(
    at: Callable[..., Position],
) -> None:
    history = walked(at, 20)
    for _ in range(3):
        history.reframe(1.0, 1e300, -1e12, 2e6)
    arrays = history.arrays()
    assert arrays.down_m[0] > 2e6
    assert np.isfinite(arrays.shown_m).all()
