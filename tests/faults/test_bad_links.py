"""A station and a unit over a bad radio link: nothing is lost or doubled, and a lost and a
restored link are reported.
"""

from __future__ import annotations

from contextlib import ExitStack

import pytest

from tests.bench.faults.bus_identities import UNIT
from tests.bench.faults.fault_scenarios import FAULTS, TEN_MINUTES, BadLink
from tests.bench.faults.site import Site
from tests.rig.bad_link_checks import BUSY_S, REPORTED_S, assert_nothing_is_lost
from tests.rig.console_client import Console
from tests.rig.lossy_link import CLEAN, DARK
from tests.rig.waiting import until

PATIENCE_S = 90.0
# The others are for `muster bench faults`; ten minutes are begun before all other tests.
SHORT = [
    fault
    for fault in FAULTS
    if isinstance(fault, BadLink) and not fault.bench_only and fault is not TEN_MINUTES
]


@pytest.mark.parametrize("fault", SHORT, ids=lambda fault: fault.name)
def test_every_message_is_in_the_log_once(troubled: Site, fault: BadLink) -> None:
    assert_nothing_is_lost(troubled, fault, PATIENCE_S)


def test_console_shows_loss_and_return_of_the_link_within_seconds(
    troubled: Site,
) -> None:
    """Nobody says goodbye: packets just end."""
    with ExitStack() as closing:
        console = troubled.link.station.call(lambda: Console(troubled.station.api, closing))
        wait_shown(console, "live", PATIENCE_S)
        troubled.link.set(DARK)
        wait_shown(console, "stale", REPORTED_S + BUSY_S)
        troubled.link.set(CLEAN)
        wait_shown(console, "live", REPORTED_S + BUSY_S)


def wait_shown(console: Console, link: str, patience_s: float) -> None:
    until(lambda: console.links.get(UNIT) == link, f"{UNIT} is shown as {link}", patience_s)
