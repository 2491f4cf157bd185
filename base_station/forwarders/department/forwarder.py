"""Forwarder to the department: publishes summaries, and sends events until they are stored."""

from __future__ import annotations

import logging
from datetime import UTC, datetime
from pathlib import Path

import msgspec

from base_station.department_wire import Event, EventBatch, EventReceipt, pack, unpack
from base_station.forwarders.connection_status import ConnectionStatus
from base_station.forwarders.department.collector import ReportCollector
from base_station.forwarders.department.config import DepartmentConfig
from base_station.forwarders.department.outbox import DepartmentOutbox, StoredEvent
from base_station.forwarders.interface import Surroundings
from base_station.storage.projection import Projection
from base_station.views.answer import to_ms, to_ms_or_none
from base_station.views.text_code import text_code_view_or_none
from base_station.views.wire import Delta, ForwarderView, Snapshot
from shared.bus import Bus
from shared.bus_zenoh import UnitEndpoint, ZenohBus
from shared.channels import Qos, department_events_key, department_summary_key
from shared.clock import NS_PER_S
from shared.coded_text import code_of_text, coded
from shared.enrolment import Enrolment, Holder, read_enrolment
from shared.errors import ConfigError, WireError
from shared.tls import validity_problem
from shared.worker import Worker

OUTBOX = "department-outbox.sqlite"

_COLLECT_S = 0.2
_SUMMARY_NS = NS_PER_S
_RETRY_S = 1.0
_RECEIPT_TIMEOUT_S = 5.0
_MAX_EVENTS, _MAX_BYTES = 500, 32_000  # of a batch: some seconds on a link of 100 kbit/s
_KEPT_BY_STANDBY = 20_000  # events that the other one of two stations sends
_CLOSE_S = 5.0

logger = logging.getLogger(__name__)
_OTHER_STATION = coded("department-other-station", "it answers another station")


