"""A unit without contact for ten minutes loses no message."""

from __future__ import annotations

import pytest

from tests.bench.faults.fault_scenarios import TEN_MINUTES
from tests.bench.faults.site import Site
from tests.rig.bad_link_checks import assert_nothing_is_lost
from tests.rig.waiting import PATIENCE_S

pytestmark = pytest.mark.begun_first


@pytest.mark.timeout(TEN_MINUTES.seconds + 4 * PATIENCE_S)
def test_every_message_of_ten_minutes_is_in_the_log_once(troubled: Site) -> None:
    assert_nothing_is_lost(troubled, TEN_MINUTES, PATIENCE_S)
