"""``muster edge run`` on a machine with a button that ``umockdev-run`` emulates."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
from pathlib import Path

from tests.rig.waiting import PATIENCE_S

NAME = "AB Button"
KEY_POWER = 116
_NODE = "/dev/input/event3"
_DEVICE = f"""\
P: /devices/platform/button/input/input3
E: EV=3
E: NAME="{NAME}"
E: SUBSYSTEM=input
A: name={NAME}

P: /devices/platform/button/input/input3/event3
N: input/event3
E: DEVNAME={_NODE}
E: SUBSYSTEM=input
E: MAJOR=13
E: MINOR=67
A: dev=13:67
"""


def has_umockdev_run() -> bool:
    return shutil.which("umockdev-run") is not None


def _bits(size: int, *numbers: int) -> str:
    """A kernel's bit field, of as many bytes as the library asks for."""
    field = bytearray(size)
    for number in numbers:
        field[number // 8] |= 1 << number % 8
    return field.hex().upper()


def _text(text: str) -> str:
    return text.encode().ljust(256, b"\0").hex().upper()


def _requests() -> str:
    return "\n".join(
        (
            f"@DEV {_NODE}",
            "EVIOCGID 0 0300341200010001",
            "EVIOCGVERSION 0 01000100",
            f"EVIOCGNAME 256 {_text(NAME)}",
            f"EVIOCGPHYS 256 {_text('button/input0')}",
            f"EVIOCGUNIQ 256 {_text('')}",
            f"EVIOCGBIT(0) 4 {_bits(4, 0, 1)}",
            f"EVIOCGBIT(1) 96 {_bits(96, KEY_POWER)}",
            f"EVIOCGKEY 96 {_bits(96)}",
            "EVIOCGEFFECTS 0 00000000",
            "",
        )
    )


def _pressed_for_good() -> str:
    """It waits to be read: the hold begins when the agent has opened the device."""
    return f"E: 0.000000 0000 0000 0\nE: 0.500000 0001 {KEY_POWER:04x} 1\nE: 0.500000 0000 0000 0\n"


class AgentWithButton:
    """The agent, and whoever emulates the button, as one group of processes."""

    def __init__(self, folder: Path, *flags: str, is_held: bool) -> None:
        folder.mkdir()
        self._output = folder / "agent.txt"
        described, asked, events = (folder / f"button.{kind}" for kind in ("dev", "ioctl", "ev"))
        described.write_text(_DEVICE)
        asked.write_text(_requests())
        events.write_text(_pressed_for_good())
        emulating = ["umockdev-run", "-d", str(described), "-i", f"{_NODE}={asked}"]
        if is_held:
            emulating += ["-e", f"{_NODE}={events}"]
        program = Path(sys.executable).with_name("muster")
        with self._output.open("wb") as written:
            self._process = subprocess.Popen(
                [*emulating, "--", str(program), "edge", "run", *flags],
                stdout=written,
                stderr=written,
                start_new_session=True,
            )

    def __enter__(self) -> AgentWithButton:
        return self

    def __exit__(self, *_: object) -> None:
        self.kill()

    def log(self) -> str:
        return self._output.read_text(errors="replace")

    def kill(self) -> None:
        if self._process.poll() is None:
            os.killpg(self._process.pid, signal.SIGKILL)
        self._process.wait(PATIENCE_S)
