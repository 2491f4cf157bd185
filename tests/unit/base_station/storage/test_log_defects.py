"""Defects of a log have the codes of their sentences, and so have the reasons in them."""

from __future__ import annotations

from contextlib import closing
from pathlib import Path

import pytest

from base_station.storage.log_defects import LogDefects
from shared.clock import NS_PER_S
from shared.coded_text import TextCode, code_of_text
from shared.mcap_log import SegmentPolicy, SegmentWriter, segment_paths
from tests.rig.small_log import KEY, T0_NS

EACH = 10


@pytest.fixture
def log(tmp_path: Path) -> Path:
    with closing(SegmentWriter(tmp_path, SegmentPolicy(segment_s=float(EACH)))) as log:
        for second in range(6 * EACH):
            log.write(T0_NS + second * NS_PER_S, KEY, b"%d" % second)
    return tmp_path


def defects_of(log: Path) -> dict[str, TextCode]:
    """Codes by the code of the sentence."""
    found = LogDefects(log)
    while found.check_next_chunk():
        pass
    codes = [code_of_text(one) for one in found()]
    return {one.code: one for one in codes}


def test_missing_segments_have_their_numbers_and_times(log: Path) -> None:
    paths = segment_paths(log)
    for path in (paths[1], paths[3], paths[4]):
        path.unlink()
    found = defects_of(log)
    assert found.keys() == {"log-segment-missing", "log-segments-missing"}
    one, several = found["log-segment-missing"], found["log-segments-missing"]
    assert one.numbers["number"] == 2
    assert one.texts["what:"] == "time-between"
    assert one.numbers["what:until_utc_s"] == T0_NS / NS_PER_S + 2 * EACH
    assert (several.numbers["first"], several.numbers["last"]) == (4, 5)


def test_damaged_chunk_has_its_file_place_and_reason(log: Path) -> None:
    path = segment_paths(log)[1]
    data = bytearray(path.read_bytes())
    at = data.index(b"zstd") + 40
    data[at : at + 4] = bytes(4)
    path.write_bytes(data)
    (found,) = defects_of(log).values()
    assert found.code == "log-part-unreadable"
    assert found.texts["part:"] == "segment-chunk-lost"
    assert found.texts["part:file"] == path.name
    assert found.texts["part:reason:"] in ("chunk-packed", "chunk-checksum")
    assert found.numbers["part:offset"] > 0


def test_torn_and_foreign_files_have_codes(log: Path) -> None:
    last = segment_paths(log)[-1]
    whole = last.read_bytes()
    last.write_bytes(whole[: whole.index(b"zstd") + 40])
    (log / "notes.mcap").write_bytes(b"no log")
    found = defects_of(log)
    assert found["segment-torn"].texts == {"file": last.name}
    assert found["segment-torn"].numbers["count"] > 0
    assert found["segment-foreign"].texts["reason:"] == "foreign-name"
