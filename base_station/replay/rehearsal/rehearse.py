"""Rehearses thresholds over recorded incidents: one pass over the log for all sets of thresholds,
by the station's own rules, at the moments at which they judged.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import replace

from base_station.core.alarms import ALARMS
from base_station.core.alarms.interface import AlarmRule
from base_station.core.alarms.thresholds import Thresholds
from base_station.core.checkpoint import Checkpoint
from base_station.core.pipeline import StationPipeline
from base_station.fusion.interface import FuserKind
from base_station.replay.past_pipeline import ReplayPipeline
from base_station.replay.playback import Archive, Playback
from base_station.replay.rehearsal.episodes import compare
from base_station.replay.rehearsal.rehearsed_alarms import (
    Rehearsal,
    RehearsalWatch,
    RehearsedAlarms,
)
from base_station.replay.rehearsal.report import (
    RehearsalReport,
    RehearsedIncident,
    RehearsedPoint,
    change_of_pair,
    figures_of,
)
from base_station.storage.db.models import IncidentRow
from base_station.storage.db.records import Records
from base_station.storage.db.window import Window
from base_station.views.text_code import coded_views
from shared.clock import NS_PER_S

Progress = Callable[[float], None]
_NS_PER_HOUR = 3600 * NS_PER_S


class Rehearser:
    """Rehearses sets of thresholds over the incidents of one station."""

    def __init__(
        self,
        archive_of: Callable[[IncidentRow], Archive],
        fuser_kind: FuserKind,
        records: Records,
        recorded_until_ns: Callable[[], int],
    ) -> None:
        """``archive_of``: the log that has an incident.  ``recorded_until_ns``: where an open
        incident ends.
        """
        self._archive_of = archive_of
        self._fuser_kind = fuser_kind
        self._records = records
        self._recorded_until_ns = recorded_until_ns

    def rehearse(
        self,
        incidents: Sequence[IncidentRow],
        points: Sequence[Thresholds],
        swept: str = "",
        on_progress: Progress = lambda _: None,
    ) -> RehearsalReport:
        """Judge by the rules that ``points`` change, with each of them and with the thresholds of
        then; ``on_progress`` receives the fraction done.  A point whose thresholds contradict those
        of the log has a problem and no figures.
        """
        rules = _rules_of(points)
        passes = []
        for number, incident in enumerate(incidents):

            def within(done: float, number: int = number) -> None:
                on_progress((number + done) / len(incidents))

            passes.append(self._pass(incident, rules, points, within))
        rehearsed = tuple(one.incident for one in passes)
        flaws = dict.fromkeys(flaw for one in passes for flaw in one.flaws)
        worn_h = sum(one.worn_h for one in rehearsed)
        return RehearsalReport(
            rehearsed,
            tuple(_point(rules, number, passes, worn_h) for number in range(len(points))),
            swept,
            tuple(map(str, flaws)),
            coded_views(flaws),
        )

    def _pass(
        self,
        incident: IncidentRow,
        rules: Sequence[AlarmRule],
        points: Sequence[Thresholds],
        on_progress: Progress,
    ) -> _Pass:
        from_ns = incident.opened_ns
        until_ns = incident.closed_ns or max(self._recorded_until_ns(), from_ns)
        recorded, rehearsals = Rehearsal(rules, {}), [Rehearsal(rules, one) for one in points]
        watch = RehearsalWatch([recorded, *rehearsals], from_ns, until_ns)

        def make_pipeline(checkpoint: Checkpoint | None) -> StationPipeline:
            return ReplayPipeline(
                ALARMS,
                self._fuser_kind,
                checkpoint,
                make_alarms=lambda rules: RehearsedAlarms(rules, watch),
            )

        archive = self._archive_of(incident)
        playback = Playback(replace(archive, make_pipeline=make_pipeline))
        for _ in playback.seek(from_ns):
            pass
        while not all(one.problem for one in rehearsals):
            if playback.advance(until_ns) is None:
                break
            on_progress((playback.at_ns - from_ns) / max(until_ns - from_ns, 1))
        on_progress(1.0)
        raised = self._records.alarms(Window(from_ns, until_ns + 1))
        live = Counter(one.rule for one in raised)
        return _Pass(
            RehearsedIncident(
                incident.incident_id,
                sum(watch.worn_ns.values()) / _NS_PER_HOUR,
                {rule.name: live[rule.name] for rule in rules},
            ),
            recorded,
            rehearsals,
            tuple(archive.flaws()),
        )


class _Pass:
    """Results of one incident."""

    def __init__(
        self,
        incident: RehearsedIncident,
        recorded: Rehearsal,
        rehearsals: Sequence[Rehearsal],
        flaws: Sequence[str],
    ) -> None:
        self.incident = incident
        self.recorded = recorded
        self.rehearsals = rehearsals
        self.flaws = flaws


def _point(
    rules: Sequence[AlarmRule], number: int, passes: Sequence[_Pass], worn_h: float
) -> RehearsedPoint:
    rehearsals = [one.rehearsals[number] for one in passes]
    thresholds = rehearsals[0].changes
    problem = next((one.problem for one in rehearsals if one.problem), "")
    if problem:
        return RehearsedPoint(thresholds, problem)
    pairs = [
        (one.incident.incident_id, pair)
        for one in passes
        for pair in compare(one.recorded.episodes.all(), one.rehearsals[number].episodes.all())
    ]
    return RehearsedPoint(
        thresholds,
        "",
        figures_of(rules, (pair for _, pair in pairs), worn_h),
        tuple(
            change_of_pair(incident_id, pair)
            for incident_id, pair in pairs
            if pair.recorded_ns != pair.rehearsed_ns
        ),
    )


def _rules_of(points: Sequence[Thresholds]) -> Sequence[AlarmRule]:
    """Rules that any of the points changes, in their order."""
    changed = {key.partition(".")[0] for point in points for key in point}
    return [rule for rule in ALARMS if rule.name in changed]
