"""Monitor of the other station: its presence, its progress, and the units that are received."""

from __future__ import annotations

import logging
from collections.abc import Callable

from base_station.core.log_position import LogPosition
from base_station.standby.election import Election
from base_station.standby.protocol import PROTOCOL, PeerHeartbeat, ReplicationAck, key_of, unpack
from shared.bus import Bus
from shared.channels import STATIONS_ROOT, alive_key
from shared.clock import NS_PER_S, Clock
from shared.coded_text import coded
from shared.errors import WireError

logger = logging.getLogger(__name__)

_STRANGER_TIMEOUT_NS = 5 * NS_PER_S


class PeerMonitor:
    """From its making until it is closed; the bus's threads call it."""

    def __init__(
        self,
        station: str,
        run: int,
        bus: Bus,
        clock: Clock,
        election: Election,
        on_beat: Callable[[PeerHeartbeat], None],
        on_have: Callable[[LogPosition], None],
    ) -> None:
        """``run``: of this station's program.  ``election`` and ``on_beat`` receive the other's
        heartbeats, ``on_have`` the place up to which a follower of this log has it.
        """
        self._station = station
        self._run = run
        self._clock = clock
        self._election = election
        self._on_beat = on_beat
        self._on_have = on_have
        self._units: set[str] = set()
        self._stranger: str = ""
        self._stranger_ns = 0  # time of its last heartbeat
        self._declared = [
            bus.subscribe(f"{STATIONS_ROOT}/*/beat", self._receive_beat),
            bus.subscribe(f"{STATIONS_ROOT}/*/have", self._receive_have),
            bus.watch_alive(alive_key("*"), self._note_unit),
            bus.watch_alive(f"{STATIONS_ROOT}/*/alive", self._note_station),
        ]

    @property
    def units(self) -> int:
        """Number of units that are linked with either router, as far as is known here."""
        return len(self._units)

    @property
    def stranger(self) -> str:
        """Reason why a station is no partner, as a sentence for a person; empty: none is there."""
        is_recent = self._clock.monotonic_ns() - self._stranger_ns < _STRANGER_TIMEOUT_NS
        return self._stranger if is_recent else ""

    def close(self) -> None:
        for one in self._declared:
            one.close()

    def _receive_beat(self, key: str, payload: bytes) -> None:
        try:
            beat = unpack(payload, PeerHeartbeat)
        except WireError as error:
            logger.warning("%s: %s", key, error)
            return
        if (beat.station, beat.run) == (self._station, self._run):
            return
        now_ns = self._clock.monotonic_ns()
        if beat.station == self._station:
            self._stranger_ns = now_ns
            self._stranger = coded(
                "standby-same-name",
                "Two stations call themselves {station}: give each a name of its own in [standby]",
                station=beat.station,
            )
        elif beat.protocol != PROTOCOL:
            self._stranger_ns = now_ns
            self._stranger = coded(
                "standby-other-version",
                "Station {station} is of another version: the two cannot stand by for each other "
                "until both are updated",
                station=beat.station,
            )
        else:
            self._election.receive(beat, now_ns)
            self._on_beat(beat)

    def _receive_have(self, key: str, payload: bytes) -> None:
        try:
            have = unpack(payload, ReplicationAck)
        except WireError as error:
            logger.warning("%s: %s", key, error)
            return
        if have.run == self._run:
            self._on_have(have.place)

    def _note_unit(self, key: str, there: bool) -> None:
        (self._units.add if there else self._units.discard)(key)

    def _note_station(self, key: str, there: bool) -> None:
        if key != key_of(self._station, "alive"):
            self._election.note_token(there=there)
