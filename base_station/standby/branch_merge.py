"""Merge of the branch of a station that was apart: its messages and actions come to the leader.

The standby serves the branch that it has set aside; the active station fetches it.  Units' messages
are treated as late data, so that those that are in the log are left out.  Actions of people are
logged and shown, and not applied.
"""

from __future__ import annotations

import logging
import secrets
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from enum import Enum
from itertools import islice
from pathlib import Path
from threading import Event

from base_station.core.idempotency import idempotent_action_id
from base_station.core.log_position import Record
from base_station.engine.ports import ActionResult, OperatorGate
from base_station.standby.log_truncation import mark_merged, parts, read_part
from base_station.standby.protocol import Batch, pack, unpack
from base_station.standby.rpc import RpcServer, ask
from shared.bus import Bus
from shared.channels import OPERATOR, Direction, backfilled_key, parse_key
from shared.codec import decode
from shared.coded_text import coded
from shared.errors import UnknownChannelError, WireError
from shared.messages import STATION_ID, OperatorAction
from shared.messages.station import Assign, DoneApart, ReportProblem

logger = logging.getLogger(__name__)

_SETTLE_S = 0.05
_BATCH = 1000  # events
_MOST_LETTERS = 2000  # a note has 500
_NAMES = ("person_name", "crew", "role", "keeps_incident")  # of an earlier version, or an erasure


class PartServer(RpcServer):
    """Serves branches that were set aside: ``apart/names``, ``apart/records``, ``apart/told``."""

    def __init__(self, station: str, bus: Bus, data: Path) -> None:
        self._data = data
        self._reading: tuple[str, int, Iterator[Record]] | None = None
        super().__init__(
            station,
            bus,
            {
                "apart/names": self._names,
                "apart/records": self._records,
                "apart/told": self._confirm_merged,
            },
        )

    def _names(self, _key: str, _parameters: str, _payload: bytes) -> Iterator[bytes]:
        for name in parts(self._data):
            yield name.encode()

    def _records(self, _key: str, _parameters: str, payload: bytes) -> Iterator[bytes]:
        """``NAME SKIP``: events of the part, behind the first SKIP."""
        name, _, skip_text = payload.decode().partition(" ")
        skip = int(skip_text)
        if name not in parts(self._data):
            return
        if self._reading is None or self._reading[:2] != (name, skip):
            self._reading = name, skip, islice(read_part(self._data, name), skip, None)
        records = tuple(islice(self._reading[2], _BATCH))
        self._reading = name, skip + len(records), self._reading[2]
        yield pack(Batch(records))

    def _confirm_merged(self, _key: str, _parameters: str, payload: bytes) -> Iterator[bytes]:
        name = payload.decode()
        if name in parts(self._data):
            mark_merged(self._data, name)
            yield b"told"


class BranchMerge:
    """Merges the branches that the other station has set aside, while this one leads."""

    def __init__(
        self,
        bus: Bus,
        gate: OperatorGate,
        deliver: Callable[[str, bytes], None],
        settled: Callable[[], bool],
        other: Callable[[], str | None],
    ) -> None:
        """``settled``: whether all that was delivered is on the disk.  ``other``: the standby to be
        asked; None: this station does not lead, or is alone.
        """
        self._bus = bus
        self._gate = gate
        self._deliver = deliver
        self._settled = settled
        self._other = other

    def run_round(self, stop: Event) -> None:
        """Merge all branches of the standby; ``stop`` ends it early, and the next round begins the
        unfinished branch again.

        Raises MusterError where the other station's answer is not valid.
        """
        station = self._other()
        if station is None:
            return
        for name in ask(self._bus, station, "apart/names"):
            self._merge(station, name, stop)

    def _merge(self, station: str, name: bytes, stop: Event) -> None:
        taken = 0
        results: dict[str, Future[ActionResult]] = {}  # by action id

        def submit(action: DoneApart | ReportProblem) -> None:
            action_id = _id_of(name, action)
            results[action_id] = self._gate.submit(STATION_ID, action, action_id)

        while True:
            question = b"%s %d" % (name, taken)
            batch = next(iter(ask(self._bus, station, "apart/records", question)), None)
            if batch is None or stop.is_set():
                return  # it has gone again; next time from the beginning
            records = unpack(batch, Batch).records
            if not records:
                break
            for record in records:
                done = self._take(station, record)
                if done is not None:
                    submit(done)
            taken += len(records)
        if results:
            text = coded(
                "acted-apart",
                "While the stations were apart, people acted at {station} ({count} times), and "
                "that is not in force here: the audit names it; do again what still matters",
                station=station,
                count=len(results),
            )
            submit(ReportProblem.of(f"apart {station}", text))
        while not (all(one.done() for one in results.values()) and self._settled()):
            if stop.wait(_SETTLE_S):
                return
        if any(one.exception() for one in results.values()):
            return  # this station does not lead any more: the leader merges it
        for _ in ask(self._bus, station, "apart/told", name):
            logger.warning("%d events that %s had set aside are taken", taken, station)

    def _take(self, station: str, record: Record) -> DoneApart | None:
        """Return the note of a person's action; None: the record has none."""
        t_ns, key, payload = record
        try:
            unit_id, channel = parse_key(key)
        except UnknownChannelError:
            self._deliver(key, payload)
            return None
        if channel.direction is Direction.UP:
            self._deliver(backfilled_key(unit_id, channel.suffix), payload)
        elif channel is OPERATOR:
            action = _persons_action(payload)
            if action is not None:
                return DoneApart(station, t_ns, action.by, _in_words(action))
        return None


def _id_of(part: bytes, action: DoneApart | ReportProblem) -> str:
    """A part that is fetched again, though by a station that has started again, names it once."""
    text = f"{part.decode()} {action}"
    return idempotent_action_id(STATION_ID, text, text.encode(), secrets.token_hex(16))


def _persons_action(payload: bytes) -> OperatorAction | None:
    try:
        message = decode(OPERATOR, payload)
    except WireError:
        return None
    if isinstance(message, OperatorAction) and message.by != STATION_ID:
        return message
    return None


def _in_words(done: OperatorAction) -> str:
    """Text of the action with its fields: a note whole, of a drawing its beginning."""
    action = done.action
    left_out = _NAMES if isinstance(action, Assign) else ()
    fields = (name for name in action.__struct_fields__ if name not in left_out)
    words = (_in_word(name, getattr(action, name)) for name in fields)
    text = f"{type(action).__name__} {', '.join(filter(None, words))}"
    return text if len(text) <= _MOST_LETTERS else f"{text[:_MOST_LETTERS]}…"


def _in_word(name: str, value: object) -> str:
    """Text of one field; empty where it adds nothing."""
    match value:
        case bool():
            return name if value else f"not {name}"
        case Enum():
            return value.name.lower()
        case tuple():
            return ", ".join(map(str, value))
        case str() | int() | float():
            return str(value)
        case _:
            return ""
