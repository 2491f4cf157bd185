"""The people who may log in; an administrator's work, but everyone changes their own password."""

from __future__ import annotations

from typing import Annotated, Literal

from fastapi import APIRouter, Path, Request, Response
from pydantic import BaseModel, StringConstraints

from base_station.accounts.passwords import MAX_PASSWORD, MIN_PASSWORD
from base_station.accounts.principals import Role
from base_station.api.authentication import Administrator, Viewer
from base_station.api.forms import Form, Name
from base_station.api.login_throttle import Throttle
from base_station.api.problems import Problem
from base_station.api.routes.login import set_session_cookie
from base_station.api.services import Logins
from base_station.views.answer import to_ms
from shared.coded_text import coded

router = APIRouter(tags=["users"])

Password = Annotated[str, StringConstraints(min_length=MIN_PASSWORD, max_length=MAX_PASSWORD)]
RoleWord = Literal["viewer", "commander", "administrator"]
Username = Annotated[str, Path(min_length=1, max_length=80)]


class UserAnswer(BaseModel):
    username: str
    role: str
    created_ms: int
    sessions: int  # that are open


class NewUser(Form):
    username: Name
    password: Password
    role: RoleWord


class UserChange(Form):
    password: Password | None = None
    role: RoleWord | None = None


class PasswordChange(Form):
    old_password: Annotated[str, StringConstraints(max_length=MAX_PASSWORD)]
    new_password: Password


@router.get("/users")
def list_users(station: Logins, _: Administrator) -> list[UserAnswer]:
    sessions = station.accounts.open_sessions()
    return [
        UserAnswer(
            username=user.username,
            role=user.role,
            created_ms=to_ms(user.created_ns),
            sessions=sessions.get(user.username, 0),
        )
        for user in station.accounts.users()
    ]


@router.post("/users", status_code=204)
def add_user(new: NewUser, station: Logins, who: Administrator) -> None:
    station.accounts.add_user(new.username, new.password, Role.of(new.role))
    station.records.audit(who.username, "AddedUser", f"{new.username} as {new.role}")


@router.put("/users/{username}", status_code=204)
def change_user(
    username: Username, change: UserChange, station: Logins, who: Administrator
) -> None:
    role = None if change.role is None else Role.of(change.role)
    station.accounts.change_user(username, change.password, role)
    what = [*(["password"] if change.password else []), *([change.role] if change.role else [])]
    station.records.audit(who.username, "ChangedUser", f"{username}: {', '.join(what)}")


@router.delete("/users/{username}", status_code=204)
def remove_user(username: Username, station: Logins, who: Administrator) -> None:
    station.accounts.remove_user(username)
    station.records.audit(who.username, "RemovedUser", username)


@router.delete("/users/{username}/sessions", status_code=204)
def end_sessions(username: Username, station: Logins, who: Administrator) -> None:
    """End all sessions of a user, who has to log in again; API tokens stay valid."""
    station.accounts.end_sessions(username)
    station.records.audit(who.username, "EndedSessions", username)


@router.post("/me/password", status_code=204)
def change_own_password(
    change: PasswordChange,
    station: Logins,
    who: Viewer,
    throttle: Throttle,
    request: Request,
    response: Response,
) -> None:
    """Change one's own password, which ends all sessions of the user.  A user who had to change it
    gets a new session.
    """
    throttle.check_account(who.username)
    if change.new_password == change.old_password:
        raise Problem(
            422, coded("password-same", "The new password is the old one; choose another.")
        )
    if not station.accounts.verify_password(who.username, change.old_password):
        station.records.audit(who.username, "PasswordRefused", "")
        raise Problem(403, coded("password-wrong", "The old password is wrong."))
    station.accounts.change_user(who.username, change.new_password, None)
    station.records.audit(who.username, "ChangedOwnPassword", "")
    if who.must_change_password:
        set_session_cookie(request, response, station, station.accounts.begin_session(who.username))
