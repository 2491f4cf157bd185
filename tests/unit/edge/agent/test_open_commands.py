"""Open commands outlive a restart, and end when they are answered or over."""

from __future__ import annotations

from contextlib import closing
from pathlib import Path

import pytest

from edge.agent.open_commands import OpenCommands
from shared.messages import Command, CommandKind, Header
from tests.rig.waiting import until

HEADER = Header("station", 1, 1, 0)


def command(command_id: str, kind: CommandKind, *, text: str = "", expires_ns: int = 0) -> Command:
    return Command(HEADER, command_id, kind, "officer", expires_ns, text)


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "open_commands.json"


def ids(commands: OpenCommands) -> list[str]:
    return [one.command_id for one in commands]


def test_notified_commands_survive_a_restart_and_others_do_not(path) -> None:
    with closing(OpenCommands(path)) as commands:
        commands.add(command("a", CommandKind.EVACUATE))
        commands.add(command("b", CommandKind.TEXT, text="come out"))
        commands.add(command("b", CommandKind.TEXT, text="a repeat"))
        commands.add(command("c", CommandKind.SET_POSITION_RATE))
    with closing(OpenCommands(path)) as commands:
        assert [(one.command_id, one.kind, one.text) for one in commands] == [
            ("a", CommandKind.EVACUATE, ""),
            ("b", CommandKind.TEXT, "come out"),
        ]


def test_kill_keeps_written_commands(path) -> None:
    with closing(OpenCommands(path)) as killed:
        killed.add(command("a", CommandKind.EVACUATE))
        until(lambda: path.exists() and b'"a"' in path.read_bytes())
        with closing(OpenCommands(path)) as commands:
            assert ids(commands) == ["a"]


def test_answer_closes_all_and_time_closes_the_expired(path) -> None:
    with closing(OpenCommands(path)) as commands:
        commands.add(command("a", CommandKind.EVACUATE, expires_ns=100))
        commands.add(command("b", CommandKind.LOCATE))
        commands.expire(99)
        assert ids(commands) == ["a", "b"]
        commands.expire(100)
        assert ids(commands) == ["b"]
        commands.close_answered()
        assert ids(commands) == []
    with closing(OpenCommands(path)) as commands:
        assert ids(commands) == []


def test_start_without_changes_writes_nothing(path) -> None:
    with closing(OpenCommands(path)):
        pass
    assert not path.exists(), "there is nothing to keep"
    with closing(OpenCommands(path)) as commands:
        commands.add(command("a", CommandKind.EVACUATE))
    written = path.stat()
    with closing(OpenCommands(path)) as commands:
        assert ids(commands) == ["a"]
    assert (path.stat().st_ino, path.stat().st_mtime_ns) == (written.st_ino, written.st_mtime_ns)


def test_damaged_file_is_rewritten_once(path) -> None:
    path.write_bytes(b"[1]")
    with closing(OpenCommands(path)):
        pass
    assert path.read_bytes() == b"[]"
    with closing(OpenCommands(path)) as commands:
        assert commands.fault == ""


def test_ended_command_is_kept_no_more(path) -> None:
    with closing(OpenCommands(path)) as commands:
        commands.add(command("a", CommandKind.EVACUATE))
        commands.add(command("b", CommandKind.TEXT, text="x"))
        commands.close_one("a")
        commands.close_one("elsewhere")
        assert ids(commands) == ["b"]
    with closing(OpenCommands(path)) as commands:
        assert ids(commands) == ["b"]


@pytest.mark.parametrize("content", [b"", b"\0" * 40, b"[1]", b'[{"command_id":"a"}]'])
def test_damaged_file_stops_no_unit_and_is_reported(path, content) -> None:
    path.write_bytes(content)
    with closing(OpenCommands(path)) as commands:
        assert ids(commands) == []
        assert "which commands were open cannot be read" in commands.fault


def test_refusing_disk_is_a_fault_and_the_command_stays(tmp_path: Path) -> None:
    with closing(OpenCommands(tmp_path / "nowhere" / "open_commands.json")) as commands:
        commands.add(command("a", CommandKind.EVACUATE))
        until(lambda: "would not survive a restart" in commands.fault)
        assert ids(commands) == ["a"]


def test_flood_of_commands_is_bounded(path) -> None:
    with closing(OpenCommands(path)) as commands:
        for number in range(500):
            commands.add(command(str(number), CommandKind.TEXT, text="x"))
        assert ids(commands)[-1] == "499"
        assert len(ids(commands)) == 100
