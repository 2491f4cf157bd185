"""Radio recordings: spans, audio of a window, deletion of old audio, erasure of a window."""

from __future__ import annotations

from io import BytesIO
from pathlib import Path

import av
import pytest
from mcap.reader import make_reader

from base_station.radio.opus import silence
from base_station.radio.packets import Packet, payload_of
from base_station.radio.radio_log import RadioLog
from base_station.radio.recorders import RadioRecorders
from shared.clock import NS_PER_MS, NS_PER_S, ManualClock
from shared.mcap_log import SegmentPolicy, SegmentWriter, audio_topic, segment_paths

NAME = "Tac-1"
T0_NS = 1_800_000_000 * NS_PER_S
MS_120 = 120 * NS_PER_MS
SPOKEN = [bytes((0x78, one)) + bytes(80) for one in range(6)]  # 20 ms each


def written(folder: Path, packets: list[tuple[float, bytes]], segment_s: float = 900.0) -> RadioLog:
    """Packets at seconds after ``T0_NS``."""
    writer = SegmentWriter(folder / NAME, SegmentPolicy(segment_s=segment_s))
    for at_s, data in packets:
        packet = Packet(T0_NS + round(at_s * NS_PER_S), data)
        writer.write(packet.t_ns, audio_topic(NAME), payload_of(packet))
    writer.close()
    return RadioLog(folder)


def silent(from_s: float, until_s: float) -> list[tuple[float, bytes]]:
    return [
        (from_s + 0.12 * number, silence(6)) for number in range(round((until_s - from_s) / 0.12))
    ]


def spoken(at_s: float) -> list[tuple[float, bytes]]:
    return [(at_s + 0.02 * number, data) for number, data in enumerate(SPOKEN)]


def seconds(spans: tuple[tuple[int, int], ...]) -> list[tuple[float, float]]:
    return [(round((a - T0_NS) / NS_PER_S, 2), round((b - T0_NS) / NS_PER_S, 2)) for a, b in spans]


def test_spans_of_recording_and_of_voice(tmp_path: Path) -> None:
    log = written(tmp_path, [*silent(0.0, 1.2), *spoken(1.2), *silent(1.32, 2.52), *spoken(9.0)])
    spans = log.spans(NAME, T0_NS, T0_NS + 60 * NS_PER_S)
    assert log.channels() == (NAME,)
    assert seconds(spans.recorded) == [(0.0, 2.52), (9.0, 9.12)]
    assert seconds(spans.voice) == [(1.2, 1.32), (9.0, 9.12)]
    within = log.spans(NAME, T0_NS + NS_PER_S, T0_NS + 2 * NS_PER_S)
    assert seconds(within.recorded) == [(1.0, 2.0)]
    assert seconds(log.spans("none", T0_NS, T0_NS + NS_PER_S).recorded) == []


def test_audio_of_a_window_has_its_length_and_each_packet_its_place(tmp_path: Path) -> None:
    """Also over a gap, and where a drift was corrected, packet by packet."""
    drifting = [(3.0 + 0.0202 * number, SPOKEN[number % 6]) for number in range(500)]
    log = written(tmp_path, [*spoken(1.0), *drifting, *spoken(20.0)])
    ogg = log.audio(NAME, T0_NS, T0_NS + 30 * NS_PER_S)
    at_s, found = 0.0, []
    with av.open(BytesIO(ogg), "r") as container:
        assert container.duration is not None
        assert container.duration / av.time_base == pytest.approx(30.0, abs=0.15)
        for packet in container.demux(audio=0):
            if packet.pts is not None and bytes(packet)[0] == SPOKEN[0][0]:
                assert packet.time_base is not None
                at_s = float((packet.pts) * packet.time_base)
                found.append(at_s)
    expected = [at for at, _ in (*spoken(1.0), *drifting, *spoken(20.0))]
    assert len(found) == len(expected)
    assert max(abs(a - b) for a, b in zip(found, expected, strict=True)) < 0.04


def test_other_readers_find_compressed_audio_in_the_log(tmp_path: Path) -> None:
    written(tmp_path, spoken(1.0))
    (path,) = segment_paths(tmp_path / NAME)
    with path.open("rb") as file:
        found = [
            (s.name, c.topic, m.log_time) for s, c, m in make_reader(file).iter_messages() if s
        ]
    assert found[0] == (
        "foxglove.CompressedAudio",
        f"foxglove/radio/{NAME}/audio",
        T0_NS + NS_PER_S,
    )
    assert len(found) == len(SPOKEN)


def test_audio_beyond_its_retention_is_deleted_segment_by_segment(tmp_path: Path) -> None:
    hours = [part for hour in range(6) for part in spoken(3_600.0 * hour)]
    log = written(tmp_path, hours, segment_s=60.0)
    clock = ManualClock(T0_NS + (720 + 3) * 3_600 * NS_PER_S + NS_PER_S)
    RadioRecorders({}, log, clock)._remove_old(None)  # type: ignore[arg-type]  # it is not read
    spans = log.spans(NAME, T0_NS, clock.utc_ns())
    assert [at for at, _ in seconds(spans.voice)] == [3_600.0 * hour for hour in (3, 4, 5)]


def test_erasure_of_a_window_leaves_its_surroundings(tmp_path: Path) -> None:
    log = written(tmp_path, [*spoken(1.0), *spoken(5.0), *spoken(9.0)])
    recorders = RadioRecorders({}, log, ManualClock(T0_NS))
    assert recorders.erase(T0_NS + 4 * NS_PER_S, T0_NS + 6 * NS_PER_S) == len(SPOKEN)
    spans = log.spans(NAME, T0_NS, T0_NS + 60 * NS_PER_S)
    assert [at for at, _ in seconds(spans.voice)] == [1.0, 9.0]
    for path in tmp_path.rglob("*"):
        assert path.is_dir() or SPOKEN[0] * 2 not in path.read_bytes()
