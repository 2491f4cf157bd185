"""Users, logins, sessions and tokens are the same at both stations."""

from __future__ import annotations

from pathlib import Path

import pytest

from base_station.accounts.principals import Role
from base_station.storage.db.accounts import LOGIN_TICKET_S, SESSION_S
from base_station.storage.db.store import Store
from tests.rig.table_side import PASSWORD, TableSide


def test_new_user_of_a_removed_name_has_none_of_its_logins(
    sides: tuple[TableSide, TableSide],
) -> None:
    active, standby = sides
    active.accounts.add_user("ada", PASSWORD, Role.COMMANDER)
    active.accounts.add_user("bo", PASSWORD, Role.ADMINISTRATOR)
    standby.copy(active)
    session = standby.accounts.log_in("ada", PASSWORD)
    assert session is not None
    active.accounts.remove_user("ada")
    active.accounts.add_user("ada", "another long password", Role.COMMANDER)
    standby.copy(active)  # which never saw that there was none
    assert standby.accounts.of_session(session) is None


def test_logins_tokens_and_sessions_are_replicated(
    sides: tuple[TableSide, TableSide],
) -> None:
    active, standby = sides
    active.accounts.add_user("ada", PASSWORD, Role.COMMANDER)
    session = active.accounts.log_in("ada", PASSWORD)
    _, token = active.accounts.add_token("ada", "cot", Role.VIEWER, None)
    standby.copy(active)
    assert session is not None
    assert standby.accounts.of_session(session) == active.accounts.of_session(session)
    assert standby.accounts.of_token(token) == active.accounts.of_token(token)
    assert standby.accounts.log_in("ada", PASSWORD) is not None
    assert standby.accounts.log_in("ada", "wrong password") is None


def test_ended_logins_are_replicated_and_own_logins_kept(
    sides: tuple[TableSide, TableSide],
) -> None:
    active, standby = sides
    active.accounts.add_user("ada", PASSWORD, Role.COMMANDER)
    there = active.accounts.log_in("ada", PASSWORD)
    standby.copy(active)
    here = standby.accounts.log_in("ada", PASSWORD)
    assert there is not None
    assert here is not None
    active.accounts.log_out(there)
    standby.copy(active)
    assert standby.accounts.of_session(there) is None
    assert standby.accounts.of_session(here) is not None


@pytest.mark.parametrize("how", ["new password", "ended by an administrator", "removed"])
def test_revoked_access_is_revoked_at_both_stations(
    sides: tuple[TableSide, TableSide], how: str
) -> None:
    active, standby = sides
    active.accounts.add_user("chief", PASSWORD, Role.ADMINISTRATOR)
    active.accounts.add_user("ada", PASSWORD, Role.COMMANDER)
    standby.copy(active)
    here = standby.accounts.log_in("ada", PASSWORD)  # by whoever has found the password
    assert here is not None
    ticket = standby.accounts.create_login_ticket(here)
    assert ticket is not None
    match how:
        case "new password":
            active.accounts.change_user("ada", "another battery", None)
        case "ended by an administrator":
            active.accounts.end_sessions("ada")
        case _:
            active.accounts.remove_user("ada")
    standby.copy(active)
    assert standby.accounts.of_session(here) is None
    assert standby.accounts.redeem_login_ticket(ticket) is None
    assert standby.accounts.open_sessions() == {}


@pytest.mark.parametrize("how", ["new password", "ended by an administrator", "removed"])
@pytest.mark.parametrize("first", ["who leads", "who follows"])
def test_access_revoked_by_a_former_leader_is_revoked_at_both(
    sides: tuple[TableSide, TableSide], how: str, first: str
) -> None:
    """Whichever of the two hears of the other first."""
    leads, follows = apart = sides
    follows.accounts.add_user("chief", PASSWORD, Role.ADMINISTRATOR)
    follows.accounts.add_user("ada", PASSWORD, Role.COMMANDER)
    leads.copy(follows)
    here = leads.accounts.log_in("ada", PASSWORD)
    assert here is not None
    _, token = leads.accounts.add_token("ada", "x", Role.VIEWER, None)
    match how:
        case "new password":
            follows.accounts.change_user("ada", "another battery", None)
        case "ended by an administrator":
            follows.accounts.end_sessions("ada")
        case _:
            follows.accounts.remove_user("ada")
    meet(leads, follows, first)
    for one in apart:
        assert one.accounts.of_session(here) is None
        assert (one.accounts.log_in("ada", PASSWORD) is None) == (
            how in ("new password", "removed")
        )
        assert (one.accounts.of_token(token) is None) == (how == "removed")
    meet(leads, follows, first)
    assert leads.tables.read().users == follows.tables.read().users


@pytest.mark.parametrize("first", ["who leads", "who follows"])
def test_removals_by_one_station_alone_apply_at_both(
    sides: tuple[TableSide, TableSide], first: str
) -> None:
    leads, follows = apart = sides
    follows.accounts.add_user("chief", PASSWORD, Role.ADMINISTRATOR)
    follows.accounts.add_user("ada", PASSWORD, Role.COMMANDER)
    token_id, token = follows.accounts.add_token("ada", "x", Role.VIEWER, None)
    person = follows.roster.add_person("Zoe", "", "")
    leads.copy(follows)
    follows.accounts.remove_token("ada", token_id)
    follows.accounts.change_user("ada", None, Role.VIEWER)
    follows.roster.remove_person(person.person_id)
    leads.accounts.change_user("ada", "another battery", None)  # later, and of something else
    meet(leads, follows, first)
    for one in apart:
        assert one.accounts.of_token(token) is None
        assert not one.roster.people()
        now = one.accounts.log_in("ada", "another battery")
        assert now is not None
        who = one.accounts.of_session(now)
        assert who is not None
        assert who.role is Role.VIEWER


