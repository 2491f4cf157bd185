"""Acknowledged messages, which the journals may delete, are on the station's disk."""

from __future__ import annotations

from dataclasses import dataclass

import pytest

from base_station.unit_sync.durable_ack import DurableAckGate


@dataclass
class Disk:
    written: int = 0
    on_disk: int = 0


@pytest.mark.parametrize(
    ("on_disk", "is_there"), [(0, False), (9, False), (10, True), (20, True), (30, True)]
)
def test_report_before_the_last_is_on_the_disk(on_disk, is_there):
    disk = Disk()
    reports = DurableAckGate(disk)
    for written in (5, 10, 20):
        disk.written = written
        reports.note_report_received()
    disk.written, disk.on_disk = 30, on_disk
    assert reports.previous_report_is_durable() is is_there


def test_before_two_reports_nothing_is_known():
    disk = Disk(5, 5)
    reports = DurableAckGate(disk)
    assert not reports.previous_report_is_durable()
    reports.note_report_received()
    assert not reports.previous_report_is_durable()
    reports.note_report_received()
    assert reports.previous_report_is_durable()
