"""This station as one of two: sends heartbeats, receives the other's, and takes its place.

A thread looks several times a second.  Whatever changes who leads is decided there, and by
``Election`` alone.
"""

from __future__ import annotations

import logging
import secrets
from collections.abc import Callable
from dataclasses import dataclass
from threading import Event

from base_station.config import StandbyConfig
from base_station.core.log_position import START, LogPosition
from base_station.engine.log_feed import LogFeed
from base_station.engine.station_clock import SteadyClock
from base_station.security.router.peer_router_probe import accepts_connections
from base_station.standby.election import LACKING_LEASES, Election, LocalStatus
from base_station.standby.log_follower import Leader, LogFollower
from base_station.standby.log_sender import LogSender
from base_station.standby.peer_monitor import PeerMonitor
from base_station.standby.protocol import PROTOCOL, PeerHeartbeat, key_of, pack
from base_station.standby.shared_log import SharedLog
from base_station.standby.standby_feed import StandbyFeed
from base_station.standby.sync_ack import ReplicaProgress
from base_station.views.wire import StandbyView
from shared.bus import Bus
from shared.channels import OPERATOR, Qos
from shared.clock import NS_PER_S
from shared.codec import encode
from shared.coded_text import coded
from shared.header_factory import HeaderFactory
from shared.messages import STATION_ID, OperatorAction
from shared.messages.station import TakeOver
from shared.worker import Worker

logger = logging.getLogger(__name__)

_POLL_INTERVAL_S = 0.2
_STEP_S = 5.0  # that the drive may take for the delivered events


@dataclass(frozen=True)
class HaDependencies:
    """Dependencies of one station of a pair."""

    bus: Bus
    log: SharedLog
    disk: LogFeed
    feed: StandbyFeed
    clock: SteadyClock
    on_lead: Callable[[], None]  # this station takes over
    start_again: Callable[[LogPosition | None], None]  # as a standby; cut the log behind the place


