"""Process that has loaded the program, of which copies work on the past (``server``)."""

from __future__ import annotations

import logging
import os
import signal
import socket
import sys
from contextlib import suppress
from pathlib import Path
from typing import NoReturn

from base_station.process import gc_tuning
from base_station.replay.processes.frame_channel import FrameChannel
from shared.log import set_up_logging

_NICE = 10  # of copies: the live station goes before; loading is soon over
_OOM_SCORE = 500  # of 1,000: where memory ends, it is these that the system ends
_log = logging.getLogger(__package__)


def serve(control: socket.socket) -> None:
    """Make a copy for every socket that comes, until no more can come."""
    while True:
        try:
            message, fds, _, _ = socket.recv_fds(control, 1, 1)
        except OSError:
            return
        if not message:
            return
        if os.fork() == 0:
            control.close()
            _run_copy(fds[0])
        os.close(fds[0])


def _run_copy(fd: int) -> NoReturn:
    """Run in the copy.  It never returns into the code of the process from which it was copied."""
    from base_station.app.replay_worker import work  # noqa: PLC0415  # loaded already

    code = 1
    try:
        signal.signal(signal.SIGCHLD, signal.SIG_DFL)
        os.nice(_NICE)
        work(FrameChannel(socket.socket(fileno=fd)))
        code = 0
    except Exception:  # noqa: BLE001  # logged here: there is no caller to raise it to
        _log.exception("a process that looks at the past broke off")
    finally:
        logging.shutdown()
        os._exit(code)


def _prefer_for_oom_kill() -> None:
    """Make this process the first that the kernel ends if memory runs out."""
    with suppress(OSError):  # missing on some systems
        Path("/proc/self/oom_score_adj").write_text(str(_OOM_SCORE), encoding="ascii")


def main() -> None:
    # A signal to the station may reach all of its processes; this one ends with the station.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)  # no process waits for copies
    set_up_logging()
    _prefer_for_oom_kill()
    gc_tuning.configure()
    with gc_tuning.paused():
        from base_station.app import replay_worker  # noqa: F401, PLC0415  # for all copies
        from base_station.storage.checkpoints import program_checksum  # noqa: PLC0415  # likewise
    program_checksum()
    with socket.socket(fileno=int(sys.argv[1])) as control:
        serve(control)


if __name__ == "__main__":
    main()
