"""Ways to a member who is down: the nearest rescuers, their routes, and their guidance."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Query

from base_station.api.authentication import Viewer
from base_station.api.forms import Form, UnitId, UnitIdText
from base_station.api.guidance import Guide, Guiding
from base_station.api.idempotent_request import Perform
from base_station.api.problems import Problem
from base_station.api.route_answers import RouteAnswer, find_routes
from base_station.api.services import Station
from base_station.views.answer import Answer, to_ms
from shared.coded_text import coded

router = APIRouter(tags=["commands"])


class GuideForm(Form):
    """Rescuer who is sent to the member."""

    rescuer_id: UnitIdText


class GuideAnswer(Answer, frozen=True):
    """Guidance of a rescuer to a member."""

    rescuer_id: str
    unit_id: str
    by: str
    text: str
    sent_ms: int


@router.get("/units/{unit_id}/routes")
def routes_to_member(
    unit_id: UnitId,
    station: Station,
    _: Viewer,
    rescuer_id: Annotated[UnitIdText | None, Query()] = None,
) -> list[RouteAnswer]:
    """Routes to a member: of the three rescuers with the shortest known ways, the nearest first, or
    of the rescuer that is named.  If fewer than three have a known way, those nearest in a straight
    line follow.
    """
    return find_routes(station, unit_id, rescuer_id)


@router.get("/guides")
def list_guides(guidance: Guiding, _: Viewer) -> list[GuideAnswer]:
    """Rescuers who are guided now."""
    return [_answer(guide) for guide in guidance.guides()]


@router.post("/units/{unit_id}/guides", status_code=201)
def begin_guide(
    unit_id: UnitId, form: GuideForm, station: Station, guidance: Guiding, perform: Perform
) -> GuideAnswer:
    """Guide a rescuer to a member.  The next legs of the route are sent to the rescuer's unit as
    messages, now and as the rescuer advances, until the member's alarms are resolved.  A rescuer is
    guided to one member at a time.
    """
    return _answer(guidance.begin(station, perform.by, unit_id, form.rescuer_id, perform))


@router.delete("/guides/{rescuer_id}", status_code=204)
def end_guide(rescuer_id: UnitId, station: Station, guidance: Guiding, perform: Perform) -> None:
    """End the guidance of a rescuer, whose unit is notified."""
    if not guidance.end(station, rescuer_id, perform):
        raise Problem(404, coded("rescuer-not-guided", "This rescuer is not guided."))


def _answer(guide: Guide) -> GuideAnswer:
    return GuideAnswer(guide.rescuer_id, guide.unit_id, guide.by, guide.text, to_ms(guide.sent_ns))
