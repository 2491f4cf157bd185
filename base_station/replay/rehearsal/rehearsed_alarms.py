"""Alarm manager of a replay that lets the same rules judge by other thresholds beside, at the very
moments at which the station's own alarms are judged.

People's acknowledgements and resolutions belong to the alarms of then, so they are left out on both
sides: an alarm that only a person resolves ends with its condition here.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import msgspec

from base_station.core.alarms.alarm_manager import AlarmManager
from base_station.core.alarms.interface import AlarmRule, Finding, Verdict
from base_station.core.alarms.thresholds import Thresholds, changed_rule, with_thresholds
from base_station.core.state import Alarm, StationState, UnitState
from base_station.replay.rehearsal.episodes import EpisodeRecord
from shared.clock import NS_PER_S
from shared.errors import ConfigError
from shared.messages import Message

LONGEST_NS = 5 * NS_PER_S  # between two looks at a unit: the station's tick is one a second


class Rehearsal:
    """One set of thresholds, and the episodes that some rules find by it."""

    def __init__(self, rules: Sequence[AlarmRule], changes: Thresholds) -> None:
        """``changes``: by ``rule.field``; they go before the thresholds of the log."""
        self.changes = changes
        self.episodes = EpisodeRecord()
        self._impossible = ""  # why the rules cannot have these thresholds now
        self._was_impossible = ""  # the same, of a time that was judged
        self._rules = tuple(rules)
        self._levels = {rule.name: rule.levels for rule in rules}
        self._state = StationState()  # its alarms alone
        self.use_thresholds({})

    @property
    def problem(self) -> str:
        """The reason why the rules cannot have these thresholds; empty: they can."""
        return self._was_impossible or self._impossible

    def use_thresholds(self, recorded: Thresholds) -> None:
        """``recorded``: those of the log, from now on."""
        self._impossible = ""
        try:
            rules = [changed_rule(rule, recorded | self.changes) for rule in self._rules]
        except (ConfigError, msgspec.ValidationError) as error:
            if self.changes:
                self._impossible = str(error)
            rules = list(with_thresholds(self._rules, recorded))
        self._alarms = AlarmManager([_EndingRule(rule) for rule in rules])

    def review(self, t_ns: int, unit: UnitState, came: type[Message] | None) -> None:
        """Judge the unit at station time ``t_ns``."""
        self._was_impossible = self._was_impossible or self._impossible
        self._state.t_ns = t_ns
        for alarm in self._alarms.review(self._state, unit, came):
            if alarm.rule in self._levels:
                self.episodes.note(alarm, self._levels[alarm.rule])


class RehearsedAlarms(AlarmManager):
    """Keeps the alarms as they were, and lets rehearsals judge too."""

    def __init__(self, rules: Sequence[AlarmRule], watch: RehearsalWatch) -> None:
        self._watch = watch
        super().__init__(rules)

    def use_thresholds(self, thresholds: Thresholds) -> None:
        super().use_thresholds(thresholds)
        self._watch.use_thresholds(thresholds)

    def review(
        self, state: StationState, unit: UnitState, came: type[Message] | None = None
    ) -> Iterator[Alarm]:
        self._watch.review(state.t_ns, unit, came)
        return super().review(state, unit, came)


class RehearsalWatch:
    """Rehearsals over one time of a log, and for how long units were worn in it."""

    def __init__(self, rehearsals: Sequence[Rehearsal], from_ns: int, until_ns: int) -> None:
        self._rehearsals = rehearsals
        self._from_ns = from_ns
        self._until_ns = until_ns
        self._reviewed_ns: dict[str, int] = {}
        self.worn_ns: dict[str, int] = {}  # by unit

    def use_thresholds(self, recorded: Thresholds) -> None:
        for rehearsal in self._rehearsals:
            rehearsal.use_thresholds(recorded)

    def review(self, t_ns: int, unit: UnitState, came: type[Message] | None) -> None:
        if not self._from_ns <= t_ns <= self._until_ns:
            return
        self._note_wear(t_ns, unit)
        for rehearsal in self._rehearsals:
            rehearsal.review(t_ns, unit, came)

    def _note_wear(self, t_ns: int, unit: UnitState) -> None:
        before_ns = self._reviewed_ns.get(unit.unit_id, t_ns)
        self._reviewed_ns[unit.unit_id] = t_ns
        if unit.wearer.person is not None and t_ns - before_ns <= LONGEST_NS:
            self.worn_ns[unit.unit_id] = self.worn_ns.get(unit.unit_id, 0) + t_ns - before_ns


class _EndingRule:
    """A rule whose findings end with their condition, even latched ones."""

    def __init__(self, rule: AlarmRule) -> None:
        self._rule = rule
        self.name = rule.name
        self.levels = rule.levels
        self.clear_after_s = rule.clear_after_s
        self.rearm_after_s = rule.rearm_after_s
        self.applies_to_unregistered = rule.applies_to_unregistered
        self.triggered_by = rule.triggered_by

    def judge(self, unit: UnitState, t_ns: int, level: str) -> Verdict:
        verdict = self._rule.judge(unit, t_ns, level)
        if isinstance(verdict, Finding) and verdict.latched:
            return msgspec.structs.replace(verdict, latched=False)
        return verdict
