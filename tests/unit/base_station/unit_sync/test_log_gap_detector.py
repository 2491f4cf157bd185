"""Messages missing in a damaged log are requested again, and no others."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator

import pytest

from base_station.core.checkpoint import Checkpoint
from base_station.core.state import StationState, UnitState
from base_station.core.state.boot_state import BootState
from base_station.storage.checkpoints import SavedState
from base_station.unit_sync.log_gap_detector import LogGapDetector, Lost
from shared.channels import IMU, POSITION, backfilled_key, tracker_id, unread_key
from shared.clock import NS_PER_S, ManualClock
from shared.codec import encode
from shared.errors import LogError
from shared.mcap_log import LogRecord
from shared.messages import Header
from shared.sequence_set import Run, SequenceSet
from tests.rig.message_factory import position

UNIT, AGENT = "anna", tracker_id("anna")
BOOT = 7


def spoken(seq: int, sender: str = UNIT) -> LogRecord:
    return 0, POSITION.key(sender), encode(position(Header(sender, BOOT, seq, seq)))


class Damaged:
    """A log that had ten messages of the unit and ten of its agent."""

    def __init__(self) -> None:
        self.clock = ManualClock()
        self.damaged: list[str] = []
        self.saved_ns = self.clock.utc_ns()
        self.log: list[LogRecord] = [
            spoken(seq, sender) for seq in range(1, 11) for sender in (UNIT, AGENT)
        ]
        self.read: Callable[[], Iterable[LogRecord]] = lambda: self.log
        self.readings = 0
        self.taken_back: list[Lost] = []
        self.search = LogGapDetector(
            lambda: self.damaged, self._saved, self._records, self.clock, self.taken_back.append
        )

    def _saved(self, after_ns: int) -> SavedState | None:
        if self.saved_ns <= after_ns:
            return None
        unit, agent = UnitState(UNIT), UnitState(AGENT)
        for sender in (unit, agent):
            sender.boots = [BootState(BOOT, SequenceSet([1], [10]))]
        unit.tracker = agent
        state = StationState(units={UNIT: unit})
        return SavedState(self.saved_ns, 1, Checkpoint(state, "", {}, {}))

    def _records(self) -> Iterable[LogRecord]:
        self.readings += 1
        return self.read()

    def search_for_a_while(self) -> None:
        """Time in which the station's state is saved."""
        for _ in range(20):
            self.search.search_further()
            self.clock.advance(1.0)
            self.saved_ns = self.clock.utc_ns()


@pytest.fixture
def damaged() -> Damaged:
    return Damaged()


def test_missing_messages_are_marked_once(damaged: Damaged) -> None:
    damaged.log = [one for one in damaged.log if one not in map(spoken, (3, 4, 8))]
    damaged.log.remove(spoken(10, AGENT))
    damaged.damaged = ["1.mcap"]
    damaged.search_for_a_while()
    assert damaged.taken_back == [
        {(UNIT, BOOT): (Run(3, 4), Run(8, 8)), (AGENT, BOOT): (Run(10, 10),)}
    ]
    damaged.search_for_a_while()
    assert len(damaged.taken_back) == 1


def test_each_new_damage_is_examined(damaged: Damaged) -> None:
    damaged.damaged = ["1.mcap"]
    damaged.search_for_a_while()
    assert damaged.taken_back == []
    damaged.log.remove(spoken(1))
    damaged.damaged = ["1.mcap", "2.mcap"]
    damaged.search_for_a_while()
    assert damaged.taken_back == [{(UNIT, BOOT): (Run(1, 1),)}]


def test_whole_log_is_not_read(damaged: Damaged) -> None:
    damaged.search_for_a_while()
    assert damaged.readings == 0


def test_check_waits_for_a_state_saved_since(damaged: Damaged) -> None:
    """Messages behind an older one would be missing in it and not in the log."""
    damaged.damaged = ["1.mcap"]
    for _ in range(5):
        damaged.search.search_further()
        damaged.clock.advance(1.0)
    assert damaged.readings == 0


@pytest.mark.parametrize(
    "found",
    [
        (0, backfilled_key(UNIT, POSITION.suffix), spoken(3)[2]),
        (0, unread_key(UNIT, BOOT, 3, POSITION.suffix), b"of a newer program"),
        (0, IMU.key(UNIT), spoken(3)[2]),  # an unreadable message has a number all the same
    ],
)
def test_message_counts_as_present_by_any_way_of_reception(
    damaged: Damaged, found: LogRecord
) -> None:
    damaged.log[damaged.log.index(spoken(3))] = found
    damaged.damaged = ["1.mcap"]
    damaged.search_for_a_while()
    assert damaged.readings == 1
    assert damaged.taken_back == []


def test_file_changed_during_reading_is_read_again(damaged: Damaged) -> None:
    def breaks_off() -> Iterator[LogRecord]:
        damaged.read = lambda: damaged.log[1:]
        yield damaged.log[1]
        raise LogError("the segment is gone")

    damaged.read = breaks_off
    damaged.damaged = ["1.mcap"]
    damaged.search_for_a_while()
    assert damaged.readings == 2
    assert damaged.taken_back == [{(UNIT, BOOT): (Run(1, 1),)}]


def test_long_log_is_read_in_turns(damaged: Damaged) -> None:
    taken: list[LogRecord] = []

    def slowly() -> Iterator[LogRecord]:
        for one in damaged.log:
            damaged.clock.advance(0.2)
            taken.append(one)
            yield one

    damaged.read = slowly
    damaged.damaged = ["1.mcap"]
    damaged.search.search_further()
    damaged.saved_ns = damaged.clock.utc_ns() + NS_PER_S
    damaged.search.search_further()
    assert 0 < len(taken) < 5
