"""A real station and a real unit over a bad radio link: nothing is lost and nothing comes twice,
and a link that is gone is told, as is one that is back.
"""

from __future__ import annotations

from contextlib import ExitStack

import pytest

from base_station.bench.faults.command import suffer
from base_station.bench.faults.site import UNIT, Site
from base_station.bench.faults.troubles import FAULTS, BadLink
from base_station.bench.rig.console import Console
from base_station.bench.rig.journal import MessageOfUnit
from base_station.bench.rig.lossy_link import CLEAN, DARK
from tests.waiting import until

PATIENCE_S = 90.0
TOLD_S = 3.0  # that the link is gone, by the lease, and that the unit is heard again
BUSY_S = 2.0  # that a busy machine may take besides; silence alone tells after ten seconds
# The others are for `muster bench faults`.
SHORT = [fault for fault in FAULTS if isinstance(fault, BadLink) and not fault.is_long]


@pytest.mark.parametrize("fault", SHORT, ids=lambda fault: fault.name)
def test_every_message_is_in_the_log_once(troubled: Site, fault: BadLink) -> None:
    before = troubled.said()
    report = suffer(troubled, fault, PATIENCE_S)
    assert (report.lost, report.duplicates) == (0, 0)
    assert report.heard_s is not None
    if fault.link.dark and fault.after == CLEAN:
        assert report.heard_s < TOLD_S + BUSY_S
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


def test_a_console_shows_within_seconds_that_nothing_comes_any_more_and_that_it_comes_again(
    troubled: Site,
) -> None:
    """Nobody says goodbye: packets just end."""
    with ExitStack() as closing:
        console = troubled.link.station.call(lambda: Console(troubled.station.api, closing))
        wait_shown(console, "live", PATIENCE_S)
        troubled.link.set(DARK)
        wait_shown(console, "stale", TOLD_S + BUSY_S)
        troubled.link.set(CLEAN)
        wait_shown(console, "live", TOLD_S + BUSY_S)


def wait_shown(console: Console, link: str, patience_s: float) -> None:
    until(lambda: console.links.get(UNIT) == link, f"{UNIT} is shown as {link}", patience_s)
