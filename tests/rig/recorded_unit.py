"""A unit with a recording, and a station's fetching of it, step by step."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path

from base_station.unit_sync.recordings.transfer import Transfer, TransferRequest
from edge.clocks.station import StationClock
from edge.sample_codec.codec import SampleEncoder
from edge.sample_codec.descriptions import unit_sensor
from edge.sources.registry import open_source
from edge.storage.black_box.black_box import BlackBox
from edge.storage.black_box.server import RecordingServer
from edge.storage.data_folder import UnitDataFolder
from shared.clock import NS_PER_S, ManualClock, SystemClock

U = "FF-01"
BATCHES = 600
SECONDS = 4000  # of clock time that the recording takes: many segments


class RecordedUnit:
    """A unit with a black box and the server that gives it away."""

    def __init__(self, folder: Path) -> None:
        self.machine = ManualClock(utc_ns=time.time_ns() - SECONDS * NS_PER_S)
        self.folder = UnitDataFolder(folder)
        self.began_ns = self.machine.utc_ns()
        source = open_source("simulated:climbs-stairs?seed=3")
        raw = SampleEncoder(U, 7)
        description = raw.description(
            0, (unit_sensor("", source.description),), source="", tracker=""
        )
        box = BlackBox(self.folder.black_box, description, 10**9, self.machine)
        for _, batch in zip(range(BATCHES), source.batches(), strict=False):
            box.write(raw.messages(batch))
            while not box._waiting.empty():  # each is written at its own time
                time.sleep(0)
            self.machine.advance(SECONDS / BATCHES)
        box.close()
        (self.boot,) = self.folder.black_box.iterdir()
        self.folder.calibrations.mkdir()
        (self.folder.calibrations / "c1.toml").write_text("x = 1\n")
        self.server = RecordingServer(U, self.folder, StationClock(self.machine))
        self.linked = True
        self.spoil: Callable[[str, bytes], bytes] = lambda _, reply: reply
        self.questions: list[str] = []

    def ask(self, unit_id: str, question: str) -> bytes | None:
        what, _, parameters = question.partition("?")
        self.questions.append(what)
        if not self.linked or unit_id != U:
            return None
        replies = self.server.replies(f"muster/v1/{U}/recording/{what}", parameters, b"")
        reply = next(iter(replies), None)
        return None if reply is None else self.spoil(what, reply)

    def window(self, from_s: float = 0.0, to_s: float = SECONDS) -> TransferRequest:
        return TransferRequest(
            U, self.began_ns + round(from_s * NS_PER_S), self.began_ns + round(to_s * NS_PER_S)
        )


def begin(unit: RecordedUnit, folder: Path, wanted: TransferRequest | None = None) -> Transfer:
    return Transfer(unit.ask, folder, wanted or unit.window(), SystemClock())


def finish(fetch: Transfer, steps: int = 20_000) -> Transfer:
    for _ in range(steps):
        if fetch.state.is_over:
            break
        fetch.step()
    fetch.close()
    return fetch
