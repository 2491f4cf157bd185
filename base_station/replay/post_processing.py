"""Post-processing of an incident: tracks and assessment from all of its data.

The state at the incident's end comes out of the log, by the same pipeline as live, with late data
of its time; the smoother makes trails from all of it.  The result for a closed incident is kept in
the store, and made again when more data of its time has come.
"""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from itertools import takewhile
from typing import TypeVar

import msgspec

from base_station.core.pins.evidence import encounters_of, evidence_of_site
from base_station.core.state import OWN_SITE_ID, StationState
from base_station.fusion.smoothing.interface import Smoother, Solution
from base_station.replay.assessment.report import IncidentReport, assess
from base_station.replay.late_arrivals import apply_late_arrivals
from base_station.replay.playback import Archive, Playback, Record
from base_station.replay.solved_tracks import (
    OPEN_END_NS,
    SolvedIncident,
    Tracks,
    raw_tracks,
    smoothed_tracks,
)
from base_station.site.floor_grid import FloorGrid
from base_station.storage.db.models import IncidentRow
from base_station.storage.db.smoothed import SmoothedTracks
from base_station.views.text_code import coded_views
from shared.clock import NS_PER_MS, NS_PER_S, Clock
from shared.errors import MemoryLimitError
from shared.log_on_change import LogOnChange

_log = logging.getLogger(__name__)
Progress = Callable[[float], None]
Made = TypeVar("Made")
LATELY_NS = 3600 * NS_PER_S  # an incident that closed since is smoothed without being asked
_AGAIN_NS = 300 * NS_PER_S  # after a result that could not be kept: it may have taken long
QUIET_NS = 30 * NS_PER_S  # without news: a journal that is being read brings more of it


@dataclass(frozen=True)
class Smoothed:
    """Result of a smoother for an incident."""

    incident_id: str
    smoother: str
    made_ns: int
    tracks: Tracks  # by unit
    is_kept: bool = True  # else it is worked out again at each request


@dataclass(frozen=True)
class PostProcessingResult:
    """All that is made of an incident."""

    made_ns: int
    smoothed: Tracks
    raw: Tracks
    report: IncidentReport
    is_kept: bool


