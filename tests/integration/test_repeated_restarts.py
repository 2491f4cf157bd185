"""A unit's program that has restarted again and again: each message is in the log once."""

from __future__ import annotations

import itertools
from collections import Counter
from contextlib import ExitStack, closing
from pathlib import Path

from base_station.core.state.message_stream import STARTS_KEPT
from base_station.unit_sync.backfill import Backfill
from edge.storage.journal.journal import Journal, JournalRow
from edge.storage.journal.server import JournalServer
from shared.channels import POSITION
from shared.clock import NS_PER_S, SystemClock
from shared.codec import encode
from shared.messages import Header
from shared.messages.station import RegisterUnit
from tests.rig.live_station import LiveStation
from tests.rig.message_factory import position
from tests.rig.waiting import until

U = "FF-01"
MESSAGES = 5
RUNS = STARTS_KEPT + 9  # so quickly after each other that some are left to the journal


def reported_complete(station: LiveStation) -> int:
    """Starts of the unit that the station reports to have whole."""
    return sum(boot.runs == ((1, MESSAGES),) for boot in station.reported.get(U, ()))


def test_every_message_is_in_the_log_once_after_many_starts(
    tmp_path: Path,
) -> None:
    boot_ids = itertools.count(1)
    stated: list[bytes] = []
    with LiveStation(tmp_path / "station") as station, ExitStack() as stack:
        station.act(RegisterUnit(U, "one"))
        for run in range(RUNS):
            journal = Journal(tmp_path / "journal.sqlite", boot_ids.__next__, 0, 10**9)
            stack.callback(journal.close)
            messages = [
                position(Header(U, journal.boot_id, seq, (10 * run + seq) * NS_PER_S))
                for seq in range(1, MESSAGES + 1)
            ]
            journal.append(
                [JournalRow(one.header.seq, POSITION, 0, encode(one)) for one in messages]
            )
            stated += map(encode, messages)
            for one in messages:
                station.publish(one)
        live = set(stated[: STARTS_KEPT * MESSAGES])
        until(lambda: live <= {one for _, _, one in station.log.records()}, "what came live")
        until(  # an earlier report would have what is there fetched again
            lambda: reported_complete(station) == STARTS_KEPT, "what came live is reported"
        )
        server = JournalServer(U, journal)
        station.router.attach_unit().serve(server.key_expression, server.replies)
        backfill = Backfill(station.bus, station.feed.deliver, SystemClock())
        stack.enter_context(closing(backfill))
        stack.callback(station.feed.close)
        backfill.start()

        def counts() -> set[int]:
            backfill.report(station.reported)
            logged = Counter(payload for _, _, payload in station.log.records())
            return {logged[payload] for payload in stated}

        until(lambda: counts() == {1}, "all of it is there")
        for _ in range(3):
            station.reported = {}
            until(lambda: station.reported, "the next report")
            assert counts() == {1}
        assert backfill.fetched == (RUNS - STARTS_KEPT) * MESSAGES
