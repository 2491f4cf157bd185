"""Fetches the active station's log, and says how far this one has it on its disk."""

from __future__ import annotations

import logging
import time
from collections.abc import Callable
from threading import Condition, Lock, Thread
from typing import NamedTuple, TypeVar

from base_station.standby.history import parting
from base_station.standby.places import BEGINNING, Place
from base_station.standby.shared_log import SharedLog
from base_station.standby.standby_feed import StandbyFeed
from base_station.standby.words import Batch, Have, History, key_of, pack, unpack
from shared.bus import Bus
from shared.channels import Qos
from shared.errors import MusterError

logger = logging.getLogger(__name__)

Answer = TypeVar("Answer")

_TIMEOUT_S = 3.0
_AGAIN_S = 0.2
_SETTLE_S = 0.02  # what is written in quick succession goes to the disk together
_SAY_S = 0.5
_BACKLOG = 1000  # so many events at once are no longer the last moment's


class Leader(NamedTuple):
    """Whom to follow: a station, in one run of its program."""

    station: str
    run: int


class Follower:
    """``follow`` a leader, or nobody; from any thread."""

    def __init__(
        self,
        station: str,
        bus: Bus,
        log: SharedLog,
        feed: StandbyFeed,
        on_parting: Callable[[Place], None],
    ) -> None:
        """``on_parting`` is told once where this log has to be cut before it can go on."""
        self._station = station
        self._bus = bus
        self._log = log
        self._feed = feed
        self._on_parting = on_parting
        self._changed = Condition()
        self._leader: Leader | None = None
        self._same_log: Leader | None = None  # what this log holds is the beginning of its log
        self._delivering = Lock()
        self.delivered = BEGINNING  # up to here the feed has it
        self._closed = False
        self.in_step = False  # it has stepped what the leader has, but for the last moment
        self.problem = ""  # why it cannot follow, as a sentence for a person
        self._threads = [
            Thread(target=self._run, name="following", daemon=True),
            Thread(target=self._confirm, name="confirming", daemon=True),
        ]

    def start(self) -> None:
        for thread in self._threads:
            thread.start()

    def follow(self, leader: Leader | None) -> None:
        with self._changed:
            if leader != self._leader:
                self.problem = ""
            self._leader = leader
            self._changed.notify_all()

    def stop_following(self) -> None:
        """When it returns, nothing more is delivered, whatever is still asked."""
        self.follow(None)
        with self._delivering:
            pass

    def close(self) -> None:
        with self._changed:
            self._closed = True
            self._leader = None
            self._changed.notify_all()
        for thread in self._threads:
            thread.join()

    # ---- fetching

    def _run(self) -> None:
        while True:
            with self._changed:
                self.in_step = False
                self._changed.wait_for(lambda: self._leader is not None or self._closed)
                if self._closed or self._leader is None:
                    return
                leader = self._leader
            try:
                self._follow(leader)
            except MusterError as error:
                self._note_problem(leader, str(error))
            self._pause()

    def _note_problem(self, leader: Leader, problem: str) -> None:
        with self._changed:
            if self._is_wanted(leader):
                if problem != self.problem:
                    logger.error("the other station's log cannot be followed: %s", problem)
                self.problem = problem

    def _follow(self, leader: Leader) -> None:
        """Until it is no longer to be followed, or does not answer."""
        if not self._log.wait_reached(self.delivered, _AGAIN_S):
            return  # what waits to be stepped would be asked for again
        history = self._ask(leader, "history", History)
        if history is None or not self._is_wanted(leader):
            return
        mine = History(self._log.log_id, self._log.take_overs, self._log.place)
        cut = parting(mine, history)
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
                self.delivered = self.delivered.then(t_ns)
            self._feed.deliver(batch.records)
            return True

    def _ask(self, leader: Leader, what: str, kind: type[Answer]) -> Answer | None:
        for reply in self._bus.query(key_of(leader.station, what), b"", _TIMEOUT_S):
            return unpack(reply, kind)
        return None

    def _is_wanted(self, leader: Leader) -> bool:
        return self._leader == leader and not self._closed

    def _wait_unwanted(self, leader: Leader) -> None:
        with self._changed:
            self._changed.wait_for(lambda: not self._is_wanted(leader))

    def _pause(self) -> None:
        with self._changed:
            self._changed.wait_for(lambda: self._closed, _AGAIN_S)

    # ---- confirming

    def _confirm(self) -> None:
        """What stands in a log that went its own way says nothing of the leader's."""
        while True:
            with self._changed:
                self._changed.wait_for(self._has_same_log)
                if self._closed or self._leader is None:
                    return
                leader = self._leader
            if self._log.wait_beyond(self._log.durable, _SAY_S):
                time.sleep(_SETTLE_S)
                self._log.flush()
            have = Have(leader.run, self._log.durable)
            self._bus.publish(key_of(self._station, "have"), pack(have), Qos.LIVE)

    def _has_same_log(self) -> bool:
        return self._closed or (self._leader is not None and self._same_log == self._leader)
