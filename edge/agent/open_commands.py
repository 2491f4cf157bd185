"""Open commands, of which the wearer is notified until they are answered or over.  They are stored
on disk for a restart of the agent.  A thread of its own writes, so that the disk does not delay a
command.
"""

from __future__ import annotations

import logging
import os
from collections.abc import Iterator
from pathlib import Path

import msgspec

from shared.coded_text import coded
from shared.durable_names import sync_folder
from shared.messages import ANSWERED_BY_PRESS, Command, CommandKind
from shared.own_files import read_own, write_own
from shared.worker import UNTIL_WOKEN, Worker

logger = logging.getLogger(__name__)

NOTIFIES_WEARER = ANSWERED_BY_PRESS | {CommandKind.ALARM_ACKNOWLEDGED}
_MOST_KEPT = 100
_CLOSE_TIMEOUT_S = 5.0  # then a disk that hangs is not waited for


class OpenCommand(msgspec.Struct, frozen=True):
    """Command that the wearer is notified of."""

    command_id: str
    kind: CommandKind
    text: str
    expires_utc_ns: int  # station time; 0: never
    repeats: str = ""  # id of the order that it sends again; empty: it is a new one


class OpenCommands:
    """Open commands of one unit, oldest first; none of its methods waits or raises."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._read_fault: str = ""
        found = self._read()
        self._on_disk = found  # None: not known; it is written anew
        self._commands = {command.command_id: command for command in found or ()}
        self._worker = Worker(
            "open-commands", self._step, "open commands are not kept on disk", at_end=self._save
        )
        self._worker.start()

    def __iter__(self) -> Iterator[OpenCommand]:
        return iter(tuple(self._commands.values()))

    @property
    def fault(self) -> str:
        """Fault of the disk as a sentence; empty where there is none."""
        if self._worker.fault:
            return coded(
                "commands-not-kept",
                "open commands would not survive a restart: {error}",
                error=self._worker.fault,
            )
        return self._read_fault

    def add(self, command: Command) -> None:
        """Keep a command of a kind that the wearer is notified of; others are left out.  A repeat
        replaces the order that it repeats.
        """
        if command.kind not in NOTIFIES_WEARER or command.command_id in self._commands:
            return
        if command.repeats:
            self.close_one(command.repeats)
        self._commands[command.command_id] = OpenCommand(
            command.command_id, command.kind, command.text, command.expires_utc_ns, command.repeats
        )
        while len(self._commands) > _MOST_KEPT:
            del self._commands[next(iter(self._commands))]
        self._worker.wake()

    def close_answered(self) -> None:
        """Drop all: the wearer has pressed the button."""
        self._drop(tuple(self._commands))

    def close_one(self, command_id: str) -> None:
        """Drop a command that is over, with its repeats; an unknown one changes nothing."""
        self._drop(
            tuple(one.command_id for one in self if command_id in (one.command_id, one.repeats))
        )

    def expire(self, utc_ns: int) -> None:
        """Drop commands that have expired by the station's clock."""
        self._drop(tuple(one.command_id for one in self if 0 < one.expires_utc_ns <= utc_ns))

    def close(self) -> None:
        """Write what is not written yet, unless the disk hangs."""
        if not self._worker.close(_CLOSE_TIMEOUT_S):
            logger.error("the disk hangs: open commands are not kept")

    def _drop(self, command_ids: tuple[str, ...]) -> None:
        for command_id in command_ids:
            del self._commands[command_id]
        if command_ids:
            self._worker.wake()

    def _read(self) -> list[OpenCommand] | None:
        """Return the commands on the disk; None where they cannot be read."""
        try:
            with read_own(self._path) as file:
                return msgspec.json.decode(file.read(), type=list[OpenCommand])
        except FileNotFoundError:
            return []
        except (OSError, msgspec.MsgspecError) as error:  # a unit must start in any case
            self._read_fault = coded(
                "commands-not-read",
                "which commands were open cannot be read: {error}",
                error=str(error),
            )
            return None

    def _step(self) -> float:
        self._save()
        return UNTIL_WOKEN

    def _save(self) -> None:
        """Bring the commands to the disk: a power cut leaves those before or those after.

        Unchanged commands are not written again, as flash memory wears.
        """
        commands = list(self._commands.values())
        if commands == self._on_disk:
            return
        new = self._path.with_suffix(".new")
        with write_own(new, 0o600) as written:
            written.write(msgspec.json.encode(commands))
            written.flush()
            os.fsync(written.fileno())
        new.replace(self._path)
        sync_folder(self._path.parent)
        self._on_disk = commands
