"""A real station and a real unit over a bad radio link: nothing is lost and nothing comes twice."""

from __future__ import annotations

import pytest

from base_station.bench.faults.command import suffer
from base_station.bench.faults.site import Site
from base_station.bench.faults.troubles import FAULTS, BadLink
from base_station.bench.rig.journal import MessageOfUnit

PATIENCE_S = 90.0
# The others are for `muster bench faults`.
SHORT = [fault for fault in FAULTS if isinstance(fault, BadLink) and not fault.is_long]


@pytest.mark.parametrize("fault", SHORT, ids=lambda fault: fault.name)
def test_every_message_is_in_the_log_once(troubled: Site, fault: BadLink) -> None:
    before = troubled.said()
    report = suffer(troubled, fault, PATIENCE_S)
    assert (report.lost, report.duplicates) == (0, 0)
    assert report.heard_s is not None
    assert report.complete_s is not None
    assert report.sent > fault.seconds * 5  # positions alone
    assert report.alerts > 0
    if fault.link.dark and fault.seconds > 3.0:  # the kernel brings what a short one held
        assert_alerts_come_first(troubled, before)


def assert_alerts_come_first(running: Site, before: set[MessageOfUnit]) -> None:
    """Of what was fetched."""
    fetched = [one for one in running.logged() if not one.live and one.message not in before]
    assert len(fetched) > 20
    alerts = [number for number, one in enumerate(fetched) if one.alert]
    assert not alerts or alerts[0] < len(fetched) / 10
