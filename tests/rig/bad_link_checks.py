"""Checks after a bad link between a unit and its station."""

from __future__ import annotations

from tests.bench.faults.command import suffer
from tests.bench.faults.fault_scenarios import BadLink
from tests.bench.faults.site import Site
from tests.rig.lossy_link import CLEAN
from tests.rig.unit_journal import MessageOfUnit

REPORTED_S = 3.0  # that the link is gone, by the lease, and that the unit is heard again
BUSY_S = 2.0  # that a busy machine may take besides; silence alone tells after ten seconds


def assert_nothing_is_lost(site: Site, fault: BadLink, patience_s: float) -> None:
    """Let it happen; afterwards every message is in the log once, what matters most first."""
    before = site.output()
    report = suffer(site, fault, patience_s)
    assert (report.lost, report.duplicates) == (0, 0)
    assert report.received_s is not None
    if fault.link.dark and fault.after == CLEAN:
        assert report.received_s < REPORTED_S + BUSY_S
    assert report.complete_s is not None
    assert report.sent > fault.seconds * 5  # positions alone
    assert report.alerts > 0
    if fault.link.dark and fault.seconds > 3.0:  # the kernel brings what a short one held
        _assert_alerts_come_first(site, before)


def _assert_alerts_come_first(site: Site, before: set[MessageOfUnit]) -> None:
    """Asserts that alerts were fetched first."""
    fetched = [one for one in site.logged() if not one.live and one.message not in before]
    assert len(fetched) > 20
    alerts = [number for number, one in enumerate(fetched) if one.alert]
    assert not alerts or alerts[0] < len(fetched) / 10
