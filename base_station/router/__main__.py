"""The router's own process: ``process`` starts it and reads what it prints."""

from __future__ import annotations

import logging
import os
import sys
from contextlib import closing, suppress
from pathlib import Path
from threading import Event, Thread

from base_station.router.process import FAILED, LINKS, READY
from base_station.router.router import Router
from shared.end_signals import told_to_end
from shared.errors import MusterError
from shared.log import set_up_logging

logger = logging.getLogger(__package__)

_LOOK_EVERY_S = 1.0


def run_router(data: Path, listen: tuple[str, ...], links: tuple[str, ...] = ()) -> int:
    """Until a signal comes or standard input ends, which it does when the parent dies.

    Tells the parent on standard output whether it is open.  Gives the exit code.
    """
    set_up_logging()
    stop = told_to_end()
    Thread(target=_stop_at_end_of_input, args=(stop,), daemon=True).start()
    try:
        router = Router(data, listen, links)
    except MusterError as error:
        _tell_parent(f"{FAILED}{error}")
        return 2
    _tell_parent(READY)
    with closing(router):
        try:
            while not stop.wait(_LOOK_EVERY_S):
                router.refresh()
        except MusterError as error:
            logger.error("%s", error)
            return 2
    return 0


def _tell_parent(line: str) -> None:
    """One that was killed meanwhile is told nothing, and has ended the input too."""
    with suppress(BrokenPipeError):
        # Not print: what it could not say it would try to say again as the program ends.
        os.write(sys.stdout.fileno(), f"{line}\n".encode())


def _stop_at_end_of_input(stop: Event) -> None:
    # Not sys.stdin: its lock, held while it reads, would abort a program that ends meanwhile.
    while os.read(sys.stdin.fileno(), 4096):
        pass
    stop.set()


if __name__ == "__main__":
    listening, _, linking = " ".join(sys.argv[2:]).partition(LINKS)
    sys.exit(run_router(Path(sys.argv[1]), tuple(listening.split()), tuple(linking.split())))
