"""A station's first login, with its password changed as the station asks."""

from __future__ import annotations

from pathlib import Path

import httpx

from shared.errors import StoreError
from tests.rig.plain_http import NO_AUTHORITIES
from tests.rig.waiting import PATIENCE_S

_CHANGED = "-changed"


def first_login(url: str, note: Path) -> tuple[str, str]:
    """Name and password of the administrator that the station at ``url`` made and noted.  Where the
    password must be changed it is, and the note has the new one.  Raises StoreError where the
    station does not answer or refuses.
    """
    fields = dict(line.split(": ", 1) for line in note.read_text(encoding="utf-8").splitlines())
    username, password = fields["username"], fields["password"]
    if password.endswith(_CHANGED):  # no login more, in what is measured
        return username, password
    try:
        changed = _log_in_and_change(url, username, password)
    except httpx.HTTPError as error:
        raise StoreError(f"{url} does not take its first login: {error}") from error
    if changed != password:
        note.write_text(f"username: {username}\npassword: {changed}\n", encoding="utf-8")
    return username, changed


def _log_in_and_change(url: str, username: str, password: str) -> str:
    """The password that holds from now on."""
    with httpx.Client(
        base_url=f"{url}/api/v1", headers={"Origin": url}, timeout=PATIENCE_S, verify=NO_AUTHORITIES
    ) as client:
        login = {"username": username, "password": password}
        me = client.post("/login", json=login).raise_for_status().json()
        if not me["must_change_password"]:
            client.post("/logout")
            return password
        changed = f"{password}{_CHANGED}"
        change = {"old_password": password, "new_password": changed}
        client.post("/me/password", json=change).raise_for_status()
    return changed
