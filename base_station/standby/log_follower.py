"""Fetches the active station's log, and reports how far this one has it on its disk."""

from __future__ import annotations

import logging
import time
from collections.abc import Callable
from threading import Condition, Lock
from typing import NamedTuple, TypeVar

from base_station.core.log_position import START, LogPosition
from base_station.standby.log_ancestry import find_divergence
from base_station.standby.protocol import Batch, LogAncestry, ReplicationAck, key_of, pack, unpack
from base_station.standby.rpc import ask
from base_station.standby.shared_log import SharedLog
from base_station.standby.standby_feed import StandbyFeed
from shared.bus import Bus
from shared.channels import Qos
from shared.errors import MusterError
from shared.worker import Worker

logger = logging.getLogger(__name__)

Answer = TypeVar("Answer")

_TIMEOUT_S = 3.0
_AGAIN_S = 0.2
_SETTLE_S = 0.02  # records in quick succession go to the disk together
_REPORT_S = 0.5
_BACKLOG = 1000  # so many events at once are no longer the last moment's


class Leader(NamedTuple):
    """Station to follow, in one run of its program."""

    station: str
    run: int


class LogFollower:
    """``follow`` a leader, or none; from any thread."""

    def __init__(
        self,
        station: str,
        bus: Bus,
        log: SharedLog,
        feed: StandbyFeed,
        on_parting: Callable[[LogPosition], None],
    ) -> None:
        """``on_parting`` is called once with the place where this log is to be cut."""
        self._station = station
        self._bus = bus
        self._log = log
        self._feed = feed
        self._on_parting = on_parting
        self._changed = Condition()
        self._leader: Leader | None = None
        self._same_log: Leader | None = None  # this log is the beginning of its log
        self._delivering = Lock()
        self.delivered = START  # delivered to the feed up to here
        self._closed = False
        self.in_step = False  # it has stepped the leader's events, but for the last moment
        self.problem = ""  # why it cannot follow, as a sentence for a person
        self._workers = [
            Worker("following", self._follow_leader, "the other station's log is not followed"),
            Worker("confirming", self._confirm, "this station's copy of the log is not confirmed"),
        ]

    def start(self) -> None:
        for worker in self._workers:
            worker.start()

    def follow(self, leader: Leader | None) -> None:
        with self._changed:
            if leader != self._leader:
                self.problem = ""
            self._leader = leader
            self._changed.notify_all()

    def stop_following(self) -> None:
        """Stop: when it returns, nothing more is delivered, whatever is still asked."""
        self.follow(None)
        with self._delivering:
            pass

    def close(self) -> None:
        with self._changed:
            self._closed = True
            self._leader = None
            self._changed.notify_all()
        for worker in self._workers:
            worker.close()

    # ---- fetching

    def _follow_leader(self) -> float:
        with self._changed:
            self.in_step = False
            self._changed.wait_for(lambda: self._leader is not None or self._closed)
            leader = self._leader
        if leader is None:
            return 0.0
        try:
            self._follow(leader)
        except MusterError as error:
            self._note_problem(leader, str(error))
        return _AGAIN_S

    def _note_problem(self, leader: Leader, problem: str) -> None:
        with self._changed:
            if self._is_wanted(leader):
                if problem != self.problem:
                    logger.error("the other station's log cannot be followed: %s", problem)
                self.problem = problem

    def _follow(self, leader: Leader) -> None:
        """Until it is no longer to be followed, or does not answer."""
        if not self._log.wait_reached(self.delivered, _AGAIN_S):
            return  # events that wait to be stepped would be fetched again
        history = self._ask(leader, "history", LogAncestry)
        if history is None or not self._is_wanted(leader):
            return
        mine = LogAncestry(self._log.log_id, self._log.take_overs, self._log.place)
        cut = find_divergence(mine, history)
        self.problem = ""
        if cut is not None:
            self._on_parting(cut)
            self._wait_unwanted(leader)
            return
        with self._changed:
            self._same_log = leader
            self._changed.notify_all()
        self.delivered = mine.place
        while self._is_wanted(leader):
            place = self.delivered
            batch = self._ask(leader, f"records?t={place.t_ns};n={place.events}", Batch)
            if batch is None or not self._deliver(leader, batch):
                return
            at_once = max(len(batch.records), self._feed.waiting)
            self.in_step = self.delivered >= history.place and at_once < _BACKLOG

    def _deliver(self, leader: Leader, batch: Batch) -> bool:
        with self._delivering:
            if not self._is_wanted(leader):
                return False
            for t_ns, _, _ in batch.records:
                self.delivered = self.delivered.next(t_ns)
            self._feed.deliver(batch.records)
            return True

    def _ask(self, leader: Leader, what: str, kind: type[Answer]) -> Answer | None:
        for reply in ask(self._bus, leader.station, what, timeout_s=_TIMEOUT_S):
            return unpack(reply, kind)
        return None

    def _is_wanted(self, leader: Leader) -> bool:
        return self._leader == leader and not self._closed

    def _wait_unwanted(self, leader: Leader) -> None:
        with self._changed:
            self._changed.wait_for(lambda: not self._is_wanted(leader))

    # ---- confirming

    def _confirm(self) -> float:
        """Report the durable place, only while this log is the same as the leader's."""
        with self._changed:
            self._changed.wait_for(self._has_same_log)
            leader = self._leader
        if self._closed or leader is None:
            return 0.0
        if self._log.wait_beyond(self._log.durable, _REPORT_S):
            time.sleep(_SETTLE_S)
            self._log.flush()
        have = ReplicationAck(leader.run, self._log.durable)
        self._bus.publish(key_of(self._station, "have"), pack(have), Qos.LIVE)
        return 0.0

    def _has_same_log(self) -> bool:
        return self._closed or (self._leader is not None and self._same_log == self._leader)
