"""Audio of radio channels that was recorded in an incident, on the same clock as its replay."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Path, Query, Request, Response
from starlette.concurrency import run_in_threadpool

from base_station.api.authentication import Commander, Viewer
from base_station.api.byte_ranges import begins_at_start, ranged_response
from base_station.api.current_tables import CurrentStation
from base_station.api.document import file_response
from base_station.api.forms import MAX_TIME_MS, Id
from base_station.api.problems import Problem
from base_station.api.routes.incidents import incident_or_404
from base_station.api.services import Services, audit_given_out
from base_station.radio.radio_log import RadioLog
from base_station.radio.spans import Span
from base_station.storage.db.window import Window
from base_station.views.answer import Answer, to_ms
from shared.clock import NS_PER_MS
from shared.coded_text import coded, text_of_error
from shared.errors import LogError

router = APIRouter(tags=["radio"])

MAX_SPAN_MS = 3_600_000
AUDIO = "audio/ogg"
ChannelName = Annotated[str, Path(max_length=32, pattern=r"^[A-Za-z0-9][A-Za-z0-9_-]*$")]
AtMs = Annotated[int, Query(ge=0, le=MAX_TIME_MS)]
LengthMs = Annotated[int, Query(ge=1, le=MAX_SPAN_MS)]


class RadioChannelAnswer(Answer, frozen=True):
    """Spans of a radio channel, in order.  Between them nothing was recorded, or the channel was
    silent.
    """

    name: str
    recorded_ms: tuple[tuple[int, int], ...]
    voice_ms: tuple[tuple[int, int], ...]


class RadioAnswer(Answer, frozen=True):
    """Radio channels that were recorded during the incident."""

    from_ms: int
    until_ms: int
    channels: tuple[RadioChannelAnswer, ...]


@router.get("/incidents/{incident_id}/radio")
def list_radio_channels(incident_id: Id, station: CurrentStation, _: Viewer) -> RadioAnswer:
    """Spans in which each radio channel was recorded, and those in which it carried voice."""
    from_ns, until_ns = _incident_span(station, incident_id)
    log = _log(station)
    try:
        found = {name: log.spans(name, from_ns, until_ns) for name in log.channels()}
    except LogError as error:
        raise _unreadable(error) from error
    return RadioAnswer(
        from_ms=to_ms(from_ns),
        until_ms=to_ms(until_ns),
        channels=tuple(
            RadioChannelAnswer(
                name=name,
                recorded_ms=tuple(map(_span_ms, spans.recorded)),
                voice_ms=tuple(map(_span_ms, spans.voice)),
            )
            for name, spans in found.items()
            if spans.recorded
        ),
    )


@router.get(
    "/incidents/{incident_id}/radio/{channel}",
    response_class=Response,
    responses=file_response(AUDIO),
)
async def radio_audio(
    incident_id: Id,
    channel: ChannelName,
    station: CurrentStation,
    who: Commander,
    request: Request,
    from_ms: AtMs,
    length_ms: LengthMs,
) -> Response:
    """Audio of a window as Opus in Ogg: an hour at most, within the incident.  Each second of the
    audio is a second of the incident: times that were not recorded are silent.  Byte ranges can be
    requested.
    """
    window = Window(from_ms * NS_PER_MS, (from_ms + length_ms) * NS_PER_MS)
    content = await run_in_threadpool(_audio, station, incident_id, channel, window)
    if begins_at_start(request):
        await run_in_threadpool(
            audit_given_out, station, who.username, "HeardRadio", f"{channel} of {incident_id}"
        )
    return ranged_response(content, AUDIO, request)


def _audio(station: Services, incident_id: str, channel: str, asked: Window) -> bytes:
    window = asked.within(Window(*_incident_span(station, incident_id)))
    log = _log(station)
    if channel not in log.channels():
        raise Problem(
            404, coded("radio-channel-empty", "Of this radio channel nothing was recorded.")
        )
    if window.from_ns >= window.until_ns:
        raise Problem(
            404,
            coded(
                "radio-window-outside",
                "This window is not in the incident: see /incidents/{{id}}/radio.",
            ),
        )
    try:
        return log.audio(channel, window.from_ns, window.until_ns)
    except LogError as error:
        raise _unreadable(error) from error


def _incident_span(station: Services, incident_id: str) -> tuple[int, int]:
    incident = incident_or_404(station, incident_id)
    return incident.opened_ns, incident.closed_ns or station.clock.utc_ns()


def _log(station: Services) -> RadioLog:
    if station.radio is None:
        raise Problem(404, coded("radio-no-log", "This station has no log."))
    return station.radio


def _unreadable(error: LogError) -> Problem:
    return Problem(503, coded("radio-unreadable", "{reason}.", reason=text_of_error(error)))


def _span_ms(span: Span) -> tuple[int, int]:
    return to_ms(span[0]), to_ms(span[1])
