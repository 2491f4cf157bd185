"""Posted samples of a unit: token, both forms, refusals, and storage without duplicates."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import httpx
import numpy as np
import pytest
from google.protobuf.internal.encoder import _VarintBytes  # type: ignore[attr-defined]  # untyped

from base_station.accounts.principals import Role
from base_station.api.forms import MAX_SAMPLES_BYTES
from base_station.api.posted_samples import MAX_SAMPLES
from base_station.engine.sample_intake import BURST_BYTES
from base_station.storage.db.unit_tokens import MOST_OF_A_UNIT
from shared.channels import DESCRIPTION, IMU, NO_TRACKER
from shared.clock import NS_PER_S, ManualClock
from shared.codec import decode, encode
from shared.messages import Header, Message, RawImu, UnitDescription
from tests.rig.bus_ends import ReceivedMessages
from tests.rig.in_process_station import InProcessStation

U = "PHONE-1"
PATH = f"/units/{U}/samples"
TOKENS = f"/units/{U}/sample-tokens"
PROTOBUF = {"Content-Type": "application/x-protobuf"}
RATE_HZ = 100


def batch(seq: int, count: int = 50, **columns: Any) -> dict[str, Any]:
    """Half a second at rest."""
    first_ns = seq * count * NS_PER_S // RATE_HZ
    return {
        "seq": seq,
        "t_ns": [first_ns + row * NS_PER_S // RATE_HZ for row in range(count)],
        "accel_mps2": [[0.0, 0.0, -9.81]] * count,
        "gyro_radps": [[0.0, 0.0, 0.0]] * count,
        **columns,
    }


def body(*batches: dict[str, Any], boot_id: int = 7) -> dict[str, Any]:
    return {"boot_id": boot_id, "batches": list(batches)}


def raw(seq: int, unit_id: str = U, boot_id: int = 7, count: int = 50) -> RawImu:
    t_ns = (np.arange(count) + seq * count) * (NS_PER_S // RATE_HZ)
    header = Header(unit_id, boot_id, seq, int(t_ns[0]))
    return RawImu(header, t_ns, np.full((count, 3), -5.0), np.zeros((count, 3)))


def delimited(messages: Sequence[Message]) -> bytes:
    payloads = map(encode, messages)
    return b"".join(_VarintBytes(len(payload)) + payload for payload in payloads)


@pytest.fixture
async def node(station: InProcessStation, browser: httpx.AsyncClient) -> httpx.AsyncClient:
    """A client with the token of the registered unit."""
    registered = await browser.post("/units", json={"unit_id": U})
    assert registered.status_code == 201, registered.text
    async with station.client(Role.ADMINISTRATOR) as administrator:
        added = await administrator.post(TOKENS, json={})
    assert added.status_code == 201, added.text
    client = station.client()
    client.headers["authorization"] = f"Bearer {added.json()['token']}"
    return client


@pytest.fixture
def received(station: InProcessStation) -> ReceivedMessages:
    """Messages that a tracking agent receives."""
    received = ReceivedMessages()
    bus = station.router.attach_station()
    for channel in (IMU, DESCRIPTION):
        bus.subscribe(channel.key(U), received)
    return received


def published(received: ReceivedMessages) -> list[RawImu]:
    messages = (decode(IMU, payload) for key, payload in received.samples if key == IMU.key(U))
    return [message for message in messages if isinstance(message, RawImu)]


async def test_posted_samples_are_published_on_the_bus(
    station: InProcessStation, node: httpx.AsyncClient, received: ReceivedMessages
) -> None:
    answer = await node.post(PATH, json=body(batch(1), batch(2)))
    assert answer.status_code == 200
    assert answer.json() == {"accepted": 2, "repeated": 0, "samples": 100}
    assert [one.header.seq for one in published(received)] == [1, 2]
    np.testing.assert_allclose(published(received)[0].accel_mps2[0], (0.0, 0.0, -9.81))
    description = decode(DESCRIPTION, received.samples[0][1])
    assert isinstance(description, UnitDescription)
    assert description.rate_hz == pytest.approx(RATE_HZ)
    assert description.tracker == NO_TRACKER
    assert not description.has_magnetometer
    [unit] = station.drive.picture().units
    assert (unit.unit_id, unit.link) == (U, "live")


async def test_a_batch_that_is_sent_again_is_kept_once(node: httpx.AsyncClient) -> None:
    await node.post(PATH, json=body(batch(1), batch(2)))
    again = await node.post(PATH, json=body(batch(2), batch(3)))
    assert again.json() == {"accepted": 1, "repeated": 1, "samples": 50}
    other_run = await node.post(PATH, json=body(batch(2), boot_id=8))
    assert other_run.json()["accepted"] == 1


async def test_messages_of_the_bus_are_published_unchanged(
    node: httpx.AsyncClient, received: ReceivedMessages
) -> None:
    sent = [raw(1), raw(2)]
    answer = await node.post(PATH, content=delimited(sent), headers=PROTOBUF)
    assert answer.json() == {"accepted": 2, "repeated": 0, "samples": 100}
    assert [encode(one) for one in published(received)] == [encode(one) for one in sent]


async def test_missing_value_and_further_sensors_are_forwarded(
    node: httpx.AsyncClient, received: ReceivedMessages
) -> None:
    sent = batch(
        1,
        2,
        accel_mps2=[[None, 0.0, 1.0], [0.0, 0.0, -9.81]],
        mag_ut=[[20.0, 0.0, 40.0]] * 2,
        pressure_pa=[101_325.0, None],
        imu_temperature_degc=[31.5, 31.5],
    )
    assert (await node.post(PATH, json=body(sent))).status_code == 200
    [arrived] = published(received)
    assert np.isnan(arrived.accel_mps2[0, 0])
    assert arrived.mag_ut is not None
    assert arrived.pressure_pa is not None
    assert np.isnan(arrived.pressure_pa[1])
    assert arrived.imu_temperature_degc is not None


@pytest.mark.parametrize(
    ("wrong", "sentence"),
    [
        (batch(0), "batches.0.seq must be 1 or more"),
        (batch(1, t_ns=[1, 2]), "2 times, and a column of 50"),
        (batch(1, 2, t_ns=[5, 5]), "do not rise"),
        (batch(1, 2, gyro_radps=[[0.0, 0.0]] * 2), "batches.0.gyro_radps"),
        (batch(1, 2, accel_mps2=[["x", 0.0, 0.0]] * 2), "must be a number"),
        (batch(1, 1), "two samples or more"),
        (batch(1, MAX_SAMPLES + 1), "too many entries"),
        (batch(1, 2, colour="red"), "colour is not known here"),
    ],
)
async def test_invalid_samples_are_refused_with_a_reason(
    node: httpx.AsyncClient, received: ReceivedMessages, wrong: dict[str, Any], sentence: str
) -> None:
    answer = await node.post(PATH, json=body(wrong))
    assert answer.status_code == 422
    assert sentence in answer.json()["detail"]
    assert received.samples == []


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        (b"", "1 to 1000 batches"),
        (b"\x05abc", "ends within a message"),
        (b"\xff\xff\xff\xff\xff\xff", "ends within a message"),
        (b"\x03abc", "message 1"),
        (delimited([raw(1, unit_id="FF-02")]), "is of unit 'FF-02'"),
        (delimited([raw(1), raw(2, boot_id=8)]), "another boot_id"),
        (delimited([raw(2), raw(1)]), "rises within a request"),
        (delimited([raw(1, count=MAX_SAMPLES + 1)]), f"{MAX_SAMPLES} at most"),
    ],
)
async def test_invalid_messages_are_refused_with_a_reason(
    node: httpx.AsyncClient, content: bytes, sentence: str
) -> None:
    answer = await node.post(PATH, content=content, headers=PROTOBUF)
    assert answer.status_code == 422
    assert sentence in answer.json()["detail"]


async def test_body_of_another_type_or_too_large_is_refused(
    node: httpx.AsyncClient,
) -> None:
    other = await node.post(PATH, content=b"t,x,y", headers={"Content-Type": "text/csv"})
    assert other.status_code == 415
    assert "application/json" in other.json()["detail"]
    assert (await node.post(PATH, content=b"no", headers={"Content-Type": "application/json"})
            ).status_code == 422  # fmt: skip
    large = await node.post(PATH, content=bytes(MAX_SAMPLES_BYTES + 1), headers=PROTOBUF)
    assert large.status_code == 413
    assert "samples 1 MB" in large.json()["detail"]


async def test_excess_of_the_rate_limit_is_refused_with_a_wait(
    node: httpx.AsyncClient, clock: ManualClock
) -> None:
    content = b"\x05" * (MAX_SAMPLES_BYTES - 1)
    for _ in range(BURST_BYTES // MAX_SAMPLES_BYTES):
        assert (await node.post(PATH, content=content, headers=PROTOBUF)).status_code == 422
    refused = await node.post(PATH, content=content, headers=PROTOBUF)
    assert refused.status_code == 429
    wait_s = int(refused.headers["retry-after"])
    clock.advance(wait_s)
    assert (await node.post(PATH, content=content, headers=PROTOBUF)).status_code == 422


async def test_token_of_a_unit_is_limited_to_its_samples(
    station: InProcessStation, node: httpx.AsyncClient, browser: httpx.AsyncClient
) -> None:
    await browser.post("/units", json={"unit_id": "FF-02"})
    other = await node.post("/units/FF-02/samples", json=body(batch(1)))
    assert other.status_code == 403
    assert "samples of PHONE-1" in other.json()["detail"]
    for path in ("/units", "/people", TOKENS):
        assert (await node.get(path)).status_code == 403, path
    async with station.client(Role.COMMANDER) as commander:
        assert (await commander.post(PATH, json=body(batch(1)))).status_code == 403
    async with station.client() as anonymous:
        assert (await anonymous.post(PATH, json=body(batch(1)))).status_code == 401


async def test_a_token_is_listed_without_its_secret_and_ends_when_it_is_removed(
    station: InProcessStation, node: httpx.AsyncClient
) -> None:
    async with station.client(Role.ADMINISTRATOR) as administrator:
        [listed] = (await administrator.get(TOKENS)).json()
        assert "token" not in listed
        own = (await administrator.get("/tokens")).json()
        assert listed["token_id"] not in {one["token_id"] for one in own}
        assert (await administrator.delete(f"/tokens/{listed['token_id']}")).status_code == 404
        assert (await node.post(PATH, json=body(batch(1)))).status_code == 200
        removing = f"{TOKENS}/{listed['token_id']}"
        assert (await administrator.delete(removing)).status_code == 204
        assert (await administrator.delete(removing)).status_code == 404
    assert (await node.post(PATH, json=body(batch(2)))).status_code == 401


async def test_token_survives_its_makers_password_but_not_its_expiry_or_maker(
    station: InProcessStation, node: httpx.AsyncClient, clock: ManualClock
) -> None:
    accounts = station.services.accounts
    accounts.change_user("administrator", "another password", None)
    assert (await node.post(PATH, json=body(batch(1)))).status_code == 200
    _, secret = accounts.unit_tokens.add(U, "administrator", clock.utc_ns() + NS_PER_S)
    assert accounts.of_token(secret) is not None
    clock.advance(1.0)
    assert accounts.of_token(secret) is None
    accounts.add_user("second", "correct horse battery", Role.ADMINISTRATOR)
    accounts.remove_user("administrator")
    assert (await node.post(PATH, json=body(batch(2)))).status_code == 401


async def test_tokens_of_a_unit_are_limited_and_need_its_registration(
    station: InProcessStation, node: httpx.AsyncClient
) -> None:
    async with station.client(Role.ADMINISTRATOR) as administrator:
        for _ in range(MOST_OF_A_UNIT - 1):
            assert (await administrator.post(TOKENS, json={})).status_code == 201
        refused = await administrator.post(TOKENS, json={})
        assert refused.status_code == 409
        unknown = await administrator.post("/units/FF-09/sample-tokens", json={})
        assert unknown.status_code == 404
        assert (await administrator.post("/units/FF-09/samples", json={})).status_code == 404


async def test_node_with_changing_boot_ids_is_refused_with_a_reason(
    node: httpx.AsyncClient,
) -> None:
    for boot_id in range(1, 17):
        answer = await node.post(PATH, json=body(batch(1), boot_id=boot_id))
        assert answer.status_code == 200
    refused = await node.post(PATH, json=body(batch(1), boot_id=99))
    assert refused.status_code == 409
    assert "boot_id must stay the same" in refused.json()["detail"]
