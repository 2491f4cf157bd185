"""A station of a pair that loses its database while off gets users, people and tokens back from
the other, whichever leads.
"""

from __future__ import annotations

import urllib.error
from contextlib import ExitStack
from functools import partial
from http import HTTPStatus
from pathlib import Path

import pytest

from tests.bench.standby.station_of_pair import Place, Station
from tests.rig.pacing import wait_until
from tests.rig.station_requests import as_admin, call, log_in, role
from tests.rig.two_stations import two_stations

USER, PASSWORD = "mia", "correct horse battery"


def has_all(at: Station) -> bool:
    """True if administrator and user can log in here and find the entered data."""
    try:
        found = call(at, as_admin(at), "GET", "/people")
        return [one["name"] for one in found] == ["Ada"] and (
            role(at, log_in(at, USER, PASSWORD)) == "commander"
        )
    except urllib.error.HTTPError as error:
        if error.code != HTTPStatus.UNAUTHORIZED:
            raise
        return False


@pytest.mark.parametrize("left", [None, b""], ids=["deleted", "emptied"])
def test_leader_without_database_restores_its_users_from_the_standby(
    tmp_path: Path, closing: ExitStack, left: bytes | None
) -> None:
    two = two_stations(tmp_path, (Place(), Place()), closing)
    two.start()
    new = {"username": USER, "password": PASSWORD, "role": "commander"}
    call(two.first, as_admin(two.first), "POST", "/users", new)
    call(two.first, as_admin(two.first), "POST", "/people", {"name": "Ada"})
    wait_until("the second has them", lambda: has_all(two.second))
    for one in two.both:
        one.kill()
    for file in two.first.data.glob("station.sqlite*"):
        file.unlink()
    if left is not None:
        (two.first.data / "station.sqlite").write_bytes(left)
    note = two.first.data / "first-login.txt"
    before = note.read_text()
    two.first.start()
    wait_until("it leads, with an administrator that it made", lambda: note.read_text() != before)
    assert "users and their passwords" in two.first.output()
    assert "come back when it is reachable" in two.first.output()
    two.second.start()
    wait_until("one leads and the other follows", lambda: two.leader() is not None)
    for one in two.both:
        wait_until(f"all are at {one.name} again", partial(has_all, one))
