"""Which of two stations this is, and taking over by hand."""

from __future__ import annotations

from fastapi import APIRouter, Response
from pydantic import BaseModel

from base_station.api.problems import Problem
from base_station.api.security import Commander, Viewer
from base_station.api.services import Services, Station
from base_station.api.standing import Standing
from base_station.views.wire import StandbyView

router = APIRouter(tags=["standby"])


class Leads(BaseModel):
    leads: bool


@router.get("/standby")
def get_standby(station: Station, _: Viewer) -> StandbyView:
    return _standing_or_404(station).view()


@router.get("/standby/leads")
def get_leads(station: Station, response: Response) -> Leads:
    """For the other station's console, of another origin, where nobody is logged in here yet."""
    response.headers["Access-Control-Allow-Origin"] = "*"
    return Leads(leads=station.standing is None or station.standing.refusal() is None)


@router.post("/standby/take-over", status_code=202)
def take_over(station: Station, who: Commander) -> None:
    """This station leads from now on; the other one, where it hears of it, becomes its standby."""
    standing = _standing_or_404(station)
    station.records.audit(who.username, "TakeOverByHand", standing.view().station)
    standing.take_over()


def _standing_or_404(station: Services) -> Standing:
    if station.standing is None:
        raise Problem(404, "This is the only station: it has no [standby] settings.")
    return station.standing
