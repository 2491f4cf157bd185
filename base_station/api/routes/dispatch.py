"""In from dispatch: reports from which incidents are opened, and alerts."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Depends, Request

from base_station.api.authentication import Commander, Viewer
from base_station.api.dispatching import (
    Outcome,
    known_dispatch,
    matched_units,
    open_incident_of,
    take_report,
)
from base_station.api.forms import MAX_DISPATCH_BYTES, DispatchNumber, Form
from base_station.api.idempotent_request import Perform
from base_station.api.problems import Problem
from base_station.api.services import Services, Station
from base_station.api.uploads import UploadRoute
from base_station.dispatch.call_signs import MatchedCallSign
from base_station.dispatch.cap import read_alert
from base_station.dispatch.reading import read_report
from base_station.views.answer import Answer
from base_station.views.text_code import text_code_view
from base_station.views.wire import DispatchView, Snapshot, TextCodeView
from shared.coded_text import coded, text_of_error
from shared.errors import WireError
from shared.messages.station import DismissDispatch

router = APIRouter(tags=["dispatch"], route_class=UploadRoute)

_REPORT_TYPES = ("application/json",)
_ALERT_TYPES = ("application/cap+xml", "application/xml", "text/xml")
_REPORT_CONTENT = {
    one: {"schema": {"type": "object", "title": "DispatchReport"}} for one in _REPORT_TYPES
}
_ALERT_CONTENT = {one: {"schema": {"type": "string"}} for one in _ALERT_TYPES}


class CallSignAnswer(Answer, frozen=True):
    """A call sign of a dispatch, and its crew or units at the station."""

    call_sign: str
    words: str
    crew: str
    unit_ids: tuple[str, ...]


class DispatchReceipt(Answer, frozen=True):
    number: str
    outcome: Outcome
    incident_id: str | None
    units: tuple[CallSignAnswer, ...]
    warnings: tuple[str, ...]
    warning_codes: tuple[TextCodeView, ...]


class OfferedDispatch(Answer, frozen=True):
    dispatch: DispatchView
    call_signs: tuple[CallSignAnswer, ...]


class Dismissal(Form):
    number: DispatchNumber


class AlertReceipt(Answer, frozen=True):
    alert_id: str
    outcome: str
    markers: int
    replaced: tuple[str, ...]
    warnings: tuple[str, ...]
    warning_codes: tuple[TextCodeView, ...]


async def _body(request: Request) -> bytes:
    return await request.body()


_Body = Annotated[bytes, Depends(_body)]


@router.post(
    "/dispatch",
    max_body_size=MAX_DISPATCH_BYTES,
    openapi_extra={"requestBody": {"required": True, "content": _REPORT_CONTENT}},
)
def post_dispatch(
    request: Request, station: Station, perform: Perform, body: _Body
) -> DispatchReceipt:
    """Hand in a report of the dispatch centre: a NENA EIDO or a plain JSON object.  It is offered
    on the console; if the settings allow it and no incident is open, it opens one.  A later report
    with the same number updates it.  Parts that cannot be used are left out and named in
    ``warnings``.
    """
    _require_type(request, _REPORT_TYPES)
    try:
        report = read_report(body, station.dispatch, station.clock.utc_ns())
    except WireError as error:
        raise Problem(422, text_of_error(error)) from error
    outcome = take_report(station, perform, report)
    picture = station.picture()
    incident = open_incident_of(picture, report.number)
    return DispatchReceipt(
        number=report.number,
        outcome=outcome,
        incident_id=None if incident is None else incident.incident_id,
        units=_call_signs(station, picture, report.units),
        warnings=report.warnings,
        warning_codes=tuple(map(text_code_view, report.warning_codes)),
    )


@router.get("/dispatch")
def list_dispatches(station: Station, _: Viewer) -> list[OfferedDispatch]:
    """Dispatches from which no incident was opened, oldest first, after that of the open
    incident.
    """
    picture = station.picture()
    incident = picture.incident
    of_incident = () if incident is None or incident.dispatch is None else (incident.dispatch,)
    return [
        OfferedDispatch(one, _call_signs(station, picture, one.units))
        for one in (*of_incident, *picture.dispatches)
    ]


@router.post("/dispatch/dismissals", status_code=204)
def dismiss_dispatch(form: Dismissal, station: Station, perform: Perform) -> None:
    """Remove a dispatch from the console's offers; an incident can still be opened from it."""
    if known_dispatch(station.picture(), form.number) is None:
        raise Problem(
            404, coded("dispatch-not-listed", "There is no dispatch {number}.", number=form.number)
        )
    perform(DismissDispatch(form.number))


@router.post(
    "/dispatch/alerts",
    max_body_size=MAX_DISPATCH_BYTES,
    openapi_extra={"requestBody": {"required": True, "content": _ALERT_CONTENT}},
)
def post_alert(request: Request, station: Station, who: Commander, body: _Body) -> AlertReceipt:
    """Hand in an alert of the Common Alerting Protocol (CAP 1.2). It is shown on the plan until it
    expires; an update or a cancellation removes the alerts to which it refers.
    """
    _require_type(request, _ALERT_TYPES)
    if station.alerts is None:
        raise Problem(
            409, coded("alerts-not-taken", "This station takes no alerts: it only replays.")
        )
    try:
        alert = station.alerts.take(read_alert(body, station.clock.utc_ns()))
    except WireError as error:
        raise Problem(422, text_of_error(error)) from error
    station.records.audit(who.username, "PostedAlert", f"{alert.alert_id}: {alert.outcome}")
    return AlertReceipt(
        alert_id=alert.alert_id,
        outcome=alert.outcome,
        markers=len(alert.markers),
        replaced=alert.replaced,
        warnings=alert.warnings,
        warning_codes=tuple(map(text_code_view, alert.warning_codes)),
    )


def _require_type(request: Request, media_types: tuple[str, ...]) -> None:
    media_type = request.headers.get("content-type", "").partition(";")[0].strip().lower()
    if media_type not in media_types:
        raise Problem(
            415,
            coded(
                "media-type-other",
                "Send it as one of {types} (header Content-Type).",
                types=", ".join(media_types),
            ),
        )


def _call_signs(
    station: Services, picture: Snapshot, call_signs: tuple[str, ...]
) -> tuple[CallSignAnswer, ...]:
    return tuple(map(_call_sign, matched_units(station, picture, call_signs)))


def _call_sign(one: MatchedCallSign) -> CallSignAnswer:
    return CallSignAnswer(one.call_sign, one.words, one.crew, one.unit_ids)
