"""The process that captures one radio channel: ``python -m base_station.radio.capture``.

It gets its settings as a line of JSON and writes packets (``capture_wire``).  It may hang, break
off or be ended at any time, and ends by itself when the station is gone.
"""

from __future__ import annotations

import os
import signal
import sys
import time
from threading import Thread
from typing import BinaryIO

import msgspec

from base_station.radio.capture_wire import PACKET, PROBLEM, Captured, encode_problem, encoded
from base_station.radio.config import RadioConfig
from shared.coded_text import coded, text_of_error
from shared.errors import MusterError

_NICE = 5  # live work goes before
NOT_INSTALLED = coded(
    "radio-library-missing",
    "the library av, which encodes audio, is not installed: {command}",
    command="pip install --require-hashes -r deploy/requirements-radio.lock",
)
_ENDED = coded("radio-source-ended", "the source ended")


def capture(config: RadioConfig, out: BinaryIO) -> None:
    """Until the source ends.  Raises SourceError."""
    from base_station.radio.packet_stamper import PacketStamper  # noqa: PLC0415
    from base_station.radio.sources import sounds_of  # noqa: PLC0415  # an optional library

    stamper = PacketStamper(config)
    for sound in sounds_of(config):
        packets = [encoded(Captured(PACKET, *one)) for one in stamper.push(sound)]
        if packets:
            out.write(b"".join(packets))
            out.flush()


def _end_with_station() -> None:
    """The other end of the standard input is closed when the station ends, however it does."""
    os.read(sys.stdin.fileno(), 1)
    os.killpg(0, signal.SIGKILL)  # with a program that reads a device


def main() -> None:
    os.nice(_NICE)
    config = msgspec.json.decode(sys.stdin.buffer.readline(), type=RadioConfig)
    Thread(target=_end_with_station, name="end", daemon=True).start()
    out = sys.stdout.buffer
    try:
        capture(config, out)
    except ModuleNotFoundError:
        problem: str = NOT_INSTALLED
    except MusterError as error:
        problem = text_of_error(error)
    else:
        problem = _ENDED
    out.write(encoded(Captured(PROBLEM, time.monotonic_ns(), encode_problem(problem))))
    out.flush()


if __name__ == "__main__":
    main()
