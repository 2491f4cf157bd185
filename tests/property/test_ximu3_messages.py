"""Messages of an x-IMU3: read back as encoded; noise is never read as a message."""

from __future__ import annotations

import math
from contextlib import suppress

import pytest
from hypothesis import given
from hypothesis import strategies as st

from edge.sources.ximu3.messages import (
    ACCEL_FULL_SCALE_G,
    GYRO_FULL_SCALE_DPS,
    LONGEST,
    BatteryMessage,
    Button,
    Frames,
    Inertial,
    MagnetometerMessage,
    Notification,
    OtherMessage,
    TemperatureMessage,
    message_of,
)
from shared.errors import WireError
from shared.messages import BatteryState
from tests.rig.ximu3_device import at_rest, binary_message, text_message

TIMES = st.integers(0, 2**62)
RATES = st.floats(-GYRO_FULL_SCALE_DPS, GYRO_FULL_SCALE_DPS, width=32)
FORCES = st.floats(-ACCEL_FULL_SCALE_G, ACCEL_FULL_SCALE_G, width=32)
INERTIAL = st.builds(Inertial, TIMES, st.tuples(*[RATES] * 3), st.tuples(*[FORCES] * 3))


def only(reported: bytes) -> bytes:
    (frame,) = Frames().push(reported)
    return frame


# The manual's own examples, each at one second.
@pytest.mark.parametrize(
    ("reported", "meant"),
    [
        (
            b"I,1000000,0.0000,0.0000,0.0000,0.0000,0.0000,1.0000\r\n",
            Inertial(1000000, (0.0, 0.0, 0.0), (0.0, 0.0, 1.0)),
        ),
        (
            bytes.fromhex("C940420F0000000000" + "00000000" * 5 + "0000803F0A"),
            Inertial(1000000, (0.0, 0.0, 0.0), (0.0, 0.0, 1.0)),
        ),
        (b"M,1000000,1.0000,0.0000,0.0000\r\n", MagnetometerMessage(1000000, (1.0, 0.0, 0.0))),
        (
            bytes.fromhex("CD40420F00000000000000803F00000000000000000A"),
            MagnetometerMessage(1000000, (1.0, 0.0, 0.0)),
        ),
        (b"T,1000000,25.0000\r\n", TemperatureMessage(1000000, 25.0)),
        (b"T,1000000,180.0000\r\n", TemperatureMessage(1000000, 180.0)),
        (b"O,1000000,1.0000\r\n", Button(1000000, is_down=True)),
        (bytes.fromhex("CF40420F000000000000000000") + b"\n", Button(1000000, is_down=False)),
        (b"B,1000000,100.0000,4.2000,2.0000\r\n", BatteryMessage(1000000, 1.0, BatteryState.FULL)),
        (
            b"N,1000000,This is a notification message.\r\n",
            Notification(1000000, "This is a notification message.", is_error=False),
        ),
        (
            bytes.fromhex("C640420F0000000000") + b"This is an error message.\n",
            Notification(1000000, "This is an error message.", is_error=True),
        ),
        (b"W,1000000,100.0000,-50.0000\r\n", OtherMessage()),
        (b"Q,1000000,1.0000,0.0000,0.0000,0.0000\r\n", OtherMessage()),
        (b'{"ping":null}\r\n', OtherMessage()),
    ],
)
def test_examples_of_the_manual_are_read(reported: bytes, meant: object) -> None:
    assert message_of(only(reported)) == meant


@given(INERTIAL)
def test_binary_is_read_back_to_the_last_bit(meant: Inertial) -> None:
    reported = binary_message("I", meant.t_us, *meant.gyro_dps, *meant.accel_g)
    assert message_of(only(reported)) == meant


@given(INERTIAL)
def test_text_is_read_back_to_four_decimals(meant: Inertial) -> None:
    values = (*meant.gyro_dps, *meant.accel_g)
    message = message_of(only(text_message("I", meant.t_us, *values)))
    assert isinstance(message, Inertial)
    assert message.t_us == meant.t_us
    read = (*message.gyro_dps, *message.accel_g)
    assert all(math.isclose(a, b, abs_tol=6e-5) for a, b in zip(read, values, strict=True))


