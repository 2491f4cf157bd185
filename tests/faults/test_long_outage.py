"""A unit that is out of reach for ten minutes: nothing that it says meanwhile is lost."""

from __future__ import annotations

import pytest

from base_station.bench.faults.site import Site
from base_station.bench.faults.troubles import TEN_MINUTES
from tests.bad_link import assert_nothing_is_lost
from tests.waiting import PATIENCE_S

pytestmark = pytest.mark.begun_first


@pytest.mark.timeout(TEN_MINUTES.seconds + 4 * PATIENCE_S)
def test_every_message_of_ten_minutes_is_in_the_log_once(troubled: Site) -> None:
    assert_nothing_is_lost(troubled, TEN_MINUTES, PATIENCE_S)
