"""State after the first message of a unit."""

from __future__ import annotations

import pytest

from base_station.core.events import event_of
from base_station.core.state import StationState, UnitState
from base_station.core.state.message_stream import STARTS_KEPT
from base_station.engine.admission import Admission, classify
from shared.channels import ALARM, COMMAND, EVENT, TEMPERATURE, backfilled_key, unread_key
from shared.clock import NS_PER_S
from shared.codec import encode
from shared.messages import STATION_ID, Header, Temperature

U = "FF-01"
T_NS = 1_700_000_000 * NS_PER_S


def temperature(seq: int, boot_id: int = 7) -> bytes:
    return encode(Temperature(Header(U, boot_id, seq, 100 * NS_PER_S), 20.0))


@pytest.fixture
def state() -> StationState:
    """The first message of a unit came."""
    unit = UnitState(U)
    unit.accept(TEMPERATURE, Header(U, 7, 1, T_NS), T_NS)
    return StationState(units={U: unit})


@pytest.mark.parametrize(
    "key",
    [
        TEMPERATURE.key(U),
        backfilled_key(U, TEMPERATURE.suffix),
        unread_key(U, 7, 1, "up/later"),
        f"muster/v1/{U}/up/later",  # of a newer program
    ],
)
def test_repeated_message_is_not_logged_again(state: StationState, key: str) -> None:
    assert classify(key, event_of(T_NS, key, temperature(1)), state) is Admission.DUPLICATE
    new = key.replace("7/1/", "7/2/")
    assert classify(new, event_of(T_NS, new, temperature(2)), state) is Admission.ACCEPT


@pytest.mark.parametrize(
    ("key", "admission"),
    [
        (ALARM.key(STATION_ID), Admission.FORGED),
        (EVENT.key(U), Admission.ACCEPT_URGENT),
        (COMMAND.key(U), Admission.ACCEPT_URGENT),
        (f"muster/v1/{U}/what", Admission.ACCEPT),
    ],
)
def test_unreadable_message_is_kept_and_forged_one_rejected(
    state: StationState, key: str, admission: Admission
) -> None:
    assert classify(key, event_of(T_NS, key, b"rotten"), state) is admission


def test_start_beyond_the_possible_rate_is_left_out_and_comes_from_the_journal(
    state: StationState,
) -> None:
    for boot_id in range(8, 7 + STARTS_KEPT):
        state.units[U].accept(TEMPERATURE, Header(U, boot_id, 1, T_NS), T_NS)
    live, later = TEMPERATURE.key(U), backfilled_key(U, TEMPERATURE.suffix)
    for key, admission in ((live, Admission.RESTART_STORM), (later, Admission.ACCEPT)):
        assert classify(key, event_of(T_NS, key, temperature(1, boot_id=99)), state) is admission