class PostProcessor:
    """May be asked from any thread; one incident at a time is worked on."""

    def __init__(
        self, archive: Archive, smoother: Smoother, store: SmoothedTracks, clock: Clock
    ) -> None:
        self._archive = archive
        self._smoother = smoother
        self._store = store
        self._clock = clock
        self._working = threading.RLock()
        self._given_up: set[str] = set()  # incidents that could not be smoothed by itself
        self._again_ns = 0  # not before then
        self._keeping = LogOnChange(_log, "what is known of an incident afterwards cannot be kept")
        self._catching_up = LogOnChange(_log, "an incident that closed cannot be looked back on")

    def smoothed(self, incident: IncidentRow) -> Smoothed:
        """As it was made with all that is known of the incident; made now where it was not."""
        return self._cached_or_made(incident, self._cached_trails, self.smooth)

    def smooth(self, incident: IncidentRow, on_progress: Progress = lambda _: None) -> Smoothed:
        """Make it again from the log; ``on_progress`` receives the fraction done."""
        return self._keep(incident, self.known(incident, on_progress), self._clock.utc_ns())

    def _keep(
        self,
        incident: IncidentRow,
        known: SolvedIncident,
        made_ns: int,
        report: IncidentReport | None = None,
    ) -> Smoothed:
        """All of it at once: assessment and trails always belong together."""
        incident_id, smoother = incident.incident_id, self._smoother.name
        tracks = smoothed_tracks(incident, known)
        is_kept = False
        if incident.closed_ns is not None:
            raw = raw_tracks(incident, known)
            packed = None if report is None else msgspec.msgpack.encode(report)
            with self._keeping:
                what = (incident_id, smoother, made_ns, tracks, raw, packed)
                is_kept = self._store.put(*what, _late_data_ns(incident), known.is_outdated)
        return Smoothed(incident_id, smoother, made_ns, tracks, is_kept)

    def catch_up(
        self, incidents: Iterable[IncidentRow], shown: Callable[[IncidentRow], Tracks]
    ) -> None:
        """Smooth and assess an incident that closed lately and was not yet, or of which more is
        known since, so that it is there on request; ``shown`` gives the tracks shown live.
        """
        now_ns = self._clock.utc_ns()
        if now_ns < self._again_ns:
            return
        for incident in incidents:
            incident_id = incident.incident_id
            if incident_id in self._given_up or not self._is_due(incident, now_ns):
                continue
            self._again_ns = now_ns + _AGAIN_NS
            try:
                with self._catching_up:
                    self._catch_up_with(incident, shown(incident))
            except Exception:  # noqa: BLE001  # the station goes on without these trails
                _log.exception("the trails of %s cannot be smoothed", incident_id)
                self._given_up.add(incident_id)
            if incident_id in self._given_up or self._is_made(incident):
                self._again_ns = 0
            return

    def _catch_up_with(self, incident: IncidentRow, shown: Tracks) -> None:
        try:
            self.assess(incident, shown)
        except MemoryLimitError:
            self._given_up.add(incident.incident_id)
            raise

    def _is_due(self, incident: IncidentRow, now_ns: int) -> bool:
        if incident.closed_ns is None:
            return False
        if self._store.has(incident.incident_id):
            return not self._is_enough(incident)
        return now_ns - incident.closed_ns < LATELY_NS

    def is_newest(self, incident: IncidentRow) -> bool:
        """True if its result was made with all data that came since it was closed; a result that is
        not kept is always made anew.
        """
        return not self._store.has(incident.incident_id) or self._is_made(incident)

    def _is_made(self, incident: IncidentRow) -> bool:
        return self._store.has(incident.incident_id, _late_data_ns(incident))

    def _is_enough(self, incident: IncidentRow) -> bool:
        """True if the kept result serves: no data is newer, or a journal is still being read."""
        is_quiet = abs(self._clock.utc_ns() - _late_data_ns(incident)) >= QUIET_NS
        return self._is_made(incident) or (not is_quiet and self._store.has(incident.incident_id))

    def raw(self, incident: IncidentRow) -> Tracks:
        """Each unit's own path, placed where each of its frames began and never corrected; as it
        was made when the incident had closed.
        """
        return self._cached_or_made(
            incident, lambda one: self._store.raw(one.incident_id), self._make_raw
        )

    def assess(self, incident: IncidentRow, live: Tracks) -> IncidentReport:
        """Assessment of the positions, as it was made when the incident had closed; ``live``:
        tracks that were shown, by unit.
        """
        return self._cached_or_made(
            incident, self._cached_report, lambda one: self._assess(one, live)
        )

    def _cached_or_made(
        self,
        incident: IncidentRow,
        kept: Callable[[IncidentRow], Made | None],
        make: Callable[[IncidentRow], Made],
    ) -> Made:
        """Kept result of a closed incident, or else a new one: other callers wait meanwhile."""
        found = self._cached(incident, kept)
        if found is not None:
            return found
        with self._working:
            found = self._cached(incident, kept)
            return make(incident) if found is None else found

    def _cached(
        self, incident: IncidentRow, kept: Callable[[IncidentRow], Made | None]
    ) -> Made | None:
        is_made = incident.closed_ns is not None and self._is_enough(incident)
        return kept(incident) if is_made else None

    def _cached_trails(self, incident: IncidentRow) -> Smoothed | None:
        made = self._store.of(incident.incident_id)
        return None if made is None else Smoothed(incident.incident_id, *made)

    def _cached_report(self, incident: IncidentRow) -> IncidentReport | None:
        kept = self._store.report(incident.incident_id)
        return None if kept is None else read_report(kept)

    def _make_raw(self, incident: IncidentRow) -> Tracks:
        known = self.known(incident)
        if incident.closed_ns is not None:
            self._keep(incident, known, self._clock.utc_ns())
        return raw_tracks(incident, known)

    def _assess(self, incident: IncidentRow, live: Tracks) -> IncidentReport:
        return self.post_process(incident, live).report

    def post_process(
        self, incident: IncidentRow, live: Tracks, on_progress: Progress = lambda _: None
    ) -> PostProcessingResult:
        """Make all of it anew."""
        known, made_ns = self.known(incident, on_progress), self._clock.utc_ns()
        smoothed, raw = smoothed_tracks(incident, known), raw_tracks(incident, known)
        report = assess(
            incident.incident_id,
            self._smoother.name,
            made_ns // NS_PER_MS,
            known.state,
            known.solution.verdicts,
            live,
            smoothed,
            raw,
        )
        flaws = self._flaws()
        report = msgspec.structs.replace(
            report, flaws=tuple(map(str, flaws)), flaw_codes=coded_views(flaws)
        )
        is_kept = False
        if incident.closed_ns is not None:
            is_kept = self._keep(incident, known, made_ns, report).is_kept
        return PostProcessingResult(made_ns, smoothed, raw, report, is_kept)

    def _flaws(self) -> tuple[str, ...]:
        """Flaws of the log: reasons why the result may be incomplete."""
        while self._archive.check_next_chunk():
            pass
        return tuple(self._archive.flaws())

    def known(
        self, incident: IncidentRow, on_progress: Progress = lambda _: None
    ) -> SolvedIncident:
        with self._working:
            until_ns = incident.closed_ns or OPEN_END_NS
            is_outdated = self._archive.watch()
            state = self._state_at(
                incident.incident_id, until_ns, _late_data_ns(incident), on_progress
            )
            site_id = _site_id(state, incident.incident_id)
            site = state.sites[site_id]
            evidence = evidence_of_site(state, site_id, FloorGrid.of(site.placed_plan))
            solution = Solution({}, {})  # no unit has sent anything yet
            if evidence:
                solution = self._smoother.smooth(evidence, encounters_of(state, site))
            on_progress(1.0)
            return SolvedIncident(state, solution, is_outdated)

    def _state_at(
        self, incident_id: str, until_ns: int, late_data_ns: int, on_progress: Progress
    ) -> StationState:
        """State of that time, with later data of that time until ``late_data_ns``."""
        playback = Playback(self._archive)
        begin_ns, end_ns = None, min(until_ns, self._clock.utc_ns())
        for _ in playback.seek(until_ns):
            begin_ns = playback.at_ns if begin_ns is None else begin_ns
            span_ns = max(end_ns - begin_ns, 1)
            on_progress(0.9 * min((playback.at_ns - begin_ns) / span_ns, 1.0))
        if late_data_ns > until_ns:
            apply_late_arrivals(
                playback.pipeline,
                lambda: self._between(until_ns, late_data_ns),
                until_ns,
                _site_id(playback.pipeline.state, incident_id),
            )
        return playback.pipeline.state

    def _between(self, after_ns: int, until_ns: int) -> Iterable[Record]:
        return takewhile(lambda record: record[0] <= until_ns, self._archive.open_log(after_ns + 1))


def _late_data_ns(incident: IncidentRow) -> int:
    """Time of the newest data that came after it was closed; 0: there is none."""
    return incident.late_data_ns or 0  # a row that was not read from the table has none


def _site_id(state: StationState, incident_id: str) -> str:
    """Site of an incident; of one that the log does not have the station's own."""
    incident = state.incidents.get(incident_id)
    return OWN_SITE_ID if incident is None else incident.site_id


def read_report(kept: bytes) -> IncidentReport | None:
    """None where another version of the program wrote it: it is worked out again."""
    try:
        return msgspec.msgpack.decode(kept, type=IncidentReport)
    except msgspec.MsgspecError:
        return None
