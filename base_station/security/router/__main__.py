"""The router's own process: ``process`` starts it, reads what it prints, and writes to it.

It has loaded its libraries before it reads its settings: the station loads its own meanwhile.
"""

from __future__ import annotations

import logging
import os
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import closing, suppress
from pathlib import Path
from shutil import rmtree
from threading import Event, Thread

import msgspec

from base_station.process.open_files import allow_many_files
from base_station.security.router.process import FAILED, READY, BanOrder, RouterSettings
from base_station.security.router.refusals import RefusalSummary
from base_station.security.router.router import Router
from shared.end_signals import end_requested
from shared.errors import MusterError
from shared.log import set_up_logging
from shared.zenoh_settings import LOCAL_LINK

logger = logging.getLogger(__package__)

_CHECK_EVERY_S = 1.0


def run_router(settings: RouterSettings, orders: Iterator[bytes]) -> int:
    """Run the router until a signal comes or ``orders`` end, as they do when the parent dies.

    Reports to the parent on standard output whether the router is open.  Returns the exit code.
    """
    set_up_logging()
    allow_many_files()
    stop = end_requested()
    ban: list[Callable[[str, float], None]] = []  # once the router is open
    Thread(target=_carry_out, args=(orders, stop, ban, settings.station), daemon=True).start()
    try:
        router = Router(Path(settings.data), settings.listen, settings.links, settings.station)
    except MusterError as error:
        _write_to_parent(f"{FAILED}{error}")
        return 2
    _write_to_parent(READY)
    with closing(router):
        try:
            ban.append(router.ban)
            refused = RefusalSummary()
            while not stop.wait(_CHECK_EVERY_S):
                router.refresh()
                if router.refused() != refused:
                    refused = router.refused()
                    _write_to_parent(msgspec.json.encode(refused).decode())
        except MusterError as error:
            logger.error("%s", error)
            return 2
    return 0


def _write_to_parent(line: str) -> None:
    """Write a line to the parent; without effect where the parent was killed meanwhile."""
    with suppress(BrokenPipeError):
        # Not print: it would try to write an unwritten line again as the program ends.
        os.write(sys.stdout.fileno(), f"{line}\n".encode())


def _carry_out(
    orders: Iterator[bytes],
    stop: Event,
    ban: Sequence[Callable[[str, float], None]],
    station: tuple[str, ...],
) -> None:
    """Carry out orders until the input ends: the parent is gone then, so remove its folders."""
    for line in orders:
        order = msgspec.json.decode(line, type=BanOrder)
        for one in ban:
            one(order.sender_id, order.seconds)
    for endpoint in station:
        rmtree(Path(endpoint.removeprefix(f"{LOCAL_LINK}/")).parent, ignore_errors=True)
    stop.set()


def _input_lines() -> Iterator[bytes]:
    """Whole lines of standard input, until its end."""
    rest = b""
    # Not sys.stdin: its lock, held while it reads, would abort a program that ends meanwhile.
    while read := os.read(sys.stdin.fileno(), 4096):
        *lines, rest = (rest + read).split(b"\n")
        yield from lines


def main() -> int:
    lines = _input_lines()
    settings = next(lines, None)
    if settings is None:  # there is no parent any more
        return 0
    return run_router(msgspec.json.decode(settings, type=RouterSettings), lines)


if __name__ == "__main__":
    sys.exit(main())
