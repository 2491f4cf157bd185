"""Incident of another station, from a file that stands alone (decision 119): the trails of its
members as they were shown there.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from base_station.core.events import Received, Rejected, StationEvent, event_of
from base_station.core.person_references import with_names
from base_station.importers.interface import Importer, ImportOptions, TrackPoints, nothing_usable
from base_station.replay.incident_file import IncidentInFile, read_incident_file
from base_station.storage.imports import ImportedContent, ImportedPoint, ImportedTrack
from shared.channels import FUSED, OPERATOR
from shared.coded_text import coded
from shared.errors import UserError
from shared.geo import Anchor
from shared.mcap_log import SegmentReader
from shared.messages import STATION_ID, FusedPosition, OperatorAction
from shared.messages.station import (
    Action,
    Assign,
    AssignIncident,
    CloseIncident,
    OpenIncident,
    SetAnchor,
    Unassign,
)

_MAGIC = b"\x89MCAP0\r\n"
_FUSED_KEY, _OPERATOR_KEY = FUSED.key(STATION_ID), OPERATOR.key(STATION_ID)
_KEYS = frozenset({_FUSED_KEY, _OPERATOR_KEY})
_HOW = "at the other station write it with: muster base export INCIDENT incident.mcap"


def read_station_incident(path: Path, options: ImportOptions) -> ImportedContent:
    """Readable part of the incident.  Raises UserError if it is no incident of another station, or
    no track of it has a position on the Earth.
    """
    whole = read_incident_file(path)
    incident = whole or _incident_in_torn(path)
    if incident.incident_id == options.incident_id:
        raise UserError(
            coded("import-same-incident", "it is this very incident, as this station recorded it")
        )
    found = _Trails(incident)
    with SegmentReader(path) as reader:
        newer = 0
        for record in reader.records(keys=_KEYS):
            event = event_of(*record)
            newer += isinstance(event, Rejected)
            found.take(event)
        damage: list[str] = [
            coded("import-part-damaged", "a part of it cannot be read: {damage}", damage=one)
            for one in dict.fromkeys(reader.damage)
        ]
    if whole is None:
        damage.insert(
            0,
            coded(
                "import-incomplete",
                "the file is not complete: names of people and what came last are lost",
            ),
        )
    if newer:
        damage.append(
            coded(
                "import-other-version",
                "{count} records could not be read: another version of Muster wrote them",
                count=newer,
            )
        )
    if found.unplaced:
        damage.append(
            coded(
                "import-unplaced",
                "{count} positions of before its site was placed are left out",
                count=found.unplaced,
            )
        )
    tracks = tuple(found.tracks())
    if not tracks:
        raise nothing_usable(
            damage,
            coded(
                "import-track-unplaced",
                "no track in it has a place on the Earth: its site has no anchor",
            ),
        )
    return ImportedContent(INCIDENT.name, tracks).with_warnings(damage)


def _incident_in_torn(path: Path) -> IncidentInFile:
    """Incident of a file that breaks off before its header; UserError if it is something else."""
    opened: dict[str, str] = {}
    with SegmentReader(path) as reader:
        topics = {key for _, key, _ in reader.records()}
        for record in reader.records(keys={_OPERATOR_KEY}):
            match _action_of(event_of(*record)):
                case OpenIncident(incident_id=incident_id, name=name):
                    opened[incident_id] = name
    if len(opened) == 1:
        (incident,) = opened.items()
        return IncidentInFile(*incident, {})
    if _OPERATOR_KEY in topics:
        raise UserError(
            coded(
                "import-part-of-log",
                "it is a part of a station's log, not an incident that stands alone: {how}",
                how=_HOW,
            )
        )
    if any(topic.startswith("muster/") for topic in topics):
        raise UserError(
            coded(
                "import-unit-recording",
                "it is a recording of a unit, and no incident: track it with muster edge, or {how}",
                how=_HOW,
            )
        )
    raise UserError(
        coded(
            "import-not-of-muster",
            "nothing in it is of Muster, or nothing can be read: {how}",
            how=_HOW,
        )
    )


def _action_of(event: StationEvent) -> Action | None:
    message = event.message if isinstance(event, Received) else None
    return message.action if isinstance(message, OperatorAction) else None


@dataclass
class _Trails:
    """Trails of the incident's members, from its records in order."""

    incident: IncidentInFile
    unplaced: int = 0  # positions while the site had no anchor
    _points: dict[tuple[str, str], TrackPoints] = field(default_factory=dict)  # by name, unit
    _anchor: Anchor | None = None
    _is_open: bool = False
    _has_all: bool = True  # people who were not moved are in it
    _moved: dict[str, bool] = field(default_factory=dict)  # by unit: into it, or out of it
    _worn: dict[str, str] = field(default_factory=dict)  # names by unit

    def take(self, event: StationEvent) -> None:
        if (action := _action_of(event)) is not None:
            self._act(action)
        elif isinstance(event, Received) and isinstance(event.message, FusedPosition):
            self._add(event.message)

    def _act(self, action: Action) -> None:
        mine = self.incident.incident_id
        match action:
            case OpenIncident(incident_id=incident_id):
                if incident_id == mine:
                    self._is_open, self._has_all = True, not action.beside_others
            case CloseIncident(incident_id=incident_id) if incident_id == mine:
                self._is_open = False
            case AssignIncident(incident_id=incident_id, unit_ids=unit_ids):
                self._moved |= dict.fromkeys(unit_ids, incident_id == mine)
            case SetAnchor(incident_id=incident_id) if incident_id in ("", mine):
                self._anchor = Anchor(
                    action.lat_deg, action.lon_deg, action.height_m, action.plan_rotation_rad
                )
            case Assign(unit_id=unit_id, person_id=person_id):
                self._worn[unit_id] = self._name_of(person_id) or action.person_name or person_id
            case Unassign(unit_id=unit_id):
                self._worn.pop(unit_id, None)

    def _add(self, fused: FusedPosition) -> None:
        if not (self._is_open and self._moved.get(fused.unit_id, self._has_all)):
            return
        if self._anchor is None:
            self.unplaced += 1
            return
        place = self._anchor.to_geodetic(fused.north_m, fused.east_m, fused.down_m)
        who = self._worn.get(fused.unit_id, ""), fused.unit_id
        points = self._points.setdefault(who, TrackPoints())
        points.add(ImportedPoint(fused.t_meas_ns, *place, fused.floor))

    def _name_of(self, person_id: str) -> str:
        known = self.incident.people.get(person_id)
        return "" if known is None else known.name

    def tracks(self) -> Iterator[ImportedTrack]:
        station = with_names(self.incident.name, lambda one: self._name_of(one) or one)
        for (name, unit_id), points in sorted(self._points.items()):
            who = f"{name} ({unit_id})" if name else unit_id
            yield ImportedTrack(f"{who}, {station}", points.take())


INCIDENT = Importer("incident", lambda head: head.startswith(_MAGIC), read_station_incident)