@pytest.mark.parametrize(
    ("reported", "why"),
    [
        (b"\r\n", "empty"),
        (b"I,1,0,0,0,0,0,1\n", "without its end"),
        (b"I,1,0,0,0,0,0\r\n", "5 values of 6"),
        (b"I,1,0,0,0,0,0,1,2\r\n", "7 values of 6"),
        (b"I,1,nan,0,0,0,0,1\r\n", "than numbers"),
        (b"I,1,1e3,0,0,0,0,1\r\n", "than numbers"),
        (b"I,1,1_0,0,0,0,0,1\r\n", "than numbers"),
        (b"I,-1,0,0,0,0,0,1\r\n", "begins otherwise"),
        (b"I,9223372036854775807,0,0,0,0,0,1\r\n", "never comes"),
        (b"i,1,0,0,0,0,0,1\r\n", "begins otherwise"),
        (b"I,1,2500,0,0,0,0,1\r\n", "2200 is the most"),
        (b"I,1,0,0,0,0,0,-31\r\n", "26.4 is the most"),
        (b"T,1,400\r\n", "degC"),
        (b"B,1,140,4,0\r\n", "140 %"),
        (b"I,1,0,0,\xff,0,0,1\r\n", "no text"),
        (binary_message("I", 5, 0, 0, 0, 0, 0, math.nan), "no number"),
        (binary_message("I", 5, 0, 0, 0, 0, 0, 1)[:-2] + b"\n", "half a number"),
        (b"\xc9\x01\xdb\x01\n", "escape"),
        (b"\xc9\x01\n", "begin otherwise"),
    ],
)
def test_bytes_of_no_message_are_refused_with_a_reason(reported: bytes, why: str) -> None:
    with pytest.raises(WireError, match=why):
        message_of(only(reported))


SOME = b"".join(at_rest(20)) + binary_message("I", 60_000, 1, 2, 3, 0.1, 0.2, 0.3)


@given(st.lists(st.integers(1, len(SOME) - 1), max_size=8))
def test_any_fragmentation_in_transit_changes_nothing(cuts: list[int]) -> None:
    frames, found, start = Frames(), [], 0
    for end in (*sorted(cuts), len(SOME)):
        found += frames.push(SOME[start:end])
        start = end
    assert found == Frames().push(SOME)


@given(st.data())
def test_mutated_bytes_cost_only_the_messages_that_they_hit(data: st.DataObject) -> None:
    """Bytes changed, lost or added in one place: every other message is still read."""
    at = data.draw(st.integers(0, len(SOME)))
    lost = data.draw(st.integers(0, 30))
    noise = data.draw(st.binary(max_size=30))
    reported = SOME[:at] + noise + SOME[at + lost :]
    read = []
    for frame in Frames().push(reported):
        try:
            message = message_of(frame)
        except WireError:
            continue
        if isinstance(message, Inertial):
            assert max(map(abs, message.gyro_dps)) <= 1.1 * GYRO_FULL_SCALE_DPS
            assert max(map(abs, message.accel_g)) <= 1.1 * ACCEL_FULL_SCALE_G
        read.append(message)
    before = SOME[:at].count(b"\r\n")
    meant = [message_of(frame) for frame in Frames().push(SOME)]
    assert read[: max(0, before - 1)] == meant[: max(0, before - 1)]
    after = max(0, len(Frames().push(SOME[at + lost :])) - 1)
    assert after == 0 or read[-after:] == meant[-after:]


@given(st.binary(max_size=4000), st.integers(1, 700))
def test_noise_is_split_and_never_kept(noise: bytes, piece: int) -> None:
    frames = Frames()
    for start in range(0, len(noise), piece):
        for frame in frames.push(noise[start : start + piece]):
            assert len(frame) <= max(LONGEST, piece) + LONGEST
            with suppress(WireError):
                message_of(frame)