@pytest.mark.parametrize("first", ["who leads", "who follows"])
def test_later_of_two_new_passwords_is_valid_alone(
    sides: tuple[TableSide, TableSide], first: str
) -> None:
    leads, follows = apart = sides
    follows.accounts.add_user("ada", PASSWORD, Role.ADMINISTRATOR)
    leads.copy(follows)
    leads.accounts.change_user("ada", "the earlier battery", None)
    with_earlier = leads.accounts.log_in("ada", "the earlier battery")
    assert with_earlier is not None
    follows.clock.advance(1.0)
    follows.accounts.change_user("ada", "the later battery", None)
    meet(leads, follows, first)
    for one in apart:
        assert one.accounts.of_session(with_earlier) is None
        assert one.accounts.log_in("ada", "the earlier battery") is None
        assert one.accounts.log_in("ada", "the later battery") is not None


def test_new_user_of_a_removed_name_is_kept(sides: tuple[TableSide, TableSide]) -> None:
    leads, follows = sides
    follows.accounts.add_user("chief", PASSWORD, Role.ADMINISTRATOR)
    follows.accounts.add_user("ada", PASSWORD, Role.COMMANDER)
    leads.copy(follows)
    follows.accounts.remove_user("ada")
    leads.clock.advance(1.0)
    leads.accounts.remove_user("ada")
    leads.accounts.add_user("ada", "another battery", Role.VIEWER)
    meet(leads, follows, "who leads")
    for one in sides:
        assert one.accounts.log_in("ada", "another battery") is not None


def test_used_ticket_stays_used(sides: tuple[TableSide, TableSide]) -> None:
    active, standby = sides
    active.accounts.add_user("ada", PASSWORD, Role.COMMANDER)
    there = active.accounts.log_in("ada", PASSWORD)
    assert there is not None
    ticket = active.accounts.create_login_ticket(there)
    assert ticket is not None
    standby.copy(active)
    assert standby.accounts.redeem_login_ticket(ticket) is not None
    active.accounts.create_login_ticket(there)  # so that all is copied again
    standby.copy(active)
    assert standby.accounts.redeem_login_ticket(ticket) is None
    assert active.tables.apply_removals(standby.tables.read())
    assert active.accounts.redeem_login_ticket(ticket) is None


def test_login_ended_while_the_other_was_off_ends_there(
    sides: tuple[TableSide, TableSide], tmp_path: Path
) -> None:
    active, standby = sides
    active.accounts.add_user("ada", PASSWORD, Role.COMMANDER)
    there = active.accounts.log_in("ada", PASSWORD)
    standby.copy(active)
    assert there is not None
    active.accounts.log_out(there)
    with Store(tmp_path / "standby" / "s.sqlite") as store:  # its program begins again
        again = TableSide(tmp_path / "standby", store)
        again.copy(active)
        assert again.accounts.of_session(there) is None


def meet(leads: TableSide, follows: TableSide, first: str) -> None:
    """Each hears of the other, one before the other one."""
    if first == "who leads":
        leads.tables.apply_removals(follows.tables.read())
    follows.copy(leads)
    leads.tables.apply_removals(follows.tables.read())
    follows.copy(leads)


def test_login_is_transferred_to_the_other_station_once(sides: tuple[TableSide, TableSide]) -> None:
    active, standby = sides
    active.accounts.add_user("ada", PASSWORD, Role.COMMANDER)
    there = active.accounts.log_in("ada", PASSWORD)
    assert there is not None
    ticket = active.accounts.create_login_ticket(there)
    assert ticket is not None
    assert standby.accounts.redeem_login_ticket(ticket) is None  # it has not heard of it
    standby.copy(active)
    here = standby.accounts.redeem_login_ticket(ticket)
    assert here is not None
    assert here != there
    assert standby.accounts.of_session(here) == active.accounts.of_session(there)
    assert standby.accounts.redeem_login_ticket(ticket) is None
    standby.copy(active)  # still has the ticket, which was never shown there
    assert active.accounts.create_login_ticket("no session") is None
    last = active.accounts.create_login_ticket(there)
    assert last is not None
    active.accounts.log_out(there)
    assert active.accounts.redeem_login_ticket(last) is None


def test_ticket_and_its_session_expire(sides: tuple[TableSide, TableSide]) -> None:
    active, _ = sides
    active.accounts.add_user("ada", PASSWORD, Role.COMMANDER)
    session = active.accounts.log_in("ada", PASSWORD)
    assert session is not None
    late, soon = (
        active.accounts.create_login_ticket(session),
        active.accounts.create_login_ticket(session),
    )
    assert late is not None
    assert soon is not None
    active.clock.advance(LOGIN_TICKET_S - 1.0)
    went_on = active.accounts.redeem_login_ticket(soon)
    assert went_on is not None
    active.clock.advance(1.0)
    assert active.accounts.redeem_login_ticket(late) is None
    # A session ends by the time of its login, however often it was continued by a ticket.
    active.clock.advance(SESSION_S - LOGIN_TICKET_S)
    assert active.accounts.of_session(went_on) is None
