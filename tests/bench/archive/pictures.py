"""The first picture of an archived incident over a link; a program in a network of its own.

``python -m tests.bench.archive.pictures ADDRESS INCIDENT COUNT`` prints JSON.
"""

from __future__ import annotations

import random
import sys
import time
from contextlib import ExitStack

import msgspec

from base_station.app.archive_sources import open_archived_log
from base_station.archive.store import open_store
from base_station.replay.recorded_player import RecordedPlayer
from base_station.storage.db.records import Records
from base_station.storage.db.roster import Roster
from base_station.views.wire import ReplayView
from shared.clock import SystemClock
from tests.rig.counting_store import CountingStore
from tests.rig.live_station import Screen


class Picture(msgspec.Struct, frozen=True):
    second: float  # of the incident
    took_s: float  # from the wish until the picture is whole
    waited_s: float  # of that, for the archive
    requests: int
    kilobytes: float
    units: int


def picture(address: str, incident_id: str, part: float) -> Picture:
    """Nothing of the incident is known here before; ``part``: of its time."""
    with ExitStack() as closing:
        begun_s = time.perf_counter()
        store = CountingStore(open_store(address))
        opened = open_archived_log(store, incident_id, closing, lambda _: None)
        clock = SystemClock()
        incident = Records(opened.store, clock).require_incident(incident_id)
        long_ns = (incident.closed_ns or 0) - incident.opened_ns
        player = RecordedPlayer(opened.log.everything, Screen(), Roster(opened.store, clock).known)
        for _ in player.seek(incident.opened_ns + round(part * long_ns)):
            pass
        shown, _ = player.snapshot(ReplayView(incident_id, 0, 0, 0, 1.0, playing=False))
        took_s = time.perf_counter() - begun_s
        return Picture(
            part * long_ns / 1e9,
            took_s,
            store.waited_s,
            store.requests,
            store.bytes / 1e3,
            len(shown.units),
        )


def main(address: str, incident_id: str, count: str) -> None:
    dice = random.Random(2)
    picture(address, incident_id, 0.5)  # what is loaded once
    pictures = [picture(address, incident_id, dice.random()) for _ in range(int(count))]
    print(msgspec.json.encode(pictures).decode())


if __name__ == "__main__":
    main(*sys.argv[1:])
