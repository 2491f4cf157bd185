"""Collects reports for the department: events into the outbox, all else into summaries."""

from __future__ import annotations

import socket
from collections import deque
from collections.abc import Callable, Iterable, Iterator

from base_station.department_wire import Summary
from base_station.forwarders.department.events import (
    Differences,
    alarm_event,
    differences,
    forgotten_body,
)
from base_station.forwarders.department.outbox import DepartmentOutbox, NewEvent
from base_station.forwarders.department.summary import incident_summary, person_summary
from base_station.forwarders.mailbox import Mailbox
from base_station.storage.db.known_people import FORGOTTEN, PersonLookup
from base_station.storage.projection import Projection
from base_station.views.wire import AnchorView, Delta, HealthView, IncidentView, Snapshot, UnitView
from shared.channels import ALARM
from shared.clock import NS_PER_MS, NS_PER_S
from shared.codec import decode
from shared.coded_text import TextCode
from shared.errors import WireError
from shared.messages import STATION_ID, AlarmChange

ReadLog = Callable[[int], Iterable[tuple[int, str, bytes]]]

_ALARM_KEY = ALARM.key(STATION_ID)
_OVERLAP_NS = 5 * NS_PER_S  # of the log before the collected part; the ids are the same
_NOTE_EVERY_NS = 10 * NS_PER_S  # up to where the log is collected, where nothing else is written


class ReportCollector:
    """``delta``, ``reset`` and ``project`` are called in the engine's thread, all else in one other
    thread.
    """

    def __init__(self, outbox: DepartmentOutbox, people: PersonLookup, read_log: ReadLog) -> None:
        self._outbox = outbox
        self._people = people
        self._read_log = read_log
        self._mailbox = Mailbox()
        self._projections: deque[Projection] = deque()
        self._units: dict[str, UnitView] = {}
        self._incidents: tuple[IncidentView, ...] = ()
        self._problems: tuple[str, ...] = ()
        self._problem_codes: tuple[TextCode, ...] = ()
        self._anchor: AnchorView | None = None
        self._reported: dict[str, bytes] = {}
        self._noted_ns = 0
        self._has_picture = False
        self._is_up_to_date = False  # decisions before this start may be missing

    # ---- in the engine's thread

    def delta(self, delta: Delta) -> None:
        self._mailbox.put_delta(delta)

    def reset(self, snapshot: Snapshot) -> None:
        self._mailbox.put_picture(snapshot)

    def project(self, projection: Projection) -> None:
        self._projections.append(projection)

    # ---- in the collecting thread

    def collect(self, now_ms: int) -> bool:
        """Put new events into the outbox.  True if there were any.  ``now_ms``: station time.

        Raises StoreError or LogError; the next call then does the same again.
        """
        self._take_picture()
        if not self._has_picture:
            return False
        alarms = [] if self._is_up_to_date else self._alarms_of_log()
        if not self._is_up_to_date:
            self._reported = self._outbox.reported()
        taken = tuple(self._projections)  # more may come meanwhile, which are left
        alarms += [alarm_event(change) for one in taken for change in one.alarms]
        found = differences(
            self._incidents, self._units.values(), self._reported, self._is_forgotten, now_ms
        )
        self._keep(found, alarms, taken)
        self._is_up_to_date = True
        for _ in taken:
            self._projections.popleft()
        return bool(alarms or found.events)

    def summary(self, now_ms: int, console_url: str) -> Summary | None:
        """Return the summary; None while the station's own state is not known yet."""
        if not self._has_picture:
            return None
        open_incidents = [one for one in self._incidents if one.closed_ms is None]
        anchor = self._anchor
        return Summary(
            epoch=self._outbox.epoch,
            t_ms=now_ms,
            host=socket.gethostname(),
            console_url=console_url,
            incidents=tuple(incident_summary(one) for one in open_incidents),
            people=tuple(
                person_summary(unit, "" if unit.duty is None else unit.incident_id or "")
                for unit in self._units.values()
                if unit.registered
            ),
            problems=self._problems,
            waiting=self._outbox.waiting,
            lat_deg=None if anchor is None else anchor.lat_deg,
            lon_deg=None if anchor is None else anchor.lon_deg,
            problem_codes=self._problem_codes,
        )

    def _take_picture(self) -> None:
        changes = self._mailbox.take()
        picture = changes.picture
        if picture is not None:
            self._has_picture = True
            self._units = {unit.unit_id: unit for unit in picture.units}
            self._incidents = picture.incidents
            self._note_problems(picture.health)
            anchors = (picture.anchor, *(one.anchor for one in picture.sites))
            self._anchor = next((one for one in anchors if one is not None), None)
        self._units.update(changes.units)
        if changes.health is not None:
            self._note_problems(changes.health)

    def _note_problems(self, health: HealthView) -> None:
        self._problems = health.problems
        self._problem_codes = tuple(
            TextCode(one.code, one.texts, one.numbers) for one in health.problem_codes
        )

    def _alarms_of_log(self) -> list[NewEvent]:
        """Alarm transitions that were decided but not collected before the station ended."""
        collected_ns = self._outbox.collected_ns
        if collected_ns is None:
            opened_ms = min((one.opened_ms for one in self._incidents), default=None)
            if opened_ms is None:
                return []
            collected_ns = opened_ms * NS_PER_MS
        return [alarm_event(one) for one in self._logged_alarms(collected_ns - _OVERLAP_NS)]

    def _logged_alarms(self, since_ns: int) -> Iterator[AlarmChange]:
        for _, key, payload in self._read_log(max(since_ns, 0)):
            if key != _ALARM_KEY:
                continue
            try:
                change = decode(ALARM, payload)
            except WireError:  # the integrity check reports damage of the log
                continue
            if isinstance(change, AlarmChange):
                yield change

    def _keep(
        self, found: Differences, alarms: list[NewEvent], taken: tuple[Projection, ...]
    ) -> None:
        collected_ns = max((one.t_ns for one in taken), default=None)
        events = [*found.events, *alarms]
        is_due = collected_ns is not None and collected_ns >= self._noted_ns + _NOTE_EVERY_NS
        if not (events or found.reported or is_due):
            return
        self._outbox.add(events, found.reported, collected_ns)
        for subject in found.forgotten:
            self._outbox.rewrite(subject, forgotten_body(subject))
        self._noted_ns = collected_ns or self._noted_ns
        for subject, state in found.reported.items():
            if state is None:
                del self._reported[subject]
            else:
                self._reported[subject] = state

    def _is_forgotten(self, person_id: str) -> bool:
        return self._people(person_id) is FORGOTTEN
