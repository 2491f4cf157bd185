"""A station and a unit that are killed, doubled or out of disk space lose nothing."""

from __future__ import annotations

import pytest

from shared.messages import AlarmState
from tests.bench.faults.command import suffer
from tests.bench.faults.fault_scenarios import FAULTS, BadLink, Clone, Fault
from tests.bench.faults.site import Site

PATIENCE_S = 90.0
# The others are for `muster bench faults`.
SHORT = [fault for fault in FAULTS if not isinstance(fault, BadLink) and not fault.bench_only]


@pytest.mark.parametrize("fault", SHORT, ids=lambda fault: fault.name)
def test_every_message_is_in_the_log_once(troubled: Site, fault: Fault) -> None:
    report = suffer(troubled, fault, PATIENCE_S)
    assert (report.lost, report.duplicates, report.forged) == (0, 0, 0)
    assert report.received_s is not None
    assert report.complete_s is not None
    if isinstance(fault, Clone):
        changes = troubled.alarms("cloned-unit")
        assert changes[0].state is AlarmState.RAISED
