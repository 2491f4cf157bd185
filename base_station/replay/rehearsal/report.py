"""Result of a rehearsal, as plain data that JSON can have."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from statistics import median

from base_station.core.alarms.interface import AlarmRule
from base_station.core.alarms.thresholds import Thresholds
from base_station.replay.rehearsal.episodes import EpisodeOutcome, EpisodePair
from base_station.views.answer import Answer
from base_station.views.wire import TextCodeView
from shared.clock import NS_PER_MS, NS_PER_S


class RehearsedIncident(Answer, frozen=True):
    """One incident over which thresholds were rehearsed."""

    incident_id: str
    worn_h: float  # added up over the units that were worn
    live_alarms: dict[str, int]  # by rule: raised at the time, and kept by the station


class EpisodeChange(Answer, frozen=True):
    """An episode that the rehearsed thresholds found otherwise; times in ms since 1970, UTC."""

    incident_id: str
    unit_id: str
    rule: str
    level: str
    outcome: EpisodeOutcome
    recorded_ms: int | None  # by the thresholds in force at the time; None: not found
    rehearsed_ms: int | None


class LevelFigures(Answer, frozen=True):
    """Figures of one level of one rule, over all incidents."""

    rule: str
    level: str
    recorded: int  # episodes by the thresholds in force at the time
    rehearsed: int
    same: int
    earlier: int
    later: int
    missed: int
    added: int
    median_shift_s: float | None  # of those found by both; negative: earlier
    recorded_per_hour: float | None  # of wear; None: no unit was worn
    rehearsed_per_hour: float | None


class RehearsedPoint(Answer, frozen=True):
    """One set of thresholds."""

    thresholds: Thresholds  # the rehearsed ones, by ``rule.field``
    problem: str  # why the rules cannot have them; empty: they can
    levels: tuple[LevelFigures, ...] = ()
    changes: tuple[EpisodeChange, ...] = ()


class RehearsalReport(Answer, frozen=True):
    """Outcome of a rehearsal, or of a sweep over one threshold."""

    incidents: tuple[RehearsedIncident, ...]
    points: tuple[RehearsedPoint, ...]  # one, or those of a sweep
    swept: str = ""  # the threshold that a sweep changes
    flaws: tuple[str, ...] = ()  # of the record: its missing parts
    flaw_codes: tuple[TextCodeView, ...] = ()  # of ``flaws``, in their order

    @property
    def worn_h(self) -> float:
        return sum(one.worn_h for one in self.incidents)


def figures_of(
    rules: Sequence[AlarmRule], pairs: Iterable[EpisodePair], worn_h: float
) -> tuple[LevelFigures, ...]:
    """One for each level of each rule, in their order."""
    by_level: dict[tuple[str, str], list[EpisodePair]] = {
        (rule.name, level): [] for rule in rules for level in rule.levels
    }
    for pair in pairs:
        by_level[pair.rule, pair.level].append(pair)
    return tuple(_figures(*level, found, worn_h) for level, found in by_level.items())


def change_of_pair(incident_id: str, pair: EpisodePair) -> EpisodeChange:
    return EpisodeChange(
        incident_id,
        pair.unit_id,
        pair.rule,
        pair.level,
        pair.outcome,
        _ms(pair.recorded_ns),
        _ms(pair.rehearsed_ns),
    )


def _figures(rule: str, level: str, pairs: Sequence[EpisodePair], worn_h: float) -> LevelFigures:
    counts = dict.fromkeys(EpisodeOutcome, 0)
    for pair in pairs:
        counts[pair.outcome] += 1
    shifts_s = [
        (pair.rehearsed_ns - pair.recorded_ns) / NS_PER_S
        for pair in pairs
        if pair.rehearsed_ns is not None and pair.recorded_ns is not None
    ]
    recorded = len(pairs) - counts[EpisodeOutcome.ADDED]
    rehearsed = len(pairs) - counts[EpisodeOutcome.MISSED]
    return LevelFigures(
        rule,
        level,
        recorded,
        rehearsed,
        same=counts[EpisodeOutcome.SAME],
        earlier=counts[EpisodeOutcome.EARLIER],
        later=counts[EpisodeOutcome.LATER],
        missed=counts[EpisodeOutcome.MISSED],
        added=counts[EpisodeOutcome.ADDED],
        median_shift_s=median(shifts_s) if shifts_s else None,
        recorded_per_hour=recorded / worn_h if worn_h else None,
        rehearsed_per_hour=rehearsed / worn_h if worn_h else None,
    )


def _ms(t_ns: int | None) -> int | None:
    return None if t_ns is None else t_ns // NS_PER_MS
