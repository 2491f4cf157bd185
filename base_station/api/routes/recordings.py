"""Units' raw recordings, pulled over the bus on request."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter
from pydantic import BaseModel, Field

from base_station.api.authentication import Commander, Viewer
from base_station.api.current_tables import CurrentStation
from base_station.api.forms import MAX_TIME_MS, Form, Id, PersonIdText, UnitIdText
from base_station.api.problems import Problem
from base_station.api.routes.incidents import incident_or_404
from base_station.api.services import Services, Station
from base_station.unit_sync.recordings.transfer import TransferRequest
from base_station.unit_sync.recordings.transfer_queue import Pull, TransferQueue
from base_station.views.answer import to_ms
from base_station.views.text_code import text_code_view_or_none
from base_station.views.wire import TextCodeView
from shared.clock import NS_PER_MS
from shared.coded_text import coded

router = APIRouter(tags=["recordings"])


class NewPull(Form):
    """Transfer of the recordings of an incident, or of a window."""

    unit_id: UnitIdText
    incident_id: PersonIdText | None = None
    from_ms: Annotated[int | None, Field(ge=0, le=MAX_TIME_MS)] = None
    to_ms: Annotated[int | None, Field(ge=0, le=MAX_TIME_MS)] = None  # left out: now


class Recording(BaseModel):
    fetch_id: str
    unit_id: str
    by: str
    from_ms: int
    to_ms: int
    state: str  # waiting | fetching | done | failed
    problem: str  # a sentence for a person
    done_bytes: int
    total_bytes: int  # 0: not known yet
    problem_code: TextCodeView | None = None  # of ``problem``, where it has one


@router.get("/recordings")
def list_recordings(station: Station, _: Viewer) -> list[Recording]:
    """Transfers of recordings that are under way, and the last finished ones."""
    return [_recording(pull) for pull in _desk(station).transfers()]


@router.post("/recordings", status_code=202)
def fetch_recording(new: NewPull, station: CurrentStation, who: Commander) -> Recording:
    """Start to transfer a unit's raw recording.  Live data goes first; the transfer continues until
    it is complete, also after restarts and lost links.
    """
    desk = _desk(station)
    if new.unit_id not in station.roster.registered_units():
        raise Problem(404, coded("recording-no-unit", "There is no unit {unit}.", unit=new.unit_id))
    pull = desk.add(who.username, TransferRequest(new.unit_id, *_window(station, new)))
    details = f"{new.unit_id} from {pull.wanted.from_ns} to {pull.wanted.to_ns}"
    station.records.audit(who.username, "FetchedRecording", details)
    return _recording(pull)


@router.delete("/recordings/{fetch_id}", status_code=204)
def stop_recording(fetch_id: Id, station: Station, who: Commander) -> None:
    """Stop a transfer; the received part is kept."""
    if not _desk(station).stop(fetch_id):
        raise Problem(404, coded("recording-gone", "There is no such recording being pulled."))
    station.records.audit(who.username, "StoppedRecording", fetch_id)


def _window(station: Services, new: NewPull) -> tuple[int, int]:
    now_ns = station.clock.utc_ns()
    if (new.incident_id is None) == (new.from_ms is None):
        raise Problem(
            422,
            coded(
                "recording-window-unnamed",
                "Say which window: incident_id, or from_ms and perhaps to_ms.",
            ),
        )
    if new.incident_id is not None:
        incident = incident_or_404(station, new.incident_id)
        return incident.opened_ns, incident.closed_ns or now_ns
    assert new.from_ms is not None
    return new.from_ms * NS_PER_MS, now_ns if new.to_ms is None else new.to_ms * NS_PER_MS


def _desk(station: Services) -> TransferQueue:
    if station.recordings is None:
        raise Problem(
            404, coded("recording-replays-only", "A station that only replays has no units to ask.")
        )
    return station.recordings


def _recording(pull: Pull) -> Recording:
    return Recording(
        fetch_id=pull.fetch_id,
        unit_id=pull.wanted.unit_id,
        by=pull.by,
        from_ms=to_ms(pull.wanted.from_ns),
        to_ms=to_ms(pull.wanted.to_ns),
        state=pull.state.value,
        problem=pull.problem,
        done_bytes=pull.done_bytes,
        total_bytes=pull.total_bytes,
        problem_code=text_code_view_or_none(pull.problem_code),
    )
