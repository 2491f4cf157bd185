"""Raw samples that a unit posts itself, and the tokens with which it does."""

from __future__ import annotations

import math
from typing import Annotated

from fastapi import APIRouter, Depends, Request
from pydantic import BaseModel, Field

from base_station.accounts.principals import Role
from base_station.api.authentication import Administrator, Viewer, require_role
from base_station.api.forms import MAX_SAMPLES_BYTES, Form, Id, UnitId
from base_station.api.posted_samples import (
    JSON_TYPE,
    PROTOBUF_TYPE,
    PostedSamples,
    read_json,
    read_protobuf,
)
from base_station.api.problems import Problem
from base_station.api.services import Services, Station
from base_station.api.uploads import UploadRoute
from base_station.engine.sample_intake import SampleIntake
from base_station.views.answer import to_ms, to_ms_or_none
from shared.clock import NS_PER_DAY
from shared.coded_text import coded

router = APIRouter(tags=["samples"], route_class=UploadRoute)

_READERS = {JSON_TYPE: read_json, PROTOBUF_TYPE: read_protobuf}
_CONTENT = {
    JSON_TYPE: {"schema": {"$ref": f"#/components/schemas/{PostedSamples.__name__}"}},
    PROTOBUF_TYPE: {},
}


class SamplesReceipt(BaseModel):
    accepted: int
    repeated: int
    samples: int


class UnitToken(BaseModel):
    token_id: str
    username: str
    created_ms: int
    expires_ms: int | None


class NewUnitToken(Form):
    days: Annotated[int, Field(ge=1, le=3660)] | None = None


class UnitTokenSecret(BaseModel):
    token_id: str
    token: str  # shown this once


async def _body(request: Request) -> bytes:
    return await request.body()


@router.post(
    "/units/{unit_id}/samples",
    max_body_size=MAX_SAMPLES_BYTES,
    openapi_extra={"requestBody": {"required": True, "content": _CONTENT}},
)
def post_samples(
    unit_id: UnitId,
    request: Request,
    station: Station,
    who: Viewer,
    body: Annotated[bytes, Depends(_body)],
) -> SamplesReceipt:
    """Hand in raw inertial samples of a unit, with its token.  They are logged, and tracked by the
    unit's tracking agent, in the same way as those from the bus.  The answer is given once they are
    on disk; a batch that is sent again is stored once.
    """
    intake = _intake_for(unit_id, station, who)
    media_type = request.headers.get("content-type", "").partition(";")[0].strip().lower()
    read = _READERS.get(media_type)
    if read is None:
        raise Problem(415, f"Send the samples as {' or '.join(_READERS)} (header Content-Type).")
    wait_s = intake.wait_s(unit_id, len(body))
    if wait_s > 0.0:
        raise Problem(
            429,
            f"{unit_id} posts more than a unit may; keep the samples, and send them again in "
            f"{math.ceil(wait_s)} s.",
            {"Retry-After": str(math.ceil(wait_s))},
        )
    receipt = intake.take(unit_id, read(unit_id, body))
    return SamplesReceipt(
        accepted=receipt.accepted, repeated=receipt.repeated, samples=receipt.samples
    )


@router.get("/units/{unit_id}/sample-tokens")
def list_unit_tokens(unit_id: UnitId, station: Station, _: Administrator) -> list[UnitToken]:
    return [
        UnitToken(
            token_id=token.token_id,
            username=token.username,
            created_ms=to_ms(token.created_ns),
            expires_ms=to_ms_or_none(token.expires_ns),
        )
        for token in station.accounts.unit_tokens.of(unit_id)
    ]


@router.post("/units/{unit_id}/sample-tokens", status_code=201)
def add_unit_token(
    unit_id: UnitId, new: NewUnitToken, station: Station, who: Administrator
) -> UnitTokenSecret:
    """Create a token with which this unit can post samples, and do nothing else.  It is shown in
    this answer only.
    """
    _require_registered(station, unit_id)
    expires_ns = None if new.days is None else station.clock.utc_ns() + new.days * NS_PER_DAY
    token_id, secret = station.accounts.unit_tokens.add(unit_id, who.username, expires_ns)
    station.records.audit(who.username, "AddedUnitToken", f"{token_id} of unit {unit_id}")
    return UnitTokenSecret(token_id=token_id, token=secret)


@router.delete("/units/{unit_id}/sample-tokens/{token_id}", status_code=204)
def remove_unit_token(unit_id: UnitId, token_id: Id, station: Station, who: Administrator) -> None:
    if not station.accounts.unit_tokens.remove(unit_id, token_id):
        raise Problem(404, coded("unit-token-unknown", "{unit} has no such token.", unit=unit_id))
    station.records.audit(who.username, "RemovedUnitToken", f"{token_id} of unit {unit_id}")


def _intake_for(unit_id: str, station: Services, who: Viewer) -> SampleIntake:
    """Intake for a principal who may post samples of this unit: the unit itself, or an
    administrator.
    """
    if who.unit_id and who.unit_id != unit_id:
        raise Problem(
            403,
            coded(
                "unit-token-of-another",
                "This token is for samples of {unit}, not of {wanted}.",
                unit=who.unit_id,
                wanted=unit_id,
            ),
        )
    if not who.unit_id:
        require_role(who, Role.ADMINISTRATOR)
        _require_registered(station, unit_id)
    if station.intake is None:
        raise Problem(
            409, coded("samples-not-taken", "This station takes no samples: it only replays.")
        )
    return station.intake


def _require_registered(station: Services, unit_id: str) -> None:
    unit = station.roster.unit(unit_id)
    if unit is None or unit.registered_ns is None:
        raise Problem(
            404, coded("sample-unit-unknown", "There is no registered unit {unit}.", unit=unit_id)
        )
