"""Events of a record: only possible ones step the pipeline."""

from __future__ import annotations

import pytest

from base_station.core.events import MONOTONIC_MAX_NS, UTC_MAX_NS, Received, Rejected, event_of
from shared.channels import TEMPERATURE
from shared.codec import encode
from shared.messages import Header, Temperature

U = "FF-01"
KEY = TEMPERATURE.key(U)


def event_at(t_mono_ns: int, t_utc_ns: int) -> Received | Rejected:
    header = Header(U, 7, 1, t_mono_ns, t_utc_ns)
    return event_of(1, KEY, encode(Temperature(header, 20.0)))


@pytest.mark.parametrize(
    ("t_mono_ns", "t_utc_ns"),
    [(-(2**63), 0), (2**63 - 1, 0), (MONOTONIC_MAX_NS, 0), (0, -1), (0, UTC_MAX_NS)],
)
def test_impossible_times_are_kept_and_not_stepped(t_mono_ns: int, t_utc_ns: int) -> None:
    """Their differences would not fit into the saved live state."""
    event = event_at(t_mono_ns, t_utc_ns)
    assert isinstance(event, Rejected)
    assert "make no sense" in event.reason


def test_usual_times_are_stepped() -> None:
    assert isinstance(event_at(10**15, 1_800_000_000 * 10**9), Received)
    assert isinstance(event_at(0, 0), Received)  # 0: the unit does not know UTC
