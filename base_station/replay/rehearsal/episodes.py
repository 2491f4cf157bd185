"""Episodes: times for which the condition of an alarm rule held at one unit; and which of two sets
of thresholds found them, and when.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from enum import StrEnum

import msgspec

from base_station.core.state import Alarm
from shared.messages import AlarmState

_EVER_NS = 2**63 - 1


class Episode(msgspec.Struct):
    """Station times; of an alarm without the people who acknowledge and resolve it."""

    rule: str
    unit_id: str
    reached_ns: dict[str, int]  # by level: when that level, or a worse one, was first reached
    until_ns: int = _EVER_NS


class EpisodeRecord:
    """Collects the episodes of the alarms of one alarm manager."""

    def __init__(self) -> None:
        self._by_alarm: dict[str, Episode] = {}

    def note(self, alarm: Alarm, levels: Sequence[str]) -> None:
        """Note that an alarm was raised, changed its level or was resolved.

        ``levels``: those of its rule, from least to worst.
        """
        episode = self._by_alarm.get(alarm.alarm_id)
        if episode is None:
            episode = self._by_alarm[alarm.alarm_id] = Episode(alarm.rule, alarm.unit_id, {})
        if alarm.state is AlarmState.RESOLVED:
            episode.until_ns = alarm.changed_ns
            return
        for level in levels[: levels.index(alarm.level) + 1]:
            episode.reached_ns.setdefault(level, alarm.changed_ns)

    def all(self) -> Sequence[Episode]:
        return tuple(self._by_alarm.values())


class EpisodeOutcome(StrEnum):
    """Outcome of an episode under the rehearsed thresholds."""

    SAME = "same"
    EARLIER = "earlier"
    LATER = "later"
    MISSED = "missed"  # found by the thresholds of then alone
    ADDED = "added"  # found by the rehearsed thresholds alone


class EpisodePair(msgspec.Struct, frozen=True):
    """One level of one rule at one unit; station times, None: it was not reached."""

    rule: str
    level: str
    unit_id: str
    recorded_ns: int | None  # by the thresholds in force at the time
    rehearsed_ns: int | None

    @property
    def outcome(self) -> EpisodeOutcome:
        if self.rehearsed_ns is None:
            return EpisodeOutcome.MISSED
        if self.recorded_ns is None:
            return EpisodeOutcome.ADDED
        if self.rehearsed_ns == self.recorded_ns:
            return EpisodeOutcome.SAME
        return (
            EpisodeOutcome.EARLIER if self.rehearsed_ns < self.recorded_ns else EpisodeOutcome.LATER
        )

    @property
    def t_ns(self) -> int:
        """The first of both times."""
        return min(one for one in (self.recorded_ns, self.rehearsed_ns) if one is not None)


def compare(recorded: Iterable[Episode], rehearsed: Iterable[Episode]) -> list[EpisodePair]:
    """Pair episodes of the same level, rule and unit whose times overlap, each once and in the
    order of time; those without a partner are missed, or added.
    """
    before, after = _by_subject(recorded), _by_subject(rehearsed)
    found = [
        EpisodePair(rule, level, unit_id, then_ns, now_ns)
        for rule, level, unit_id in sorted(before.keys() | after.keys())
        for then_ns, now_ns in _pairs(
            before.get((rule, level, unit_id), []), after.get((rule, level, unit_id), [])
        )
    ]
    return sorted(found, key=lambda one: (one.t_ns, one.rule, one.level, one.unit_id))


_Subject = tuple[str, str, str]  # rule, level, unit
_Time = tuple[int, int]  # from (included) until (left out)


def _by_subject(episodes: Iterable[Episode]) -> dict[_Subject, list[_Time]]:
    found: dict[_Subject, list[_Time]] = {}
    for episode in episodes:
        for level, from_ns in episode.reached_ns.items():
            subject = episode.rule, level, episode.unit_id
            found.setdefault(subject, []).append((from_ns, episode.until_ns))
    return {subject: sorted(times) for subject, times in found.items()}


def _pairs(before: list[_Time], after: list[_Time]) -> Iterator[tuple[int | None, int | None]]:
    left = list(after)
    for then_ns, until_ns in before:
        partner = next((one for one in left if one[0] < until_ns and then_ns < one[1]), None)
        if partner is not None:
            left.remove(partner)
        yield then_ns, None if partner is None else partner[0]
    for now_ns, _ in left:
        yield None, now_ns
