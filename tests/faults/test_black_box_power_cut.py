"""A power cut of a unit while it records: at most a second of samples is lost."""

from __future__ import annotations

import os
import shutil
import time
from pathlib import Path

import pytest

from edge.sample_codec.codec import SampleEncoder
from edge.sample_codec.descriptions import unit_sensor
from edge.sources.black_box import BlackBoxSource
from edge.sources.registry import open_source
from edge.storage.black_box.black_box import BlackBox
from shared.clock import NS_PER_S, SystemClock
from shared.mcap_log import segment_paths

CUTS = 4
EVERY_S = 0.8


class Disk:
    """Contents of a disk after a power cut: the synced parts of files, and the synced names."""

    def __init__(self) -> None:
        self._fsync = os.fsync
        self._bytes: dict[Path, int] = {}
        self._names: set[Path] = set()

    def fsync(self, descriptor: int) -> None:
        path = Path(f"/proc/self/fd/{descriptor}").resolve()
        names, size = list(path.iterdir()) if path.is_dir() else [], path.stat().st_size
        self._fsync(descriptor)
        self._names |= set(names)
        self._bytes[path] = size

    def cut(self, folder: Path, to: Path) -> None:
        """A copy of the black box whose folder was there before."""
        to.mkdir()
        for boot in (one for one in folder.iterdir() if one in self._names):
            (to / boot.name).mkdir()
            for path in (one for one in segment_paths(boot) if one in self._names):
                shutil.copy(path, to / boot.name)
                os.truncate(to / boot.name / path.name, self._bytes.get(path, 0))


def test_at_most_a_second_of_samples_is_lost_with_the_power(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    disk, folder = Disk(), tmp_path / "black_box"
    folder.mkdir()
    monkeypatch.setattr(os, "fsync", disk.fsync)
    source = open_source("simulated:straight")
    raw = SampleEncoder("u1", 7)
    description = raw.description(0, (unit_sensor("", source.description),), source="", tracker="")
    box = BlackBox(folder, description, 10**9, SystemClock())
    handed_over_ns: list[int] = []  # at each cut
    began_s = time.monotonic()
    for batch in source.batches():
        t_ns = int(batch.imu.t_ns[-1])
        time.sleep(max(0.0, began_s + t_ns / NS_PER_S - time.monotonic()))
        if time.monotonic() - began_s > EVERY_S * (len(handed_over_ns) + 2):
            disk.cut(folder, tmp_path / f"cut-{len(handed_over_ns)}")
            handed_over_ns.append(t_ns)
            if len(handed_over_ns) == CUTS:
                break
        box.write(raw.messages(batch))
    box.close()
    for number, newest_ns in enumerate(handed_over_ns):
        (boot,) = (tmp_path / f"cut-{number}").iterdir()
        batches = list(BlackBoxSource(boot).batches())
        assert batches[0].imu.t_ns[0] == 0
        assert newest_ns - int(batches[-1].imu.t_ns[-1]) <= NS_PER_S
