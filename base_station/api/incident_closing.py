"""Open alarms of units and people inside, despite which an incident would be closed."""

from __future__ import annotations

from collections.abc import Collection, Sequence

import msgspec

from base_station.api.problems import Problem
from base_station.views.wire import AlarmView, Snapshot, UnitView
from shared.coded_text import Measure, coded

MAX_NAMED = 20  # of each kind, in the sentence; for programs all ids stand beside it


class ClosingObstacles(msgspec.Struct, frozen=True):
    """Open alarms and people inside at the moment at which an incident is closed."""

    alarms: tuple[AlarmView, ...]
    inside: tuple[UnitView, ...]

    def require_known(self, alarm_ids: Collection[str], unit_ids: Collection[str]) -> None:
        """Check that the request to close the incident names all of them; else Problem 409 with
        their names.  With its ``despite_...`` members the request can be repeated.
        """
        alarms = [one for one in self.alarms if one.alarm_id not in alarm_ids]
        inside = [one for one in self.inside if one.unit_id not in unit_ids]
        if not (alarms or inside):
            return
        detail = coded(
            "incident-not-closed",
            "The incident is not closed. {alarms}{inside}To close it all the same, name them in "
            "despite_alarm_ids and despite_unit_ids.",
            alarms=_counted("Open alarms", [alarm.text for alarm in alarms]),
            inside=_counted("Inside", [_name(unit) for unit in inside]),
        )
        members = {
            "despite_alarm_ids": [alarm.alarm_id for alarm in self.alarms],
            "despite_unit_ids": [unit.unit_id for unit in self.inside],
        }
        raise Problem(409, detail, members=members)


def closing_obstacles(picture: Snapshot, incident_id: str) -> ClosingObstacles:
    """Open alarms of an incident's members, and members inside; alarms about the station itself do
    not count.  A member who was inside when the unit was switched off, or lost its link, counts as
    inside.
    """
    members = [one for one in picture.units if one.incident_id == incident_id]
    unit_ids = {one.unit_id for one in members}
    return ClosingObstacles(
        alarms=tuple(
            one for one in picture.alarms if one.unit_id in unit_ids and one.state != "resolved"
        ),
        inside=tuple(one for one in members if one.person and one.inside_since_ms is not None),
    )


def _counted(what: str, texts: Sequence[str]) -> Measure:
    """Sentence with their number and the first of them; none if there are none."""
    rest = len(texts) - MAX_NAMED
    joined = "; ".join([*texts[:MAX_NAMED], *([f"{rest} more"] if rest > 0 else [])])
    return Measure(len(texts), f"{what}: {joined}. " if texts else "")


def _name(unit: UnitView) -> str:
    return unit.person.name if unit.person else unit.unit_id
