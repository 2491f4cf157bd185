"""Messages of another tracker in the clock and the frame of the recorded run."""

from __future__ import annotations

import math

import pytest

from base_station.replay.rerun.recorded_runs import RecordedRun
from base_station.replay.rerun.retracked_run import RetrackedRun
from shared.channels import channel_of
from shared.clock import NS_PER_S
from shared.codec import encode
from shared.errors import RecordingError
from shared.geo import rotate
from shared.mcap_log import LogRecord
from shared.messages import Header, Message, Position
from tests.rig import message_factory

UTC_NS = 1_700_000_000 * NS_PER_S
SECONDS = 60


def header(second: float, utc_less_mono_ns: int = UTC_NS) -> Header:
    t_ns = round(second * NS_PER_S)
    return Header("FF-01", 7, 1 + round(5 * second), t_ns, t_ns + utc_less_mono_ns)


def walked(second: float, **changes: object) -> Position:
    """Ten metres north, then east, at one metre a second."""
    north_m, east_m = min(second, 10.0), max(second - 10.0, 0.0)
    place = {"north_m": north_m, "east_m": east_m, "down_m": 0.0, "distance_m": second}
    return message_factory.position(header(second), **{**place, **changes})


def records(messages: list[Message], log_less_sample_ns: int = UTC_NS) -> list[LogRecord]:
    return [
        (
            one.header.t_mono_ns + log_less_sample_ns,
            channel_of(one).key("FF-01"),
            encode(one),
        )
        for one in messages
    ]


def recorded(begin_s: int = 0, shift_s: float = 0.0) -> RecordedRun:
    """The recorded run at the station; its monotonic clock is ahead of the samples by
    ``shift_s``.
    """
    utc_ns = UTC_NS - round(shift_s * NS_PER_S)
    return RecordedRun(
        [round((second + shift_s) * NS_PER_S) for second in range(begin_s, SECONDS)],
        [
            Position.from_wire(
                message_factory.position(
                    header(second + shift_s, utc_ns),
                    north_m=min(second, 10.0),
                    east_m=max(second - 10.0, 0.0),
                    down_m=0.0,
                    distance_m=float(second),
                ).to_wire()
            )
            for second in range(begin_s, SECONDS)
        ],
        utc_ns,
    )


def statuses(begin_s: int = 0) -> list[Message]:
    return [message_factory.status(header(second)) for second in range(begin_s, SECONDS)]


def test_same_path_is_used_unchanged() -> None:
    then = recorded()
    run = RetrackedRun(records([*statuses(), *map(walked, range(SECONDS))]), then)
    assert not run.has_own_frame
    for position in then.positions:
        assert run.position(position) == position


def test_rotated_frame_is_laid_over_the_recorded_one() -> None:
    turn_rad = 0.7
    turned = []
    for second in range(5, SECONDS):
        here = walked(second)
        north_m, east_m = rotate(here.north_m - 5.0, here.east_m, turn_rad)
        velocity = rotate(1.0, 0.0, turn_rad)
        turned.append(
            walked(
                second,
                north_m=north_m,
                east_m=east_m,
                distance_m=second - 5.0,
                heading_rad=turn_rad,
                velocity_north_mps=velocity[0],
                velocity_east_mps=velocity[1],
            )
        )
    then = recorded()
    run = RetrackedRun(records([*statuses(5), *turned]), then)
    assert run.has_own_frame
    for position in then.positions:
        new = run.position(position)
        assert new is not None
        assert new.north_m == pytest.approx(position.north_m, abs=0.02)
        assert new.east_m == pytest.approx(position.east_m, abs=0.02)
        assert new.distance_m == pytest.approx(position.distance_m, abs=0.02)
        if position.header.t_mono_ns >= 5 * NS_PER_S:
            assert math.cos(new.heading_rad) == pytest.approx(1.0, abs=1e-3)
            assert new.velocity_east_mps == pytest.approx(0.0, abs=0.01)


@pytest.mark.parametrize("shift_s", [0.0, 12.5, 1234.0])
def test_samples_on_an_own_clock_are_aligned_by_the_statuses(shift_s: float) -> None:
    then = recorded(shift_s=shift_s)
    run = RetrackedRun(records([*statuses(), *map(walked, range(SECONDS))]), then)
    assert [run.position(one) for one in then.positions] == then.positions


def test_times_of_another_run_are_refused() -> None:
    messages = [*statuses(), *map(walked, range(SECONDS))]
    with pytest.raises(RecordingError, match="not those of this run"):
        RetrackedRun(records(messages, UTC_NS + 3600 * NS_PER_S), recorded())
    with pytest.raises(RecordingError, match="no positions"):
        RetrackedRun(records(statuses()), recorded())


def test_time_without_a_position_has_none() -> None:
    then = recorded()
    run = RetrackedRun(records([*statuses(), *map(walked, range(20))]), then)
    assert run.position(then.positions[22]) is not None
    assert run.position(then.positions[40]) is None
