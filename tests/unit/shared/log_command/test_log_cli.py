"""``muster log`` on whole, torn, damaged and foreign logs, as its user runs it."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from mcap.reader import make_reader
from typer.testing import CliRunner, Result

from shared.channels import HEARTBEAT, TEMPERATURE
from shared.clock import NS_PER_S
from shared.codec import encode
from shared.errors import UserError
from shared.log_command.cli import app
from shared.mcap_log import SegmentPolicy, SegmentWriter, read_log, segment_paths
from shared.messages import Header, Temperature
from tests.rig.small_log import T0_NS, as_others_read

MINUTE_NS = 60 * NS_PER_S
ANNA, BEN = TEMPERATURE.key("anna"), TEMPERATURE.key("ben")


def payload(degc: float) -> bytes:
    header = Header("anna", boot_id=1, seq=1, t_mono_ns=T0_NS, t_utc_ns=T0_NS)
    return encode(Temperature(header, ambient_degc=degc))


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Three segments of a minute, a chunk each ten seconds."""
    log = tmp_path / "station" / "log"
    writer = SegmentWriter(log, SegmentPolicy(segment_s=60.0))
    for second in range(180):
        writer.write(T0_NS + second * NS_PER_S, ANNA, payload(second), urgent=second % 10 == 9)
        writer.write(T0_NS + second * NS_PER_S, BEN, payload(-second))
    writer.close()
    return log


def run(*arguments: object) -> Result:
    return CliRunner().invoke(app, [str(one) for one in arguments])


def report(*arguments: object) -> dict[str, list[dict[str, object]]]:
    ended = run(*arguments, "--json")
    found: dict[str, list[dict[str, object]]] = json.loads(ended.stdout)
    return found


def flip(path: Path, at: int) -> None:
    content = bytearray(path.read_bytes())
    content[at] ^= 0xFF
    path.write_bytes(content)


@pytest.mark.parametrize("steps_up", [0, 1])
def test_info_of_a_log_folder_and_of_a_data_folder_is_the_same(folder: Path, steps_up: int) -> None:
    path = (folder, folder.parent)[steps_up]
    ended = run("info", path)
    assert ended.exit_code == 0, ended.output
    assert "2023-11-14 22:13:20 to 2023-11-14 22:14:19  120 messages" in ended.stdout
    assert f"{180:>12}  {ANNA}" in ended.stdout
    files = report("info", path)["files"]
    assert [one["messages"] for one in files] == [120, 120, 120]
    assert [one["topics"] for one in files] == [{ANNA: 60, BEN: 60}] * 3


def test_a_whole_log_is_verified(folder: Path) -> None:
    ended = run("verify", folder)
    assert ended.exit_code == 0, ended.output
    assert "everything can be read" in ended.stdout


def test_no_flipped_byte_takes_a_record_away_without_being_named(folder: Path) -> None:
    path = segment_paths(folder)[1]
    whole = path.read_bytes()
    records = list(read_log(folder))
    found = 0
    for at in range(0, len(whole), 211):
        path.write_bytes(whole)
        flip(path, at)
        ended = run("verify", folder)
        assert ended.exit_code == 1 or list(read_log(folder)) == records, f"byte {at}"
        found += ended.exit_code
    assert found > 60  # of 93; the others are in heads, of which all stands elsewhere, too


def test_a_missing_a_foreign_and_a_torn_segment_are_named(folder: Path) -> None:
    first, second, third = segment_paths(folder)
    second.unlink()
    third.write_bytes(third.read_bytes()[:-200])
    (folder / "copy.mcap").write_bytes(first.read_bytes())
    ended = run("verify", folder)
    assert ended.exit_code == 1
    assert "segment 2 is missing" in ended.stderr
    assert "copy.mcap is no segment of this log" in ended.stderr
    assert f"{third.name}: it was not ended in order" in ended.stderr
    assert len(report("verify", folder)["problems"]) == 2


