"""The channel table and its keys."""

from __future__ import annotations

import pytest

from shared.channels import (
    CHANNELS,
    POSITION,
    Direction,
    Qos,
    backfilled_key,
    channel_of,
    is_backfilled,
    parse_key,
    validate_unit_id,
)
from shared.codec import WIRE_TYPES
from shared.errors import ConfigError, UnknownChannelError


@pytest.mark.parametrize("channel", CHANNELS, ids=lambda channel: channel.name)
def test_every_key_leads_back_to_its_channel(channel):
    assert parse_key(channel.key("FF-01")) == ("FF-01", channel)


def test_a_message_from_a_journal_keeps_its_channel_and_is_distinguished():
    live, fetched = POSITION.key("FF-01"), backfilled_key("FF-01", POSITION.suffix)
    assert parse_key(fetched) == parse_key(live)
    assert is_backfilled(fetched)
    assert not is_backfilled(live)


def test_every_message_has_exactly_one_channel_and_one_wire_type():
    assert {channel.message for channel in CHANNELS} == set(WIRE_TYPES)
    assert len({channel.message for channel in CHANNELS}) == len(CHANNELS)
    assert len({channel.suffix for channel in CHANNELS}) == len(CHANNELS)


def test_the_stations_own_channels_never_reach_the_bus():
    for channel in CHANNELS:
        assert (channel.direction is Direction.STATION) == (channel.qos is Qos.LOCAL)


@pytest.mark.parametrize(
    "key",
    ["", "muster", "muster/v1/FF-01", "muster/v2/FF-01/up/position", "muster/v1/FF-01/up/mood"],
)
def test_a_key_that_no_row_has_is_refused(key):
    with pytest.raises(UnknownChannelError, match="no channel has the key"):
        parse_key(key)


def test_a_message_finds_its_channel(make_position):
    assert channel_of(make_position()) is POSITION


@pytest.mark.parametrize("unit_id", ["FF-01", "a", "Unit_7.b"])
def test_unit_ids_that_can_stand_in_a_key(unit_id):
    assert validate_unit_id(unit_id) == unit_id


@pytest.mark.parametrize("unit_id", ["", "all", "station", "a/b", "*", "a b", "-x", "é", "a" * 65])
def test_unit_ids_that_cannot(unit_id):
    with pytest.raises(ConfigError, match="cannot be used"):
        validate_unit_id(unit_id)
