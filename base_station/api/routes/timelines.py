"""Timeline of one unit: measured and stated values over a span, as columns for charts."""

from __future__ import annotations

from typing import Annotated, Any

import msgspec
from fastapi import APIRouter, Query, Response
from starlette.concurrency import run_in_threadpool

from base_station.api.authentication import Viewer
from base_station.api.current_tables import CurrentStation
from base_station.api.forms import MAX_TIME_MS, FromMs, UnitId, UntilMs
from base_station.api.problems import Problem
from base_station.api.services import Services
from base_station.replay.timelines.downsampling import Column
from base_station.replay.timelines.unit_timeline import MAX_SPAN_NS, TimelineRequest
from base_station.storage.db.window import Window
from base_station.views.answer import Answer, to_ms
from base_station.views.wire import TextCodeView
from shared.clock import NS_PER_MS
from shared.coded_text import coded, text_of_error
from shared.errors import LogError, StoreError
from shared.messages import Activity

router = APIRouter(tags=["tracks"])

Buckets = Annotated[int, Query(ge=10, le=2000)]


class TimelineColumn(Answer, frozen=True):
    t_ms: tuple[int, ...]
    values: tuple[float | None, ...]


class TimelineAnswer(Answer, frozen=True):
    unit_id: str
    from_ms: int
    until_ms: int
    temperature_degc: TimelineColumn
    height_m: TimelineColumn
    floor: TimelineColumn
    activity: TimelineColumn
    activity_names: tuple[str, ...]
    battery: TimelineColumn
    position_error_m: TimelineColumn
    silence_s: TimelineColumn
    radio_gaps_ms: tuple[tuple[int, int], ...]
    defects: tuple[str, ...]
    defect_codes: tuple[TextCodeView, ...]


@router.get("/units/{unit_id}/timeline", response_model=TimelineAnswer)
async def unit_timeline(
    unit_id: UnitId,
    station: CurrentStation,
    _: Viewer,
    from_ms: FromMs,
    until_ms: UntilMs = MAX_TIME_MS,
    buckets: Buckets = 600,
) -> Response:
    """Measured and estimated values of a unit over a span of time, downsampled in a way that keeps
    peaks.  Of a span longer than 24 hours the last 24 are given, until now at the latest; the
    answer states its span.
    """
    until_ns = min(until_ms * NS_PER_MS, station.clock.utc_ns())
    from_ns = max(from_ms * NS_PER_MS, until_ns - MAX_SPAN_NS)
    request = TimelineRequest(unit_id, Window(from_ns, until_ns), buckets)
    async with station.timeline_lock:
        return await run_in_threadpool(_timeline, station, request)


def _timeline(station: Services, request: TimelineRequest) -> Response:
    window = request.window
    if station.roster.unit(request.unit_id) is None:
        raise Problem(
            404,
            coded(
                "timeline-no-unit",
                "There is no unit {unit}, registered or linked.",
                unit=request.unit_id,
            ),
        )
    if station.read_timeline is None:
        raise Problem(503, coded("timeline-no-log", "This station has no log to read it from."))
    try:
        timeline = station.read_timeline(request)
    except (LogError, StoreError) as error:
        raise Problem(
            503,
            coded("timeline-none", "There is no timeline: {reason}.", reason=text_of_error(error)),
        ) from error
    answer = TimelineAnswer(
        unit_id=request.unit_id,
        from_ms=to_ms(window.from_ns),
        until_ms=to_ms(window.until_ns),
        activity_names=tuple(activity.name.lower() for activity in Activity),
        **{name: _answered(value) for name, value in msgspec.structs.asdict(timeline).items()},
    )
    return Response(msgspec.json.encode(answer), media_type="application/json")


def _answered(value: object) -> Any:
    if isinstance(value, Column):
        return TimelineColumn(value.t_ms, value.values)
    return value
