"""The bus's router, a process of its own beside the station.

Zenoh reads access rules when it opens, so enrolling or revoking somebody means opening the
router again.  In its own process that costs everybody's link half a second, and the station
keeps its session, its subscriptions and what it knows.
"""

from __future__ import annotations

import logging
import signal
import sys
import time
from contextlib import closing
from pathlib import Path
from threading import Event, Thread
from typing import Annotated

import typer

from base_station.pki.access import access_control
from base_station.pki.folder import PkiFolder
from shared.bus_zenoh import StationEndpoint, ZenohBus
from shared.errors import BusError, ConfigError, MusterError
from shared.log import set_up_logging

logger = logging.getLogger(__name__)

READY = "router ready"
FAILED = "router failed: "
_LOOK_EVERY_S = 1.0
_OPEN_ATTEMPTS = 10  # after a change: the port may take a moment to come free
_ATTEMPT_EVERY_S = 0.5


def endpoint_of(data: Path, listen: tuple[str, ...]) -> StationEndpoint:
    """What the router opens: over TLS with the authority's rules, over plain TCP without any.

    Raises ConfigError where there is no authority, or plain and TLS are mixed.
    """
    if not any(endpoint.startswith("tls/") for endpoint in listen):
        return StationEndpoint(listen)
    if not all(endpoint.startswith("tls/") for endpoint in listen):
        raise ConfigError(
            f"{', '.join(listen)}: the bus is either secure or not; listen on tls/ only, or on "
            "tcp/ only"
        )
    pki = PkiFolder(data)
    return StationEndpoint(listen, pki.station_identity(), access_control(pki.registry()))


def own_endpoint(listen: tuple[str, ...]) -> str:
    """Where the station itself finds its router."""
    first = listen[0]
    return first.replace("/0.0.0.0:", "/127.0.0.1:").replace("/[::]:", "/[::1]:")


class Router:
    """Open from the start; ``refresh`` opens it again when the authority's folder has changed."""

    def __init__(self, data: Path, listen: tuple[str, ...]) -> None:
        """Raises MusterError, one sentence, when it cannot open."""
        self._data = data
        self._listen = listen
        self._endpoint = endpoint_of(data, listen)
        self._bus = ZenohBus(self._endpoint)
        self._told = ""

    def refresh(self) -> None:
        """What cannot be read leaves the rules as they were, and says so once.

        Raises BusError when the port cannot be listened on again.
        """
        if self._endpoint.tls is None:
            return
        try:
            wanted = endpoint_of(self._data, self._listen)
        except MusterError as error:
            if str(error) != self._told:
                logger.error("access rules stay as they were: %s", error)
            self._told = str(error)
            return
        self._told = ""
        if wanted != self._endpoint:
            self._bus.close()
            self._bus = _open_again(wanted)
            self._endpoint = wanted
            logger.info("open again with the changed certificates and rules")

    def close(self) -> None:
        self._bus.close()


def router(
    listen: Annotated[
        list[str], typer.Option(help="tls/HOST:PORT, or by name the insecure tcp/HOST:PORT.")
    ],
    data: Annotated[Path, typer.Option(help="The station's data folder.")] = Path("muster-data"),
    with_parent: Annotated[
        bool, typer.Option("--with-parent", help="End when standard input ends.")
    ] = False,
) -> None:
    """Run the bus's router until Ctrl-C; a station starts its own by itself."""
    set_up_logging()
    stop = Event()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: stop.set())
    if with_parent:
        Thread(target=_stop_at_end_of_input, args=(stop,), daemon=True).start()
    try:
        opened = Router(data, tuple(listen))
    except MusterError as error:
        if with_parent:
            print(f"{FAILED}{error}", flush=True)
        raise
    with closing(opened):
        print(READY, flush=True)
        while not stop.wait(_LOOK_EVERY_S):
            opened.refresh()


def _stop_at_end_of_input(stop: Event) -> None:
    """The parent's end of the pipe closes however the parent dies."""
    sys.stdin.buffer.read()
    stop.set()


def _open_again(endpoint: StationEndpoint) -> ZenohBus:
    """The port may take a moment to come free."""
    for _ in range(_OPEN_ATTEMPTS - 1):
        try:
            return ZenohBus(endpoint)
        except BusError as error:
            logger.warning("%s; trying again", error)
        time.sleep(_ATTEMPT_EVERY_S)
    return ZenohBus(endpoint)


if __name__ == "__main__":
    typer.run(router)
