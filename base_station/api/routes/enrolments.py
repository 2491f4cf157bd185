"""Enrolments of units, made in the console and shown once as a QR code; an administrator's work."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from datetime import datetime, timedelta
from typing import Annotated

from fastapi import APIRouter, Depends, Request
from pydantic import BaseModel, Field

from base_station.api.authentication import Administrator
from base_station.api.forms import Form, UnitIdText
from base_station.api.problems import Problem
from base_station.api.services import Services, Station
from base_station.security.pki.folder import PkiFolder
from base_station.security.pki.qr import qr_code, rows_of
from base_station.views.answer import to_ms
from shared.channels import validate_unit_id
from shared.clock import NS_PER_S
from shared.coded_text import coded, text_of_error
from shared.enrolment import Holder
from shared.errors import ConfigError, UserError
from shared.host_names import is_loopback
from shared.tls import parse_certificate

router = APIRouter(tags=["enrolments"])

_NO_ENROLMENTS = coded(
    "enrols-none", "This station enrols no units now: it only replays, or is still starting."
)
_NO_AUTHORITY = coded(
    "no-authority",
    "This station has no certificate authority, so no unit can be enrolled: "
    "make one with `muster pki init`, and let the bus listen on tls/.",
)
_NOT_PRIVATE = coded(
    "enrolment-not-private",
    "An enrolment holds a private key, which others on the network could read "
    "on its way to you: serve the console over TLS, or enrol on the station's "
    "own machine.",
)


class EnrolledUnit(BaseModel):
    unit_id: str
    valid_to_ms: int


class NewEnrolment(Form):
    unit_id: UnitIdText
    days: Annotated[int, Field(ge=1, le=3650)] = 365
    renew: bool = False


class ShownEnrolment(BaseModel):
    unit_id: str
    valid_to_ms: int
    text: str
    qr_rows: list[str]


@router.get("/enrolments")
def list_enrolments(station: Station, _: Administrator) -> list[EnrolledUnit]:
    """Units with a valid certificate that is not revoked.  The answer contains no secret."""
    with _as_refusal():
        registry = _authority(station).registry()
    return [
        EnrolledUnit(unit_id=one.name, valid_to_ms=_ms(one.valid_to))
        for one in sorted(registry.entries, key=lambda entry: entry.name)
        if one.holder is Holder.UNIT and one.revoked is None
    ]


def _require_private(request: Request, station: Station, _: Administrator) -> None:
    """Dependency: refuses unless the answer goes over TLS or stays on this machine."""
    if not station.secure and (request.client is None or not is_loopback(request.client.host)):
        raise Problem(403, _NOT_PRIVATE)


@router.post("/enrolments", status_code=201, dependencies=[Depends(_require_private)])
def add_enrolment(new: NewEnrolment, station: Station, who: Administrator) -> ShownEnrolment:
    """Enrol a unit: make its certificate and private key.  The station does not keep the key, so
    this answer cannot be given twice; if it was lost, renew the enrolment.
    """
    validate_unit_id(new.unit_id)
    authority = _authority(station)
    with _as_refusal():
        issue = authority.renew if new.renew else authority.enroll
        enrolment = issue(new.unit_id, valid=timedelta(days=new.days))
    # Before it is handed out: without an audit entry it is not shown.
    action = "RenewedEnrolment" if new.renew else "MadeEnrolment"
    station.records.audit(who.username, action, f"of unit {new.unit_id}")
    certificate = parse_certificate(enrolment.identity.certificate, "certificate")
    return ShownEnrolment(
        unit_id=new.unit_id,
        valid_to_ms=_ms(certificate.not_valid_after_utc),
        text=enrolment.to_compact(),
        qr_rows=rows_of(qr_code(enrolment)),
    )


def _authority(station: Services) -> PkiFolder:
    if station.pki is None:
        raise UserError(_NO_ENROLMENTS)
    if not station.pki.path.exists():
        raise UserError(_NO_AUTHORITY)
    return station.pki


@contextmanager
def _as_refusal() -> Iterator[None]:
    """Answer a refusal of the certificate authority by a problem, as the request itself was
    valid.
    """
    try:
        yield
    except ConfigError as error:
        raise UserError(text_of_error(error)) from error


def _ms(at: datetime) -> int:
    return to_ms(round(at.timestamp()) * NS_PER_S)
