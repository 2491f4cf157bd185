"""Person behind an id: on the roster, removed, erased, or lost with a database."""

from __future__ import annotations

from pathlib import Path

from base_station.core.erasure.erasure import Erasure
from base_station.storage.db.erasure import forget_in
from base_station.storage.db.known_people import KnownPerson, shown_wearer
from base_station.storage.db.models import Assignment
from base_station.storage.db.roster import Roster
from base_station.storage.db.store import Store
from shared.clock import SystemClock


def test_person_is_shown_as_on_the_present_roster(tmp_path: Path) -> None:
    with Store(tmp_path / "station.sqlite") as store:
        roster = Roster(store, SystemClock())
        ada = roster.add_person("Ada", "red", "leader")
        text = f"Mayday from {{person {ada.person_id}}}"
        assert roster.shown(text) == "Mayday from Ada"
        roster.set_photo(ada.person_id, b"jpeg", "h4sh")
        roster.change_person(ada.person_id, "Ada Horn", "blue", "leader")
        url = f"/api/v1/people/{ada.person_id}/photo?v=h4sh"
        assert roster.known(ada.person_id) == KnownPerson("Ada Horn", "blue", "leader", url)
        assert roster.shown(text) == "Mayday from Ada Horn"
        assert roster.crew("red") == ()
        assert roster.crew("blue") == (ada.person_id,)
        assert Roster(store, SystemClock()).known(ada.person_id) == roster.known(ada.person_id)


def test_person_removed_from_the_roster_keeps_the_name_in_earlier_records(tmp_path: Path) -> None:
    with Store(tmp_path / "station.sqlite") as store:
        roster = Roster(store, SystemClock())
        ada = roster.add_person("Ada", "red", "leader")
        roster.set_photo(ada.person_id, b"jpeg", "h4sh")
        assert roster.remove_person(ada.person_id)
        assert not roster.remove_person(ada.person_id)
        for one in (roster, Roster(store, SystemClock())):
            assert list(one.people()) == []
            assert one.person(ada.person_id) is None
            assert one.photo(ada.person_id) is None
            assert one.crew("red") == ()
            assert one.known(ada.person_id) == KnownPerson("Ada", "red", "leader")


def test_erased_person_has_no_name_and_gets_none_again(tmp_path: Path) -> None:
    with Store(tmp_path / "station.sqlite") as store:
        roster = Roster(store, SystemClock())
        ada = roster.add_person("Ada", "red", "leader")
        with store.write() as session:
            forget_in(session, Erasure((), (), person_id=ada.person_id))
        roster.forget(ada.person_id)
        for one in (roster, Roster(store, SystemClock())):
            assert one.known(ada.person_id) == KnownPerson("(forgotten)")
            assert one.ids_by_name() == {}


def test_person_lost_with_a_database_is_shown_by_the_id(tmp_path: Path) -> None:
    with Store(tmp_path / "station.sqlite") as store:
        roster = Roster(store, SystemClock())
        assert (
            roster.shown("Mayday from {person 1f2e3d4c5b6a7988}") == "Mayday from person 1f2e3d4c"
        )


def test_log_of_an_earlier_version_has_the_recorded_name(tmp_path: Path) -> None:
    with Store(tmp_path / "station.sqlite") as store:
        roster = Roster(store, SystemClock())
        ada = roster.add_person("Ada Horn", "blue", "leader")
        worn = Assignment(person_id=ada.person_id, person_name="Ada", crew="red", role="")
        assert shown_wearer(worn, roster.known) == KnownPerson("Ada", "red", "")