class DepartmentForwarder:
    """``Forwarder`` for ``[department]``."""

    def __init__(self, name: str, config: DepartmentConfig, surroundings: Surroundings) -> None:
        """Raises ConfigError if the enrolment cannot be used."""
        self._name, self._config = name, config
        self._clock, self._leads = surroundings.clock, surroundings.leads
        self._enrolment = _station_enrolment(config.enrolment)
        self._outbox = DepartmentOutbox(surroundings.data / OUTBOX)
        self._collector = ReportCollector(self._outbox, surroundings.people, surroundings.read_log)
        self._summary_due_ns = 0
        self._status = ConnectionStatus(f"department {self._enrolment.connect[0]}", self._clock)
        self._collecting = Worker(
            "department-collector", self._collect, "nothing is collected for the department"
        )
        self._sending = Worker(
            "department-sender", self._send, "the department gets no events of this station"
        )
        self._bus: Bus | None = None  # until it is started

    # ---- from other threads

    def delta(self, delta: Delta) -> None:
        self._collector.delta(delta)

    def reset(self, snapshot: Snapshot) -> None:
        self._collector.reset(snapshot)
        self._collecting.wake()

    def project(self, projection: Projection) -> None:
        self._collector.project(projection)
        if projection.alarms:
            self._collecting.wake()

    def start(self) -> None:
        self._bus = ZenohBus(UnitEndpoint(self._enrolment.connect, self._enrolment.identity))
        self._collecting.start()
        self._sending.start()

    def close(self) -> None:
        for worker in (self._collecting, self._sending):
            worker.stop()
        for worker in (self._collecting, self._sending):
            worker.join(_CLOSE_S)
        if self._bus is not None:
            self._bus.close()
        self._outbox.close()

    def view(self) -> ForwarderView:
        status = self._status
        text = status.reason or self._collecting.fault
        return ForwarderView(
            name=self._name,
            kind="department",
            address=", ".join(self._enrolment.connect),
            state=status.state,
            since_ms=to_ms_or_none(status.since_ns),
            sent=status.sent,
            received=0,
            refused=0,
            text=str(text),
            text_code=text_code_view_or_none(code_of_text(text)),
        )

    def problem(self) -> str:
        away_s = self._status.away_s
        if away_s < self._config.alarm_after_s:
            return ""
        return coded(
            "department-away",
            "The department ({addresses}) has been away for {away_s:.0f} s: {reason}. What it "
            "misses is kept and sent later",
            addresses=", ".join(self._enrolment.connect),
            away_s=away_s,
            reason=self._status.reason,
        )

    # ---- in the collecting thread

    def _collect(self) -> float:
        now_ms = to_ms(self._clock.utc_ns())
        if self._collector.collect(now_ms):
            self._sending.wake()
        now_ns = self._clock.monotonic_ns()
        if now_ns >= self._summary_due_ns and self._leads():
            self._summary_due_ns = max(self._summary_due_ns + _SUMMARY_NS, now_ns)
            self._publish_summary(now_ms)
        return _COLLECT_S

    def _publish_summary(self, now_ms: int) -> None:
        assert self._bus is not None
        key = department_summary_key(self._enrolment.name)
        summary = self._collector.summary(now_ms, self._config.console_url)
        if summary is not None and self._bus.has_subscriber(key):
            self._bus.publish(key, pack(summary), Qos.LIVE)

    # ---- in the sending thread

    def _send(self) -> float:
        """Send a batch, and return the pause until the next one."""
        assert self._bus is not None
        if not self._leads():
            self._status.set("standby")
            self._outbox.keep_newest(_KEPT_BY_STANDBY)
            return _RETRY_S
        if not self._bus.has_subscriber(department_summary_key(self._enrolment.name)):
            self._status.set("connecting", self._away_reason())
            return _RETRY_S
        batch = self._outbox.next_batch(_MAX_EVENTS, _MAX_BYTES)
        if not batch:
            self._status.set("connected")
            return _RETRY_S
        receipt = self._send_batch(self._bus, batch)
        if receipt is None:
            self._status.set(
                "connecting", coded("department-no-receipt", "it does not acknowledge events")
            )
            return _RETRY_S
        if receipt.refusal or receipt.epoch != self._outbox.epoch:
            self._status.set("connected", receipt.refusal or _OTHER_STATION)
            return _RETRY_S
        self._outbox.acknowledge(receipt.stored_seq)
        self._status.sent += sum(one.seq <= receipt.stored_seq for one in batch)
        self._status.set("connected")
        return 0.0

    def _send_batch(self, bus: Bus, batch: tuple[StoredEvent, ...]) -> EventReceipt | None:
        """Send a batch, and return its receipt.  None if none came in time; the department may have
        stored the events nevertheless, and does not store them twice.
        """
        message = EventBatch(
            epoch=self._outbox.epoch,
            t_ms=to_ms(self._clock.utc_ns()),
            after_seq=self._outbox.acknowledged_seq,
            dropped_seq=self._outbox.dropped_seq,
            events=tuple(
                Event(one.seq, one.event_id, one.t_ms, msgspec.Raw(one.body)) for one in batch
            ),
        )
        key = department_events_key(self._enrolment.name)
        for reply in bus.query(key, pack(message), _RECEIPT_TIMEOUT_S):
            try:
                return unpack(reply, EventReceipt)
            except WireError as error:
                logger.warning("a receipt of the department cannot be read: %s", error)
        return None

    def _away_reason(self) -> str:
        now = datetime.fromtimestamp(self._clock.utc_ns() / NS_PER_S, UTC)
        renewal = coded(
            "certificate-renew-there",
            "renew it there with {command}",
            command=self._enrolment.renewal_command,
        )
        return validity_problem(self._enrolment.identity, now, renewal) or (
            coded(
                "department-no-answer",
                "it does not answer; is it switched on, does the network lead there, and has it "
                "enrolled {station}, which is not revoked?",
                station=self._enrolment.name,
            )
        )


def _station_enrolment(path: Path) -> Enrolment:
    """Read the enrolment.  Raises ConfigError if it cannot be read, or is of another kind."""
    enrolment = read_enrolment(path)
    if enrolment.holder is not Holder.DEPARTMENT_STATION:
        raise ConfigError(
            f"{path} enrols the {enrolment.holder.value} {enrolment.name}, not a station: make one "
            "at the department with `muster pki enroll STATION --department-station`"
        )
    return enrolment
