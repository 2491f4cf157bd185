"""Messages between two stations: their bytes are those of older versions."""

from __future__ import annotations

import msgspec
import pytest

from base_station.core.log_position import LogPosition
from base_station.standby.protocol import (
    Batch,
    LogAncestry,
    PeerHeartbeat,
    ReplicationAck,
    pack,
    unpack,
)
from shared.messages.station import TakeOver

POSITION = LogPosition(1_700_000_000_000_000_001, 3)
ENCODED = (  # by commit 8f25b104
    (
        PeerHeartbeat("a", 2, "active", 4, POSITION, True, 99, 7, "https://a", 12),
        "8aa773746174696f6ea161a870726f746f636f6c02a4726f6c65a6616374697665a47465726d04a5706c616365"
        "92cf17979cfe362a000103a9707265666572726564c3a372756e63a5756e69747307a375726ca9687474707"
        "33a2f2f61a4745f6e730c",
    ),
    (ReplicationAck(99, POSITION), "82a372756e63a5706c61636592cf17979cfe362a000103"),
    (
        LogAncestry(5, (TakeOver(4, "a", 6, 1),), POSITION),
        "83a66c6f675f696405aa74616b655f6f766572739184a47465726d04a773746174696f6ea161aa61667465725f"
        "745f6e7306ab61667465725f636f756e7401a5706c61636592cf17979cfe362a000103",
    ),
    (Batch(((7, "k", b"\x01"),)), "81a77265636f726473919307a16bc40101"),
)


@pytest.mark.parametrize(("message", "encoded"), ENCODED)
def test_message_between_stations_has_bytes_of_older_version(
    message: msgspec.Struct, encoded: str
) -> None:
    assert pack(message).hex() == encoded
    assert unpack(bytes.fromhex(encoded), type(message)) == message