class HaController:
    """``start`` it when the drive runs; ``close`` it when the drive has ended."""

    def __init__(self, config: StandbyConfig, around: HaDependencies) -> None:
        self._config = config
        self._around = around
        clock, log = around.clock, around.log
        self.copy = ReplicaProgress(clock, lambda: log.place, config.confirm_s)
        self._election = Election(round(config.lease_s * NS_PER_S), clock.monotonic_ns())
        self._run_id = secrets.randbits(63)
        self._header_factory = HeaderFactory(STATION_ID, secrets.randbits(63), clock)
        self._by_hand = Event()  # a person has asked for the take-over
        self._ends = False  # it is going to start again
        self._follower = LogFollower(config.name, around.bus, log, around.feed, self._start_again)
        self._shipping = LogSender(config.name, around.bus, log, around.disk, lambda: self.leads)
        self._hearing = PeerMonitor(
            config.name,
            self._run_id,
            around.bus,
            clock,
            self._election,
            on_beat=self._note_beat,
            on_have=self._note_copy,
        )
        self._token = around.bus.declare_alive(key_of(config.name, "alive"))
        self._worker = Worker(
            "pair",
            self._update,
            "the standby's thread failed; it goes on",
            retry_s=_POLL_INTERVAL_S,
            first_after_s=_POLL_INTERVAL_S,
        )

    def start(self) -> None:
        self._follower.start()
        self._worker.start()

    def close(self) -> None:
        """Call it when the drive has ended: the last records still go to the other station."""
        self._worker.close()
        if self.leads:
            self.copy.drain()
        self.copy.close()
        self._follower.close()
        self._shipping.close()
        self._hearing.close()
        self._token.close()

    # ---- from any thread

    @property
    def leads(self) -> bool:
        return self._election.role == "active" and not self._ends

    @property
    def in_step(self) -> bool:
        """True if this standby has all records of the active station but the very last."""
        return self._follower.in_step

    def refusal(self) -> str | None:
        """Reason why nothing can be done here; None: this station leads."""
        if self.leads:
            return None
        other = self._election.other
        if other is not None and other.role == "active":
            where = f" at {other.url}" if other.url else ""
            return f"this is the standby: the active station is {other.station}{where}"
        return "this station does not lead yet; try again in some seconds"

    def followed(self) -> str | None:
        """The active station, where that is another one and its heartbeats arrive."""
        other = self._election.other
        if self.leads or other is None or other.role != "active":
            return None
        return self.reachable_peer()

    def reachable_peer(self) -> str | None:
        """The other station, while its heartbeats arrive."""
        other = self._election.other
        there = self._election.is_peer_alive(self._around.clock.monotonic_ns())
        return other.station if other is not None and there else None

    def others_run(self) -> int:
        """Run of its program that the other station is in, by its last heartbeat."""
        other = self._election.other
        return other.run if other is not None else 0

    def take_over(self) -> None:
        """A person wants this station to lead, whatever it receives; soon."""
        self._by_hand.set()
        self._worker.wake()

    def problems(self) -> tuple[str, ...]:
        """Sentences for the console."""
        return tuple(self._problems())

    def view(self) -> StandbyView:
        other, now_ns = self._election.other, self._around.clock.monotonic_ns()
        there = other is not None and self._election.is_peer_alive(now_ns)
        in_step = self.copy.is_followed and not self.copy.is_behind if self.leads else self.in_step
        return StandbyView(
            station=self._config.name,
            role=self._election.role,
            url=self._config.url,
            other=other.station if other is not None else "",
            other_role=other.role if other is not None and there else "",
            other_url=other.url if other is not None else "",
            in_step=in_step,
        )

    # ---- received messages

    def _note_beat(self, beat: PeerHeartbeat) -> None:
        """The time at a standby is that of the station that leads."""
        if beat.role == "active" and beat.t_ns and not self.leads:
            self._around.clock.agree(beat.t_ns)

    def _note_copy(self, place: LogPosition) -> None:
        if self.leads:
            self.copy.note(place)

    # ---- in the thread

    def _update(self) -> float:
        by_hand = self._by_hand.is_set()
        self._by_hand.clear()
        if not self._ends:
            self._decide(by_hand=by_hand)
        return _POLL_INTERVAL_S

    def _decide(self, *, by_hand: bool) -> None:
        now_ns = self._around.clock.monotonic_ns()
        other = self._election.other
        me = self._me()
        waits = self._election.role == "waiting" or self._election.is_undecided
        if waits and not self.leads and not self._election.is_peer_alive(now_ns):
            me = me._replace(other_listens=accepts_connections(self._config.peer))
        decision = self._election.decide(me, now_ns)
        if by_hand and not self.leads:
            decision = "lead"
        if decision == "lead":
            self._lead()
        elif decision == "step back":
            logger.warning("another station has taken over: starting again as its standby")
            self._start_again(None)
        elif decision == "follow":
            self._election.role = "standby"
            self._around.log.follows = True
        elif self._around.log.is_cut_short and not self._around.log.is_behind:
            logger.warning("the disk takes the log again: starting again to fetch what is missing")
            self._start_again(None)
        if self._election.role == "standby" and other is not None and other.role == "active":
            self._follower.follow(Leader(other.station, other.run))
        if self.leads:
            self.copy.check()
        self._publish_beat()

    def _lead(self) -> None:
        """Step all fetched events, then the take-over, then the messages of the bus."""
        around, other = self._around, self._election.other
        self._follower.stop_following()
        around.log.follows = around.log.is_cut_short = (
            False  # a log with a hole is better than none
        )
        around.log.wait_offered(self._follower.delivered, _STEP_S)
        place, offered = around.log.place, around.log.offered
        around.clock.not_before(offered.t_ns)
        term = max(around.log.term, other.term if other is not None else 0) + 1
        header = self._header_factory.header()
        action = TakeOver(term, self._config.name, place.t_ns, place.events)
        action_id = f"{header.boot_id:016x}-{header.seq}"
        message = OperatorAction(header, action_id, STATION_ID, action)
        t_ns = max(header.t_utc_ns, offered.t_ns)
        around.feed.deliver([(t_ns, OPERATOR.key(STATION_ID), encode(message))])
        around.feed.lead()
        around.log.wait_offered(offered.next(t_ns), _STEP_S)
        self._election.role = "active"
        logger.warning("%s takes over (term %d)", self._config.name, term)
        around.on_lead()

    def _start_again(self, cut: LogPosition | None) -> None:
        self._ends = True
        self._around.start_again(cut)

    def _me(self) -> LocalStatus:
        log, config = self._around.log, self._config
        received_ns = self._around.feed.unit_received_ns
        return LocalStatus(
            config.name,
            config.preferred,
            log.term,
            log.place,
            log.offered,
            self._hearing.units,
            received_ns,
        )

    def _publish_beat(self) -> None:
        """No beat comes from a station that leads and writes no log, as it should every second."""
        if self._ends or self._is_stuck():
            return
        me = self._me()
        beat = PeerHeartbeat(
            station=me.station,
            protocol=PROTOCOL,
            role=self._election.role,
            term=me.term,
            place=me.place,
            preferred=me.preferred,
            run=self._run_id,
            units=me.units,
            url=self._config.url,
            t_ns=self._around.clock.utc_ns(),
        )
        self._around.bus.publish(key_of(me.station, "beat"), pack(beat), Qos.ALERT)

    def _is_stuck(self) -> bool:
        if self._election.role != "active":
            return False
        silent_ns = self._around.clock.monotonic_ns() - self._around.log.written_ns
        return silent_ns > self._config.lease_s * NS_PER_S

    def _problems(self) -> list[str]:
        of_role = self._leader_problem() if self.leads else self._standby_problem()
        return [one for one in (self._hearing.stranger, of_role, self._follower.problem) if one]

    def _leader_problem(self) -> str:
        if not self.copy.is_followed:
            return coded(
                "standby-none",
                "There is no standby: what is done now is on this station alone",
            )
        if self.copy.is_behind:
            return coded(
                "standby-behind",
                "The standby is behind: what is done now is on this station alone",
            )
        return ""

    def _standby_problem(self) -> str:
        other = self._election.other
        if self._election.is_cut_off(self._around.clock.monotonic_ns()):
            assert other is not None
            return coded(
                "standby-cut-off",
                "No message of {station} or of any unit arrives: this station is probably cut "
                "off. It takes over as soon as it receives a unit, or by hand",
                station=other.station,
            )
        if self.followed() is None:
            return self._problem_without_leader()
        if self._around.log.is_cut_short or self._around.log.problem:
            return coded(
                "standby-disk",
                "The disk of this standby does not take the log: free or mend it; what is "
                "missing is fetched then",
            )
        if not self.in_step:
            return coded(
                "standby-fetching",
                "This standby has not got everything of the active station yet",
            )
        return ""

    def _problem_without_leader(self) -> str:
        if self._around.log.place == START:
            return coded(
                "standby-empty",
                "No active station is reachable, and this new standby has nothing yet: it waits",
            )
        if self._election.lacks_log:
            other = self._election.other
            assert other is not None
            return coded(
                "standby-lacks-log",
                "{station} is not reachable, and this standby has not got everything of it: "
                "it waits {wait_s:.0f} s for it to come back, and takes over then, or by hand",
                station=other.station,
                wait_s=LACKING_LEASES * self._config.lease_s,
            )
        return coded(
            "standby-takes-over",
            "No active station is reachable: this one takes over in some seconds",
        )
