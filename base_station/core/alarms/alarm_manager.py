"""Alarm manager: raises, acknowledges and resolves alarms, and reports each transition.

A rule judges a unit; the manager decides on the alarm.  It prevents flapping (evidence must stay
clear for a time), never resolves an alarm because messages are missing, and keeps a latched one
until a person resolves it.  A rule that fails is reported, and the others continue.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import count

import msgspec

from base_station.core.alarms.interface import (
    EMERGENCY,
    WARNING,
    AlarmRule,
    Clear,
    Finding,
)
from base_station.core.alarms.thresholds import Thresholds, with_thresholds
from base_station.core.person_references import without_numbers
from base_station.core.state import ERASED_TEXT, Alarm, StationState, UnitState
from shared.clock import NS_PER_MS, NS_PER_S
from shared.coded_text import TextCode, code_of_text, coded
from shared.messages import (
    AlarmParameters,
    AlarmState,
    GpsFix,
    Heartbeat,
    Message,
    Position,
    RawImu,
    Status,
    Temperature,
)
from shared.messages.alarm import NO_PARAMETERS
from shared.messages.station import AcknowledgeAlarm, ReportProblem, ResolveAlarm

# Frequent messages: before the next tick only those rules judge that are triggered by them.
ROUTINE: tuple[type[Message], ...] = (Position, Status, Temperature, Heartbeat, GpsFix, RawImu)
HISTORY = 50  # resolved alarms kept at hand; the store has all of them
STATION_RULE = "station"
UNIT_REASSIGNED = coded(
    "over-handed-over", "handed over"
)  # an alarm that is not latched ends with the wearing
MAX_OPEN_BESIDE = 10  # open ones of one rule and unit, beside the newest


class AlarmManager:
    """Keeps ``state.alarms``; every method yields or returns the alarms that changed."""

    def __init__(self, rules: Sequence[AlarmRule]) -> None:
        self._defaults = tuple(rules)
        self.use_thresholds({})

    def use_thresholds(self, thresholds: Thresholds) -> None:
        """Judge by these thresholds from now on."""
        self._rules = with_thresholds(self._defaults, thresholds)
        self._rules_by_message = {
            kind: tuple(rule for rule in self._rules if kind in rule.triggered_by)
            for kind in ROUTINE
        }

    def review(
        self, state: StationState, unit: UnitState, came: type[Message] | None = None
    ) -> Iterator[Alarm]:
        """Let the rules judge the unit as it is now: those triggered by the new message, or all."""
        for rule in self._rules if came is None else self._rules_by_message.get(came, self._rules):
            if not (unit.registered or rule.applies_to_unregistered):
                continue
            key = f"{rule.name}|{unit.unit_id}"
            current = state.alarms.get(key)
            level = current.level if current is not None and current.is_open else ""
            try:
                verdict = rule.judge(unit, state.t_ns, level)
            except Exception as error:  # noqa: BLE001  # one bad rule must not silence the others
                part = f"rule-{rule.name}"
                if part not in state.problems:  # reported once for all units
                    text = coded(
                        "rule-failed",
                        "The alarm rule {rule!r} failed for {unit_id} and did not judge: {error}",
                        rule=rule.name,
                        unit_id=unit.unit_id,
                        error=repr(error),
                    )
                    yield from self.report_problem(state, ReportProblem.of(part, text))
                continue
            if verdict is None:
                if current is not None:  # the rule cannot judge: no condition has lasted
                    current.clear_since_ns = current.lower_since_ns = None
                continue
            if isinstance(verdict, Finding) and current is not None:
                if current.is_open and not current.latched and current.about != verdict.about:
                    yield _resolve_alarm(state, current, UNIT_REASSIGNED)
                current = _same_subject(state, key, current, verdict)
            changed = self._follow(state, rule, key, unit.unit_id, current, verdict)
            if changed is not None:
                yield changed

    def has_rule_for(self, came: type[Message]) -> bool:
        """True where a rule is triggered by this kind of message before the next tick."""
        return bool(self._rules_by_message.get(came, self._rules))

    def report_problem(self, state: StationState, report: ReportProblem) -> Iterator[Alarm]:
        """Report that a part of the station fails, or fails in another way; without a text, that it
        works again.  A text that only is shorter or has other numbers is no other way.
        """
        part, text = report.part, report.text
        key = f"{STATION_RULE}|{part}"
        current = state.alarms.get(key)
        standing = current if current is not None and current.is_open else None
        if text:
            state.problems[part] = text
            state.problem_codes[part] = TextCode(report.code, report.texts, report.numbers)
            if standing is None:
                yield self._raise(state, key, STATION_RULE, "", _station_fault(state, report))
            elif without_numbers(text) not in without_numbers(standing.text):
                yield _raise_anew(state, standing, _station_fault(state, report))
        else:
            _end_problem(state, part)
            if standing is not None:
                yield _resolve_alarm(state, standing, coded("over-works-again", "works again"))

    def acknowledge(self, state: StationState, by: str, action: AcknowledgeAlarm) -> Alarm | str:
        """Acknowledge an alarm; returns it, or the reason for a person why that is impossible."""
        alarm = _alarm_as_seen(state, action)
        if isinstance(alarm, str):
            return alarm
        if alarm.state is AlarmState.ACKNOWLEDGED:
            return coded("alarm-acknowledged", "{by} has acknowledged it already", by=alarm.by)
        alarm.state, alarm.by = AlarmState.ACKNOWLEDGED, by
        alarm.mark_changed(state.t_ns)
        return alarm

    def resolve(self, state: StationState, by: str, action: ResolveAlarm) -> Alarm | str:
        """Resolve an alarm; returns it, or the reason for a person why that is impossible."""
        alarm = _alarm_as_seen(state, action)
        if isinstance(alarm, str):
            return alarm
        alarm.resolved_while_active = True
        state.alarms.pop(alarm.alarm_id, None)  # where it stood beside a newer one
        if alarm.rule == STATION_RULE:
            _end_problem(state, alarm.level)
        alarm.reason, alarm.note = action.reason, action.note
        return _resolve_alarm(state, alarm, by)

    def erase_names(self, state: StationState, unit: UnitState) -> None:
        """Erase texts of alarms about the unit's wearers, and notes of their resolution; the alarms
        stay.
        """
        for alarm in (*state.alarms.values(), *state.history):
            if alarm.unit_id == unit.unit_id:
                alarm.text, alarm.by = ERASED_TEXT, ERASED_TEXT if alarm.by else ""
                alarm.code, alarm.parameters = "", NO_PARAMETERS
                alarm.note = ERASED_TEXT if alarm.note else ""

    def _follow(
        self,
        state: StationState,
        rule: AlarmRule,
        key: str,
        unit_id: str,
        current: Alarm | None,
        verdict: Finding | Clear,
    ) -> Alarm | None:
        if isinstance(verdict, Clear):
            return None if current is None else _clear_alarm(state, rule, current, verdict)
        if current is None or (not current.is_open and _is_new(state, rule, current, verdict)):
            return self._raise(state, key, rule.name, unit_id, verdict)
        if not current.is_open:
            return None
        current.worst = _worst_measured(current.worst, verdict)
        return _move_level(state, rule, current, verdict)

    def _raise(
        self, state: StationState, key: str, rule_name: str, unit_id: str, finding: Finding
    ) -> Alarm:
        alarm = Alarm(
            alarm_id=_new_id(state, f"{rule_name}:{unit_id or finding.level}"),
            rule=rule_name,
            unit_id=unit_id,
            priority=finding.priority,
            state=AlarmState.RAISED,
            level=finding.level,
            text=finding.text,
            by="",
            latched=finding.latched,
            raised_ns=state.t_ns,
            about=finding.about,
            last_raised_ns=state.t_ns,
            changed_ns=state.t_ns,
            code=finding.code,
            parameters=finding.parameters,
            worst=finding.measured,
            peak=finding.measured,
        )
        state.alarms[key] = alarm
        return alarm


def _end_problem(state: StationState, part: str) -> None:
    state.problems.pop(part, None)
    state.problem_codes.pop(part, None)


def _station_fault(state: StationState, report: ReportProblem) -> Finding:
    parameters = AlarmParameters(
        part=report.part,
        fault=report.text,
        fault_code=report.code or None,
        fault_texts=report.texts,
        fault_numbers=report.numbers,
    )
    return Finding(report.part, WARNING, "station-fault", parameters, seen_ns=state.t_ns)


def _worst_measured(so_far: float | None, finding: Finding) -> float | None:
    if so_far is None or finding.measured is None:
        return finding.measured if so_far is None else so_far
    return (min if finding.is_low else max)(so_far, finding.measured)


def _new_id(state: StationState, of: str) -> str:
    """Id with the time of raising, or the next free nanosecond after it."""
    taken = {alarm.alarm_id for alarm in (*state.alarms.values(), *state.history)}
    return next(name for t_ns in count(state.t_ns) if (name := f"{of}:{t_ns}") not in taken)


def _same_subject(state: StationState, key: str, newest: Alarm, finding: Finding) -> Alarm | None:
    """The alarm about the same wearer or fault, None where there is none: an alarm of a former
    wearer, or of an earlier fault, is kept beside it.
    """
    if finding.about == newest.about:
        return newest
    of_the_rule = {
        beside: alarm
        for beside, alarm in state.alarms.items()
        if (alarm.rule, alarm.unit_id) == (newest.rule, newest.unit_id) and alarm is not newest
    }
    same = next((one for one, alarm in of_the_rule.items() if alarm.about == finding.about), None)
    if not newest.is_open and same is None:
        return newest
    if same is None and len(of_the_rule) >= MAX_OPEN_BESIDE:  # raised anew in its place
        newest.about = finding.about
        return newest
    if newest.is_open:
        state.alarms[newest.alarm_id] = newest
    del state.alarms[key]
    if same is None:
        return None
    state.alarms[key] = state.alarms.pop(same)
    return state.alarms[key]


def _is_new(state: StationState, rule: AlarmRule, resolved: Alarm, finding: Finding) -> bool:
    """True if the finding is not about the condition of the resolved alarm."""
    is_others = finding.about != resolved.about and not finding.latched
    if is_others or not resolved.resolved_while_active or finding.onset_ns > resolved.changed_ns:
        return True
    if rule.levels.index(finding.level) > rule.levels.index(resolved.level):
        return True
    since_ns = state.t_ns - resolved.changed_ns
    return rule.rearm_after_s is not None and since_ns >= rule.rearm_after_s * NS_PER_S


def _move_level(
    state: StationState, rule: AlarmRule, alarm: Alarm, finding: Finding
) -> Alarm | None:
    """Raise the level at once, to be acknowledged again; lower it when the evidence has stayed
    lower.
    """
    alarm.clear_since_ns = None
    rank, standing = rule.levels.index(finding.level), rule.levels.index(alarm.level)
    if rank == standing and _is_new_occurrence(alarm, finding):
        return _raise_anew(state, alarm, finding)
    if rank == standing or (rank < standing and alarm.latched):
        alarm.lower_since_ns = None
        return None
    if rank < standing:
        if alarm.lower_since_ns is None:
            alarm.lower_since_ns = finding.seen_ns
        if finding.seen_ns - alarm.lower_since_ns < rule.clear_after_s * NS_PER_S:
            return None
    else:
        alarm.state, alarm.by, alarm.last_raised_ns = AlarmState.RAISED, "", state.t_ns
    alarm.lower_since_ns = None
    alarm.level, alarm.priority = finding.level, finding.priority
    _take_sentence(alarm, finding)
    alarm.latched = alarm.latched or finding.latched
    alarm.mark_changed(state.t_ns)
    return alarm


def _raise_anew(state: StationState, alarm: Alarm, finding: Finding) -> Alarm:
    alarm.state, alarm.by = AlarmState.RAISED, ""
    _take_sentence(alarm, finding)
    alarm.last_raised_ns = state.t_ns
    alarm.mark_changed(state.t_ns)
    return alarm


def _take_sentence(alarm: Alarm, finding: Finding) -> None:
    alarm.code, alarm.parameters, alarm.text = finding.code, finding.parameters, finding.text


def _is_new_occurrence(alarm: Alarm, finding: Finding) -> bool:
    """True if an acknowledged emergency occurred again, or if the text of a latched alarm changed:
    another wearer, or a fault beyond those that are kept.
    """
    if finding.onset_ns <= alarm.changed_ns:
        return False
    is_known = alarm.state is AlarmState.ACKNOWLEDGED and finding.priority == EMERGENCY
    is_other = without_numbers(finding.text) != without_numbers(alarm.text)
    return is_known or (finding.latched and is_other)


def _clear_alarm(state: StationState, rule: AlarmRule, alarm: Alarm, clear: Clear) -> Alarm | None:
    if not alarm.is_open:
        alarm.resolved_while_active = False
        return None
    if alarm.latched:
        return None
    if alarm.clear_since_ns is None:
        alarm.clear_since_ns = clear.seen_ns
    has_stayed_s = (clear.seen_ns - alarm.clear_since_ns) / NS_PER_S
    if has_stayed_s < rule.clear_after_s and not clear.at_once:
        return None
    is_others = clear.about is not None and clear.about != alarm.about
    return _resolve_alarm(state, alarm, UNIT_REASSIGNED if is_others else clear.by)


def _resolve_alarm(state: StationState, alarm: Alarm, by: str) -> Alarm:
    alarm.state, alarm.by = AlarmState.RESOLVED, str(by)
    alarm.reason = code_of_text(by).code or alarm.reason
    alarm.mark_changed(state.t_ns)
    as_it_ended = msgspec.structs.replace(alarm)  # later findings change the newest alone
    state.history = [*state.history[1 - HISTORY :], as_it_ended]
    return alarm


def _alarm_as_seen(state: StationState, action: AcknowledgeAlarm | ResolveAlarm) -> Alarm | str:
    """Return the open alarm; or the reason, where it was raised again since the user saw it."""
    alarms = (one for one in state.alarms.values() if one.alarm_id == action.alarm_id)
    alarm = next((one for one in alarms if one.is_open), None)
    if alarm is None:
        return coded("alarm-not-open", "no open alarm {alarm}", alarm=action.alarm_id)
    if action.last_raised_ms not in (0, alarm.last_raised_ns // NS_PER_MS):
        return coded(
            "alarm-raised-anew",
            "this has been raised anew since you saw it, look again: {alarm}",
            alarm=alarm.text,
        )
    return alarm
