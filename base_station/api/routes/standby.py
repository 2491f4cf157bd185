"""Role of this station in a pair, and taking over by hand."""

from __future__ import annotations

from fastapi import APIRouter, Response
from pydantic import BaseModel

from base_station.api.authentication import Commander, Viewer
from base_station.api.ha_status import HaStatus
from base_station.api.problems import Problem
from base_station.api.services import Services, Station
from base_station.views.wire import StandbyView
from shared.coded_text import coded

router = APIRouter(tags=["standby"])


class Leads(BaseModel):
    leads: bool


@router.get("/standby")
def get_standby(station: Station, _: Viewer) -> StandbyView:
    return _ha_status_or_404(station).view()


@router.get("/standby/leads")
def get_leads(station: Station, response: Response) -> Leads:
    """Tell whether this station leads.  For the console of the other station, which has another
    origin and is not logged in here yet.
    """
    response.headers["Access-Control-Allow-Origin"] = "*"
    return Leads(leads=station.ha_status is None or station.ha_status.refusal() is None)


@router.post("/standby/take-over", status_code=202)
def take_over(station: Station, who: Commander) -> None:
    """Make this station the leading one; the other one, if it can be reached, becomes its
    standby.
    """
    ha_status = _ha_status_or_404(station)
    station.records.audit(who.username, "TakeOverByHand", ha_status.view().station)
    ha_status.take_over()


def _ha_status_or_404(station: Services) -> HaStatus:
    if station.ha_status is None:
        raise Problem(
            404, coded("station-alone", "This is the only station: it has no [standby] settings.")
        )
    return station.ha_status
