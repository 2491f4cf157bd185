"""Copies that an erasure has outdated are a problem, which names the archive and what happens."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import msgspec
import pytest

from base_station.archive.outdated_copies import OutdatedCopies
from base_station.storage.db.archived import ArchivedCopies
from base_station.storage.db.models import OUTDATED_NS
from base_station.storage.db.store import Store
from base_station.views.wire import ArchiveView

OWN, OTHER = "/media/own", "/media/other"
VIEW = ArchiveView(location=OWN, state="waiting", waiting=0, copied=0, archived_ms=None, text="")


@pytest.fixture
def copies(tmp_path: Path) -> Iterator[ArchivedCopies]:
    with Store(tmp_path / "station.sqlite") as store:
        copies = ArchivedCopies(store)
        for incident_id, archive, known_ns in (
            ("i1", OWN, OUTDATED_NS),
            ("i2", OWN, OUTDATED_NS),
            ("i3", OWN, 7),
            ("i4", OTHER, OUTDATED_NS),
        ):
            copies.note(incident_id, archive, 9, known_ns, ())
        yield copies


def problems(copies: ArchivedCopies, view: ArchiveView | None, *, leads: bool = True) -> list[str]:
    outdated = OutdatedCopies(copies, lambda: view, lambda: leads)
    assert outdated.problems() == ()
    outdated.refresh()
    return [str(one) for one in outdated.problems()]


def test_problem_says_that_copies_are_made_anew_or_what_to_do(copies: ArchivedCopies) -> None:
    other, own = problems(copies, VIEW)
    assert other.startswith(f"1 copies in the archive {OTHER}")
    assert other.endswith(f"give muster base archive copy {OTHER}")
    assert own.startswith(f"2 copies in the archive {OWN}")
    assert own.endswith("being made anew")


def test_problem_has_the_reason_where_the_archive_is_away(copies: ArchivedCopies) -> None:
    away = msgspec.structs.replace(VIEW, text="no such disk")
    assert problems(copies, away)[1].endswith("made anew later: no such disk")
    assert all("muster base archive copy" in one for one in problems(copies, None))


def test_station_that_follows_leaves_its_archive_to_the_leader(copies: ArchivedCopies) -> None:
    (other,) = problems(copies, VIEW, leads=False)
    assert OTHER in other
    copies.note("i4", OTHER, 9, 7, ())
    assert problems(copies, VIEW, leads=False) == []
