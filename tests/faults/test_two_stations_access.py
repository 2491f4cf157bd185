"""A revocation at one station of a pair while the other was off or cut off holds at both,
whichever leads.
"""

from __future__ import annotations

import time
import urllib.error
import urllib.request
from contextlib import ExitStack
from pathlib import Path

import pytest

from base_station.security.pki.folder import PkiFolder
from shared.enrolment import Holder
from shared.errors import BusError
from tests.bench.standby.station_of_pair import Place, Station
from tests.rig.lossy_link import CLEAN, DARK, LossyLink
from tests.rig.pacing import wait_until
from tests.rig.station_requests import PASSWORD, as_admin, call, log_in, role
from tests.rig.two_stations import two_stations

ANOTHER = "another horse battery"
REMOVED, DEMOTED, RENEWED, ENDED, KEPT = "removed", "demoted", "renewed", "ended", "kept"
USERS = (REMOVED, DEMOTED, RENEWED, ENDED, KEPT)
COPIED_S = 3.0  # accounts are copied once a second
UNHEARD_S = 3.0  # several messages of a unit
REPORTED_S = 3.0  # a beat that names a new unit


class People:
    """Access of each user at each station: a login of its own, and a token of the first one's."""

    def __init__(self, at: Station) -> None:
        self.tokens: dict[str, tuple[str, str]] = {}  # id and secret
        for name in USERS:
            new = {"username": name, "password": PASSWORD, "role": "commander"}
            call(at, as_admin(at), "POST", "/users", new)
            made = call(at, log_in(at, name), "POST", "/tokens", {"name": "x", "role": "commander"})
            self.tokens[name] = made["token_id"], made["token"]
        self.cookies: dict[tuple[str, str], str] = {}

    def log_in(self, at: Station) -> None:
        for name in USERS:
            self.cookies[at.name, name] = log_in(at, name)["Cookie"]

    def shut_out(self, at: Station) -> None:
        """All of them but one."""
        admin = as_admin(at)
        call(at, admin, "DELETE", f"/users/{REMOVED}")
        call(at, admin, "PUT", f"/users/{DEMOTED}", {"role": "viewer"})
        call(at, admin, "PUT", f"/users/{RENEWED}", {"password": ANOTHER})
        call(at, admin, "DELETE", f"/users/{ENDED}/sessions")
        token_id, secret = self.tokens[ENDED]
        call(at, {"Authorization": f"Bearer {secret}"}, "DELETE", f"/tokens/{token_id}")

    def let_in(self, at: Station) -> dict[str, tuple[str | None, str | None]]:
        """The role of each by the login and by the token; None: they are nobody."""
        return {
            name: (
                role(at, {"Cookie": self.cookies[at.name, name]}),
                role(at, {"Authorization": f"Bearer {self.tokens[name][1]}"}),
            )
            for name in USERS
        }


EVERYBODY = dict.fromkeys(USERS, ("commander", "commander"))
BANNED: dict[str, tuple[str | None, str | None]] = {
    REMOVED: (None, None),
    DEMOTED: (None, "viewer"),
    RENEWED: (None, None),
    ENDED: (None, None),
    KEPT: ("commander", "commander"),
}


def assert_shut_out(at: Station, people: People) -> None:
    wait_until(f"they are shut out at {at.name}", lambda: people.let_in(at) == BANNED)
    for name, password in ((REMOVED, PASSWORD), (RENEWED, PASSWORD)):
        with pytest.raises(urllib.error.HTTPError, match="401"):
            log_in(at, name, password)
    assert role(at, log_in(at, DEMOTED)) == "viewer"
    assert role(at, log_in(at, RENEWED, ANOTHER)) == "commander"


def received(at: Station, unit_id: str) -> int:
    return sum(unit == unit_id for unit, _, _ in at.logged().messages)


def assert_unreceived(at: Station, unit_id: str, other: str) -> None:
    """While another one is heard on the same way."""
    before = received(at, other)

    def of_the_one_while_the_other_speaks() -> int:
        before_it, before_other = received(at, unit_id), received(at, other)
        time.sleep(UNHEARD_S)
        assert received(at, other) > before_other
        return received(at, unit_id) - before_it

    wait_until("nothing more of it is heard", lambda: of_the_one_while_the_other_speaks() == 0)
    assert received(at, other) > before


def test_access_revoked_before_a_crash_is_revoked_at_both_after_the_return(
    tmp_path: Path, closing: ExitStack
) -> None:
    two = two_stations(tmp_path, (Place(), Place()), closing)
    two.start()
    for unit_id in ("lost", "bert"):
        two.start_unit(unit_id, two.second)
    two.wait_received(two.first)
    people = People(two.first)
    people.log_in(two.first)
    time.sleep(COPIED_S)
    people.log_in(two.second)
    assert people.let_in(two.second) == people.let_in(two.first) == EVERYBODY
    two.second.kill()
    people.shut_out(two.first)
    PkiFolder(two.first.data).revoke("lost")
    assert_shut_out(two.first, people)
    two.first.kill()
    two.second.start()
    wait_until("the second leads", two.second.leads)
    assert people.let_in(two.second) == EVERYBODY, "nobody has told it"
    wait_until("it is heard there", lambda: received(two.second, "lost"))
    two.first.start()
    wait_until("the first follows", two.first.follows)
    assert_shut_out(two.second, people)
    assert_shut_out(two.first, people)
    assert_unreceived(two.second, "lost", "bert")
    for again in two.both:  # the other leads meanwhile
        again.stop()
        again.start()
        wait_until("it follows", again.follows)
        assert [people.let_in(one) for one in two.both] == [BANNED, BANNED]
        assert all(
            PkiFolder(one.data).registry().current(Holder.UNIT, "lost") is None for one in two.both
        )


def test_access_revoked_by_one_of_two_leaders_is_revoked_at_both(
    tmp_path: Path, closing: ExitStack
) -> None:
    """The cable is cut; the first shuts people out, and the second, which stays, does not."""
    try:
        link = LossyLink(7, closing)
    except BusError as error:
        pytest.skip(str(error))
    first, second = (Place(one.address, one) for one in (link.station, link.units))
    two = two_stations(tmp_path, (first, second), closing)
    two.start()
    for unit_id, near in (("anna", two.first), ("bert", two.second)):
        two.start_unit(unit_id, near)
    two.wait_received(two.first)
    people = People(two.first)
    people.log_in(two.first)
    time.sleep(COPIED_S + REPORTED_S)
    people.log_in(two.second)
    link.set(DARK)
    wait_until("the second leads too", two.second.leads)
    people.shut_out(two.first)
    assert people.let_in(two.second) == EVERYBODY
    link.set(CLEAN)
    wait_until("the first follows", two.first.follows)
    for one in two.both:
        assert_shut_out(one, people)
