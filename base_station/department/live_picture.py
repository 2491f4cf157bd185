"""Live picture of a department: the newest summary of each station, in memory."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from threading import Lock

from base_station.department_wire import PersonSummary, Summary
from shared.clock import NS_PER_MS, NS_PER_S

AWAY_AFTER_NS = 5 * NS_PER_S  # without a summary, of which there is one a second
CLOCK_LIMIT_MS = 5_000  # a clock that is further off is reported


@dataclass(slots=True)
class IncidentCounts:
    """Number of people in one incident, and of those who need something."""

    people: int = 0
    maydays: int = 0
    alarms: int = 0
    overdue: int = 0


@dataclass(frozen=True, slots=True)
class StationPicture:
    """State that a station has reported last."""

    station: str
    summary: Summary
    received_ns: int  # UTC of the department
    received_monotonic_ns: int | None  # None: before this program began
    counts: Mapping[str, IncidentCounts]  # by incident id; empty: people in no incident
    people: Sequence[PersonSummary]  # people in need of help first

    @staticmethod
    def of(
        station: str, summary: Summary, received_ns: int, received_monotonic_ns: int | None
    ) -> StationPicture:
        """Make a picture, which is counted and sorted once, however often it is shown."""
        counts: dict[str, IncidentCounts] = {}
        for person in summary.people:
            count = counts.setdefault(person.incident_id, IncidentCounts())
            count.people += 1
            count.maydays += person.mayday
            count.alarms += len(person.alarms)
            count.overdue += is_overdue(person, summary.t_ms)
        people = sorted(summary.people, key=lambda one: rank_of(one, summary.t_ms))
        return StationPicture(station, summary, received_ns, received_monotonic_ns, counts, people)

    @property
    def offset_ms(self) -> int:
        """Time by which the station's clock is ahead of the department's."""
        return self.summary.t_ms - self.received_ns // NS_PER_MS

    def silent_ns(self, now_ns: int, now_monotonic_ns: int) -> int:
        """Time since it was received; setting the department's clock does not change it."""
        if self.received_monotonic_ns is None:
            return max(now_ns - self.received_ns, AWAY_AFTER_NS)
        return now_monotonic_ns - self.received_monotonic_ns


def is_overdue(person: PersonSummary, t_ms: int) -> bool:
    """True if the member's PAR was due before ``t_ms``, station time."""
    return person.par_due_ms is not None and person.par_due_ms < t_ms


def rank_of(person: PersonSummary, t_ms: int) -> tuple[bool, int, bool, str]:
    """Sort key by need of help: mayday, alarms, PAR overdue at ``t_ms``, then by unit."""
    return not person.mayday, -len(person.alarms), not is_overdue(person, t_ms), person.unit_id


class LivePicture:
    """Pictures of all stations.  Thread-safe."""

    def __init__(self) -> None:
        self._lock = Lock()
        # By station and epoch: two epochs at once are two machines with one name.
        self._pictures: dict[str, dict[int, StationPicture]] = {}

    def take(self, picture: StationPicture) -> None:
        """Use a newer summary, and drop those of silent machines of the same name."""
        with self._lock:
            before = self._pictures.get(picture.station, {})
            received_ns = picture.received_monotonic_ns or 0
            others = {
                epoch: one
                for epoch, one in before.items()
                if one.silent_ns(picture.received_ns, received_ns) < AWAY_AFTER_NS
            }
            self._pictures[picture.station] = others | {picture.summary.epoch: picture}

    def all(self) -> dict[str, Sequence[StationPicture]]:
        """Pictures by station; more than one if several machines use its name."""
        with self._lock:
            return {name: tuple(ones.values()) for name, ones in self._pictures.items()}
