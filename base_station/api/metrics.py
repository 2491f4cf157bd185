"""Metrics of the station in Prometheus' text format.

They contain no personal data: units appear under their ids, people not at all.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from typing import get_args

import psutil
from prometheus_client import CollectorRegistry, ProcessCollector, generate_latest
from prometheus_client.core import (
    CounterMetricFamily,
    GaugeMetricFamily,
    HistogramMetricFamily,
    Metric,
)
from prometheus_client.registry import Collector

from base_station.api.position_ages import BOUNDS_S, PositionAges
from base_station.core.state.message_stream import Link
from base_station.views.wire import HealthView, Snapshot

_MS_PER_S = 1000.0


class StationCollector(Collector):
    """Collector of the metrics at one moment."""

    def __init__(self, picture: Snapshot, ages: PositionAges, *, consoles: int) -> None:
        self._picture = picture
        self._ages = ages
        self._consoles = consoles

    def collect(self) -> Iterator[Metric]:
        yield from _of_messages(self._picture.health)
        yield from _of_storage(self._picture.health)
        yield from _of_units(self._picture)
        yield from _of_alarms(self._picture)
        yield _position_ages(self._ages)
        yield GaugeMetricFamily(
            "muster_consoles", "Consoles that are watching.", value=self._consoles
        )
        yield GaugeMetricFamily(
            "muster_incident_open",
            "1 while an incident is open.",
            value=self._picture.incident is not None,
        )
        yield GaugeMetricFamily(
            "muster_problems",
            "Problems of the station, as its health page names them.",
            value=len(self._picture.health.problems),
        )
        yield from _of_standby(self._picture.health)
        yield from _of_forwarders(self._picture.health)
        yield from _of_radio(self._picture.health)
        yield from _of_archive(self._picture.health)
        yield _machine_temperatures()


def exposition(picture: Snapshot, ages: PositionAges, *, consoles: int) -> bytes:
    """Text of ``/metrics``, with the metrics of the process itself."""
    registry = CollectorRegistry(auto_describe=False)
    registry.register(StationCollector(picture, ages, consoles=consoles))
    ProcessCollector(registry=registry)
    return generate_latest(registry)


def _of_messages(health: HealthView) -> Iterator[Metric]:
    for name, help_text, count in (
        ("messages", "Messages taken into the log.", health.messages),
        ("messages_undecodable", "Messages that could not be read.", health.undecodable),
        ("messages_repeated", "Messages that came again and were kept once.", health.repeated),
        (
            "messages_left_out",
            "Messages that came faster than the station takes them; fetched from journals later.",
            health.left_out,
        ),
        (
            "messages_missing",
            "Numbers of messages that no unit's journal has any more.",
            health.missing,
        ),
    ):
        yield CounterMetricFamily(f"muster_{name}", help_text, value=count)


def _of_storage(health: HealthView) -> Iterator[Metric]:
    yield GaugeMetricFamily("muster_log_bytes", "Size of the log.", value=health.log_bytes)
    yield GaugeMetricFamily(
        "muster_disk_free_bytes", "Room on the disk of the log.", value=health.disk_free_bytes
    )
    reading = 1.0 if health.reading is None else health.reading
    yield GaugeMetricFamily(
        "muster_log_read_ratio",
        "Part of the log that has been read since the start; live at 1.",
        value=reading,
    )


def _of_units(picture: Snapshot) -> Iterator[Metric]:
    links = Counter(unit.link for unit in picture.units)
    by_link = GaugeMetricFamily("muster_units", "Units by their link.", labels=["link"])
    for link in get_args(Link):
        by_link.add_metric([link], links[link])
    yield by_link
    off = sum(unit.switched_off for unit in picture.units)
    yield GaugeMetricFamily("muster_units_switched_off", "Units switched off in order.", value=off)
    received = GaugeMetricFamily(
        "muster_unit_last_message_timestamp_seconds",
        "Station time of the last message of a unit.",
        labels=["unit_id"],
    )
    ahead = GaugeMetricFamily(
        "muster_unit_clock_ahead_seconds",
        "Clock of a unit less that of the station.",
        labels=["unit_id"],
    )
    std = GaugeMetricFamily(
        "muster_unit_clock_std_seconds",
        "Standard deviation with which a unit knows the station's time.",
        labels=["unit_id"],
    )
    for unit in picture.units:
        if unit.last_heard_ms is not None:
            received.add_metric([unit.unit_id], unit.last_heard_ms / _MS_PER_S)
        if unit.clock is not None:
            ahead.add_metric([unit.unit_id], unit.clock.ahead_ms / _MS_PER_S)
            std.add_metric([unit.unit_id], unit.clock.std_ms / _MS_PER_S)
    yield from (received, ahead, std)


def _of_alarms(picture: Snapshot) -> Iterator[Metric]:
    alarms = GaugeMetricFamily(
        "muster_alarms", "Alarms that are not resolved.", labels=["rule", "state"]
    )
    still_open = (alarm for alarm in picture.alarms if alarm.state != "resolved")
    counts = Counter((alarm.rule, alarm.state) for alarm in still_open)
    for labels, count in sorted(counts.items()):
        alarms.add_metric(labels, count)
    yield alarms


def _of_standby(health: HealthView) -> Iterator[Metric]:
    if health.standby is None:
        return
    active = health.standby.role == "active"
    yield GaugeMetricFamily("muster_station_active", "1 at the active one of two.", value=active)
    yield GaugeMetricFamily(
        "muster_standby_in_step",
        "1 while the standby has what the active station has.",
        value=health.standby.in_step,
    )


def _of_forwarders(health: HealthView) -> Iterator[Metric]:
    labels = ["kind", "name"]
    connected = GaugeMetricFamily(
        "muster_forwarder_connected",
        "1 while the connection with another system, such as a TAK server, is there.",
        labels=labels,
    )
    sent = CounterMetricFamily(
        "muster_forwarder_sent", "Events sent to another system.", labels=labels
    )
    received = CounterMetricFamily(
        "muster_forwarder_received", "Events taken from another system.", labels=labels
    )
    refused = CounterMetricFamily(
        "muster_forwarder_refused",
        "Events of another system that could not be read or were too many.",
        labels=labels,
    )
    for one in health.forwarders:
        connected.add_metric([one.kind, one.name], one.state == "connected")
        sent.add_metric([one.kind, one.name], one.sent)
        received.add_metric([one.kind, one.name], one.received)
        refused.add_metric([one.kind, one.name], one.refused)
    yield from (connected, sent, received, refused)


def _of_radio(health: HealthView) -> Iterator[Metric]:
    recording = GaugeMetricFamily(
        "muster_radio_recording", "1 while a radio channel is recorded.", labels=["name"]
    )
    for one in health.radio:
        recording.add_metric([one.name], one.state == "recording")
    yield recording


def _of_archive(health: HealthView) -> Iterator[Metric]:
    archive = health.archive
    if archive is None:
        return
    yield GaugeMetricFamily(
        "muster_archive_waiting",
        "Closed incidents that are not in the archive yet.",
        value=archive.waiting,
    )
    yield GaugeMetricFamily(
        "muster_archive_reachable",
        "1 while the archive takes incidents.",
        value=archive.state != "away",
    )
    yield CounterMetricFamily(
        "muster_archive_copied", "Incidents copied to the archive.", value=archive.copied
    )


def _position_ages(ages: PositionAges) -> Metric:
    counts = ages.cumulative()
    bounds = [*map(str, BOUNDS_S), "+Inf"]
    return HistogramMetricFamily(
        "muster_position_age_seconds",
        "Age of a live position when it is published to consoles.",
        buckets=list(zip(bounds, counts, strict=True)),
        sum_value=ages.sum_s,
    )


def _machine_temperatures() -> Metric:
    family = GaugeMetricFamily(
        "muster_machine_temperature_celsius",
        "Temperatures of this machine, where it has sensors.",
        labels=["sensor"],
    )
    for chip, readings in psutil.sensors_temperatures().items():
        for number, reading in enumerate(readings):
            family.add_metric([f"{chip}/{reading.label or number}"], reading.current)
    return family
