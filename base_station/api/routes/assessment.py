"""Accuracy report of an incident."""

from __future__ import annotations

import msgspec
from fastapi import APIRouter

from base_station.api.authentication import Viewer
from base_station.api.current_tables import CurrentStation
from base_station.api.forms import Id
from base_station.api.routes.incidents import incident_or_404
from base_station.api.routes.trails import hindsight_of
from base_station.replay.assessment.report import IncidentReport, with_people
from base_station.replay.assessment.wearers import wearers

router = APIRouter(tags=["incidents"])


@router.get("/incidents/{incident_id}/assessment")
def assess_incident(incident_id: Id, station: CurrentStation, _: Viewer) -> IncidentReport:
    """Compare the positions and errors shown at the time with those known afterwards."""
    incident = incident_or_404(station, incident_id)
    live = station.records.tracks_of(incident)
    post_processor = hindsight_of(station)
    report = post_processor.assess(incident, live)
    named = with_people(
        report, wearers(station.roster, incident, station.records.members_of(incident))
    )
    return msgspec.structs.replace(named, is_newest=post_processor.is_newest(incident))
