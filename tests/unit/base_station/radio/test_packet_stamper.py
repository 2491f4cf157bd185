"""Audio of a source as packets: voice and silence, lost pieces, and a source that restarts."""

from __future__ import annotations

import numpy as np
import pytest

from base_station.radio.config import RadioConfig
from base_station.radio.opus import duration_ns, is_silence
from base_station.radio.packet_stamper import PacketStamper
from base_station.radio.sources import Sound
from shared.clock import NS_PER_MS, NS_PER_S
from tests.rig.tone_pattern import TONE_S, tone_pattern

PIECE = 960
BEGAN_NS = 1_000 * NS_PER_S


class Played:
    """A source that plays the tone pattern, of which each piece comes 30 ms after its end."""

    def __init__(self, config: RadioConfig) -> None:
        self.packets: list[tuple[int, bytes]] = []
        self._stamper = PacketStamper(config)

    def play(self, from_s: float, until_s: float, axis_s: float = 0.0) -> None:
        for first in range(round(from_s * 48_000), round(until_s * 48_000), PIECE):
            pcm = tone_pattern(BEGAN_NS, first, PIECE, 48_000).tobytes()
            end_ns = BEGAN_NS + (first + PIECE) * NS_PER_S // 48_000
            sound = Sound(pcm, first / 48_000 + axis_s, end_ns + 30 * NS_PER_MS)
            self.packets += self._stamper.push(sound)

    def gaps_s(self) -> list[float]:
        """Gaps of more than a millisecond."""
        ends = [t_ns + duration_ns(packet) for t_ns, packet in self.packets]
        begins = [t_ns for t_ns, _ in self.packets][1:]
        gaps = [(begin - end) / NS_PER_S for end, begin in zip(ends, begins, strict=False)]
        return [gap for gap in gaps if abs(gap) > 1e-3]


@pytest.fixture
def played() -> Played:
    return Played(RadioConfig("http://radio.example/tac"))


def test_voice_is_kept_with_its_lead_in_and_silence_is_a_few_bytes(played: Played) -> None:
    played.play(0.0, 20.0)
    assert played.gaps_s() == []
    assert played.packets[0][0] == pytest.approx(BEGAN_NS + 30 * NS_PER_MS, abs=NS_PER_MS)
    voice = [(t_ns, data) for t_ns, data in played.packets if not is_silence(data)]
    for second in range(0, 18, 2):
        begin_ns = BEGAN_NS + second * NS_PER_S
        kept_ns = sum(
            duration_ns(data) for t_ns, data in voice if 0 <= t_ns - begin_ns + NS_PER_S // 4 < 2e9
        )
        assert TONE_S < kept_ns / NS_PER_S < TONE_S + 0.9  # and half a second behind it
    silent = [data for _, data in played.packets if is_silence(data)]
    assert sum(map(len, silent)) < 14 * len(silent) + 1
    assert sum(map(duration_ns, silent)) > 8 * NS_PER_S


def test_audio_lost_in_transit_is_a_gap(played: Played) -> None:
    played.play(0.0, 5.0)
    played.play(8.0, 12.0)
    (gap_s,) = played.gaps_s()
    assert gap_s == pytest.approx(3.0, abs=0.13)  # the current block of 120 ms is lost, too
    assert played.packets[-1][0] == pytest.approx(BEGAN_NS + 12 * NS_PER_S, abs=NS_PER_S // 5)


def test_source_that_restarts_its_own_time_stays_on_the_clock(played: Played) -> None:
    played.play(0.0, 5.0, axis_s=500.0)
    played.play(5.0, 10.0, axis_s=-5.0)
    assert played.packets[-1][0] == pytest.approx(BEGAN_NS + 10 * NS_PER_S, abs=NS_PER_S // 5)
    assert all(abs(gap_s) < 0.13 for gap_s in played.gaps_s())


def test_known_delay_of_the_source_is_subtracted() -> None:
    late = Played(RadioConfig("http://radio.example/tac", delay_s=4.0))
    late.play(0.0, 5.0)
    expected_ns = BEGAN_NS + 30 * NS_PER_MS - 4 * NS_PER_S
    assert late.packets[0][0] == pytest.approx(expected_ns, abs=NS_PER_MS)


def test_level_below_the_limit_counts_as_silence() -> None:
    deaf = Played(RadioConfig("http://radio.example/tac", silence_dbfs=-12.0))
    deaf.play(0.0, 5.0)
    assert np.all([is_silence(data) for _, data in deaf.packets])
