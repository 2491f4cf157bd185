"""Radio audio over the API: list, window in ranges, and rights."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import pytest

from base_station.accounts.principals import Role
from base_station.radio.opus import silence
from base_station.radio.packets import Packet, payload_of
from base_station.radio.radio_log import RadioLog
from base_station.storage.db.models import IncidentRow
from base_station.storage.db.window import EVER
from shared.clock import NS_PER_MS, NS_PER_S
from shared.mcap_log import SegmentWriter, audio_topic
from tests.rig.in_process_station import InProcessStation

OPENED_NS = 1_800_000_000 * NS_PER_S
OPENED_MS = OPENED_NS // NS_PER_MS
ADDRESS = "/incidents/i-1/radio"


@pytest.fixture
def station(station: InProcessStation, tmp_path: Path) -> InProcessStation:
    """With an incident of a minute, of which 12 s are recorded from its 10th second on."""
    with station.store.write() as session:
        closed_ns = OPENED_NS + 60 * NS_PER_S
        session.add(
            IncidentRow(
                incident_id="i-1",
                name="Fire",
                opened_ns=OPENED_NS,
                opened_by="commander",
                closed_ns=closed_ns,
                closed_by="commander",
            )
        )
    log = RadioLog(tmp_path / "radio")
    writer = SegmentWriter(log.folder / "Tac-1")
    for number in range(100):
        voice = [bytes((0x78, number, part)) + bytes(60) for part in range(6)]  # 20 ms each
        for part, data in enumerate(voice if number >= 50 else [silence(6)]):
            t_ns = OPENED_NS + 10 * NS_PER_S + (120 * number + 20 * part) * NS_PER_MS
            writer.write(t_ns, audio_topic("Tac-1"), payload_of(Packet(t_ns, data)))
    writer.close()
    station.services = dataclasses.replace(station.services, radio=log)
    station.app.state.services = station.services
    return station


async def test_spans_of_recording_and_voice_are_listed_by_channel(
    station: InProcessStation,
) -> None:
    async with station.client(Role.VIEWER) as viewer:
        answer = await viewer.get(ADDRESS)
        assert answer.json() == {
            "from_ms": OPENED_MS,
            "until_ms": OPENED_MS + 60_000,
            "channels": [
                {
                    "name": "Tac-1",
                    "recorded_ms": [[OPENED_MS + 10_000, OPENED_MS + 22_000]],
                    "voice_ms": [[OPENED_MS + 16_000, OPENED_MS + 22_000]],
                }
            ],
        }
        assert (await viewer.get("/incidents/none/radio")).status_code == 404


async def test_audio_is_served_in_ranges_and_the_audit_names_the_listener(
    station: InProcessStation,
) -> None:
    window = {"from_ms": OPENED_MS + 5_000, "length_ms": 20_000}
    async with station.client(Role.COMMANDER) as client:
        whole = await client.get(f"{ADDRESS}/Tac-1", params=window)
        assert whole.headers["content-type"] == "audio/ogg"
        assert whole.headers["accept-ranges"] == "bytes"
        content, etag = whole.content, whole.headers["etag"]
        assert content.startswith(b"OggS")
        pieces = b""
        for begin in range(0, len(content), 5_000):
            part = await client.get(
                f"{ADDRESS}/Tac-1",
                params=window,
                headers={
                    "Range": f"bytes={begin}-{begin + 4_999}",
                    "If-Range": etag,
                },
            )
            assert part.status_code == 206
            last = min(begin + 4_999, len(content) - 1)
            assert part.headers["content-range"] == f"bytes {begin}-{last}/{len(content)}"
            pieces += part.content
        assert pieces == content
        last_part = await client.get(
            f"{ADDRESS}/Tac-1", params=window, headers={"Range": "bytes=-100"}
        )
        assert last_part.content == content[-100:]
        beyond = await client.get(
            f"{ADDRESS}/Tac-1", params=window, headers={"Range": f"bytes={len(content)}-"}
        )
        assert beyond.status_code == 416
        another = await client.get(
            f"{ADDRESS}/Tac-1", params=window, headers={"Range": "bytes=1-2", "If-Range": '"x"'}
        )
        assert (another.status_code, another.content) == (200, content)
    entries = [
        (one.by, one.detail)
        for one in station.services.records.audit_entries(EVER)
        if one.action == "HeardRadio"
    ]
    assert entries == [("commander", "Tac-1 of i-1")] * 2  # not each range


@pytest.mark.parametrize(
    ("channel", "from_s", "length_s", "status", "words"),
    [
        ("Tac-2", 0, 10, 404, "nothing was recorded"),
        ("Tac-1", 10, 0, 422, "length_ms"),
        ("Tac-1", 0, 3_601, 422, "length_ms"),
        ("Tac-1", 70, 10, 404, "not in the incident"),
        ("a.b", 0, 10, 422, "channel"),
    ],
)
async def test_invalid_request_is_refused_with_a_reason(
    station: InProcessStation, channel: str, from_s: int, length_s: int, status: int, words: str
) -> None:
    window = {"from_ms": OPENED_MS + from_s * 1_000, "length_ms": length_s * 1_000}
    async with station.client(Role.COMMANDER) as client:
        refused = await client.get(f"{ADDRESS}/{channel}", params=window)
        assert refused.status_code == status
        assert words in refused.text


async def test_exported_incident_has_audio_for_permitted_users_only(
    station: InProcessStation,
) -> None:
    address = "/incidents/i-1/incident.mcap"
    async with station.client(Role.VIEWER) as viewer:
        assert (await viewer.get(address, params={"radio": True})).status_code == 403
    _, secret = station.services.accounts.add_token(
        "commander", "exports alone", Role.COMMANDER, None, frozenset({"exports"})
    )
    async with station.client() as token:
        token.headers["Authorization"] = f"Bearer {secret}"
        assert (await token.get(address, params={"radio": True})).status_code == 403