def test_a_torn_file_is_recovered_beside_the_original(folder: Path, tmp_path: Path) -> None:
    path, target = segment_paths(folder)[0], tmp_path / "whole.mcap"
    torn = path.read_bytes()[: path.stat().st_size // 2]
    path.write_bytes(torn)
    ended = run("recover", path, target)
    assert ended.exit_code == 0, ended.output
    assert "bytes at its end cannot be read" in ended.stderr
    count = len(as_others_read(target))
    assert 0 < count < 120
    assert f"{count} messages written to {target}" in ended.stdout
    assert path.read_bytes() == torn
    assert run("verify", target).exit_code == 0


def test_a_cut_has_the_records_of_its_time_and_topics_alone(folder: Path, tmp_path: Path) -> None:
    target = tmp_path / "cut.mcap"
    start, end = "2023-11-14T22:14:00Z", "2023-11-14T22:15:00"  # without a zone: UTC
    ended = run("cut", folder, target, "--start", start, "--end", end, "--topic", "*/anna/*")
    assert ended.exit_code == 0, ended.output
    assert "60 messages written" in ended.stdout
    records = as_others_read(target)
    assert {channel.topic for _, channel, _ in records} == {ANNA}
    times = [message.log_time for _, _, message in records]
    assert (times[0], times[-1]) == (T0_NS + 40 * NS_PER_S, T0_NS + 99 * NS_PER_S)
    with target.open("rb") as file:
        metadata = {one.name: one.metadata for one in make_reader(file).iter_metadata()}
    assert metadata["muster.log"]["log_id"] == report("info", folder)["files"][0]["log_id"]
    assert metadata["muster.extract"]["topics"] == "*/anna/*"
    assert metadata["muster.extract"]["first_file"] == segment_paths(folder)[0].name


def test_a_cut_of_a_damaged_log_has_the_rest_and_names_the_damage(
    folder: Path, tmp_path: Path
) -> None:
    path = segment_paths(folder)[1]
    flip(path, path.stat().st_size // 3)
    ended = run("cut", folder, tmp_path / "cut.mcap")
    assert ended.exit_code == 0, ended.output
    assert path.name in ended.stderr
    assert 240 < len(as_others_read(tmp_path / "cut.mcap")) < 360


@pytest.mark.parametrize("options", [("--topic", HEARTBEAT.key("anna")), ("--start", "2030-01-01")])
def test_an_empty_cut_leaves_no_file(
    folder: Path, tmp_path: Path, options: tuple[str, str]
) -> None:
    target = tmp_path / "new" / "cut.mcap"
    target.parent.mkdir()
    ended = run("cut", folder, target, *options)
    assert isinstance(ended.exception, UserError)
    assert not list(target.parent.iterdir())


@pytest.mark.parametrize("command", ["recover", "cut"])
def test_no_file_is_overwritten(folder: Path, tmp_path: Path, command: str) -> None:
    target = tmp_path / "mine.mcap"
    target.write_bytes(b"mine")
    ended = run(command, segment_paths(folder)[0], target)
    assert isinstance(ended.exception, UserError)
    assert target.read_bytes() == b"mine"


def test_cat_prints_one_json_object_a_message(folder: Path) -> None:
    ended = run("cat", folder, "--topic", ANNA, "--end", "2023-11-14T22:13:22Z")
    assert ended.exit_code == 0, ended.output
    first, second = map(json.loads, ended.stdout.splitlines())
    assert first["time"] == "2023-11-14T22:13:20.000000000Z"
    assert first["topic"] == ANNA
    assert second["message"]["ambient_cdegc"] == 100


def test_cat_shows_bytes_that_are_no_message(tmp_path: Path) -> None:
    writer = SegmentWriter(tmp_path)
    writer.write(T0_NS, ANNA, b"\xff\xff")
    writer.close()
    assert json.loads(run("cat", tmp_path).stdout)["payload_hex"] == "ffff"


def test_a_file_that_is_no_log_is_named_as_such(tmp_path: Path) -> None:
    path = tmp_path / "rubbish.mcap"
    path.write_bytes(b"rubbish")
    for command in ("verify", "cat"):
        ended = run(command, path)
        assert ended.exit_code == 1
        assert "it is no MCAP file" in ended.stderr


def test_a_folder_without_a_log_is_an_error_with_advice(tmp_path: Path) -> None:
    for path in (tmp_path, tmp_path / "nothing"):
        assert isinstance(run("info", path).exception, UserError)


def test_a_time_that_is_none_is_refused(folder: Path) -> None:
    ended = run("cat", folder, "--start", "yesterday")
    assert ended.exit_code == 2
    assert "2026-03-01T10:00:00Z" in ended.stderr
