"""Missing records of a log, by its own segments and by the database's list of them."""

from __future__ import annotations

from pathlib import Path

from base_station.storage.integrity_checker import IntegrityChecker
from base_station.storage.missing_segments import KnownSegment, LogGap, log_gaps
from shared.clock import NS_PER_S
from shared.coded_text import Term
from shared.mcap_log import SegmentInfo, SegmentState, segment_path
from tests.rig.small_log import T0_NS

FOLDER, EACH = Path("log"), 10


def at(second: float) -> int:
    return T0_NS + round(second * NS_PER_S)


def segment(number: int, messages: int = 100, until: float | None = None) -> SegmentInfo:
    begin = (number - 1) * EACH
    end_ns = at(begin + EACH - 1 if until is None else until)
    path = segment_path(FOLDER, number, at(begin))
    times = (at(begin), end_ns) if messages else (0, 0)
    return SegmentInfo(path, SegmentState.CLOSED, *times, messages, 1000)


def known(number: int) -> KnownSegment:
    one = segment(number)
    return KnownSegment(one.path.name, one.start_ns, one.end_ns, one.messages)


KNOWN = [known(number) for number in range(1, 5)]
WHOLE = [segment(number) for number in range(1, 5)]


def test_whole_log_lacks_nothing_with_or_without_a_list() -> None:
    assert log_gaps(WHOLE, KNOWN) == []
    assert log_gaps(WHOLE, []) == []
    assert log_gaps([], []) == []
    longer = [*WHOLE[:-1], segment(4, 120, 41.0), segment(5)]
    assert log_gaps(longer, KNOWN) == [], "the table is some seconds behind"


def test_missing_segment_is_named_with_its_times() -> None:
    (lack,) = log_gaps([WHOLE[0], *WHOLE[2:]], KNOWN)
    assert (lack.number, lack.from_ns, lack.until_ns) == (2, at(10), at(19))
    assert lack.is_file_missing
    assert lack.in_words() == (
        f"{WHOLE[1].path.name} is missing: what happened from 2023-11-14 22:13:30 UTC until "
        "2023-11-14 22:13:39 UTC is not known, or not all of it"
    )
    (last,) = log_gaps(WHOLE[:-1], KNOWN)
    assert last.number == 4
    assert last.covers(at(60)), "it may have gone on behind what the table knows"
    assert not lack.covers(at(25))
    assert [one.number for one in log_gaps([], KNOWN)] == [1, 2, 3, 4], "all"


def test_missing_segment_is_found_without_a_table_by_numbers_and_neighbours() -> None:
    assert log_gaps([WHOLE[0], WHOLE[3]], []) == [
        LogGap(2, "", at(9), at(30), is_file_missing=True),
        LogGap(3, "", at(9), at(30), is_file_missing=True),
    ]
    assert log_gaps(WHOLE[1:], []) == [LogGap(1, "", 0, at(10), is_file_missing=True)]


def test_truncated_segment_lacks_its_end_and_an_emptied_one_all() -> None:
    cut = [WHOLE[0], segment(2, 40, 13.0), *WHOLE[2:]]
    name = WHOLE[1].path.name
    assert log_gaps(cut, KNOWN) == [LogGap(2, name, at(13), at(19), 40, 100)]
    inside = [WHOLE[0], segment(2, 40), *WHOLE[2:]]
    assert log_gaps(inside, KNOWN) == [LogGap(2, name, at(10), at(19), 40, 100)]
    emptied = [WHOLE[0], segment(2, 0), *WHOLE[2:]]
    assert log_gaps(emptied, KNOWN) == [LogGap(2, name, at(10), at(19), 0, 100)]
    assert log_gaps(emptied, []) == [LogGap(2, name, at(10), at(20))]


def test_loss_of_a_kill_in_the_newest_segment_is_no_damage() -> None:
    assert log_gaps([*WHOLE[:-1], segment(4, 97, 38.0)], KNOWN) == []
    assert len(log_gaps([*WHOLE[:-1], segment(4, 60, 35.0)], KNOWN)) == 1
    assert len(log_gaps([*WHOLE[:-2], segment(3, 97, 28.0), WHOLE[-1]], KNOWN)) == 1


def test_check_reports_damage_until_it_is_repaired() -> None:
    check = IntegrityChecker(Term("restore", "It is mended."))
    lacks = log_gaps([segment(1, 40), segment(2, 50), WHOLE[3]], KNOWN)
    check.note_lacks(FOLDER, lacks)
    (reported,) = check.problems()
    assert reported.startswith(f"A part of the log is lost: {WHOLE[0].path.name} has 40 of its 100")
    assert reported.endswith("It is mended.")
    assert check.missing == (3,)
    first, second = (one.path for one in WHOLE[:2])
    assert list(check.damaged) == [first, second]
    assert check.lacking == {one.path.name for one in WHOLE[:3]}
    assert check.has_lost(at(15))
    assert not check.has_lost(at(35))
    check.note_mended(first)
    assert list(check.damaged) == [second]
    assert first.name not in check.lacking


def test_only_some_of_many_are_named() -> None:
    check = IntegrityChecker(Term("restore", ""))
    check.note_lacks(FOLDER, log_gaps([], [known(number) for number in range(1, 30)]))
    (reported,) = check.problems()
    assert "; and 24 more" in reported


def test_file_that_is_no_segment_is_named() -> None:
    check = IntegrityChecker(Term("restore", ""))
    check.note_foreign({FOLDER / "000009-20231114T221320Z.mcap": "it is of another time"})
    (reported,) = check.problems()
    assert "000009-20231114T221320Z.mcap" in reported
    assert check.damaged == ()
