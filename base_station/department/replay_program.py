"""A replay from the archive that ends with its standard input.

``python -m base_station.department.replay_program INCIDENT ARCHIVE HOST:PORT [CERTIFICATE KEY]``
"""

from __future__ import annotations

import os
import signal
import sys
from pathlib import Path
from threading import Thread

from base_station.app.replay import run_replay_station
from base_station.config import HttpConfig, StationConfig
from shared.errors import MusterError
from shared.log import set_up_logging


def main(incident_id: str, archive: str, listen: str, *tls: str) -> None:
    certificate, private_key = map(Path, tls) if tls else (None, None)
    http = HttpConfig(listen=listen, certificate=certificate, private_key=private_key)
    set_up_logging()
    Thread(target=_end_with_input, daemon=True).start()
    try:
        run_replay_station(StationConfig(http=http), incident_id, 1.0, _announce, archive=archive)
    except MusterError as error:
        _announce(str(error))
        sys.exit(2)


def _announce(line: str) -> None:
    print(line, flush=True)


def _end_with_input() -> None:
    sys.stdin.read()
    os.kill(os.getpid(), signal.SIGTERM)


if __name__ == "__main__":
    main(*sys.argv[1:])
