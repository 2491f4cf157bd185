"""Writes that a disk refuses, cuts short or drops are repeated, in their place."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from shared.mcap_log import (
    SegmentWriter,
    segment_paths,
)
from shared.mcap_log.durable_file import DurableFile
from tests.rig.small_log import KEY, T0_NS, as_others_read


def test_data_lost_by_the_disk_is_written_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A system drops what it could not bring to the disk, and says so once."""
    writer = SegmentWriter(tmp_path)
    writer.write(T0_NS, KEY, b"1", urgent=True)
    [path] = segment_paths(tmp_path)
    safe_bytes = path.stat().st_size

    def drop(descriptor: int) -> None:
        os.ftruncate(descriptor, safe_bytes)
        raise OSError(5, "Input/output error")

    with monkeypatch.context() as failing:
        failing.setattr("shared.mcap_log.durable_file.os.fsync", drop)
        writer.write(T0_NS + 1, KEY, b"mayday", urgent=True)
        assert "Input/output error" in writer.problem
        assert writer.waiting_bytes > 0
        writer.write(T0_NS + 2, KEY, b"3", urgent=True)
    writer.write(T0_NS + 3, KEY, b"4", urgent=True)
    assert writer.problem == ""
    assert writer.waiting_bytes == 0
    writer.close()
    assert [message.data for *_, message in as_others_read(path)] == [b"1", b"mayday", b"3", b"4"]


def test_lost_partial_writes_are_written_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = DurableFile(tmp_path / "file")
    write, fsync = os.pwrite, os.fsync
    full = OSError(28, "No space left on device")
    troubles = [None, full, full]  # the first write is cut short, the next two are refused

    def write_some(descriptor: int, data: bytes, offset: int) -> int:
        if troubles:
            trouble = troubles.pop(0)
            if trouble is not None:
                raise trouble
            data = data[:3]
        return write(descriptor, data, offset)

    def drop(descriptor: int) -> None:
        os.ftruncate(descriptor, 0)
        raise full

    monkeypatch.setattr(os, "pwrite", write_some)
    file.write(b"first ")
    file.write(b"second ")
    for _ in range(2):
        with pytest.raises(OSError, match="No space"):
            file.sync()
        file.write(b"more ")
    monkeypatch.setattr(os, "fsync", drop)
    with pytest.raises(OSError, match="No space"):
        file.sync()
    monkeypatch.setattr(os, "fsync", fsync)
    file.sync()
    assert file.path.read_bytes() == b"first second more more "
    assert (file.tell(), file.waiting_bytes) == (23, 0)
    file.close()


def test_a_name_that_did_not_reach_the_disk_is_brought_there_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = DurableFile(tmp_path / "file")
    file.write(b"something")
    fsync, synced = os.fsync, []

    def fail_once(descriptor: int) -> None:
        synced.append(Path(f"/proc/self/fd/{descriptor}").readlink())
        if len(synced) == 1:
            raise OSError(5, "Input/output error")
        fsync(descriptor)

    monkeypatch.setattr(os, "fsync", fail_once)
    with pytest.raises(OSError, match="Input/output"):
        file.sync()
    file.sync()
    assert synced == [tmp_path, tmp_path, file.path]
    file.close()
