"""Descriptions of fields about users, logins and API tokens."""

from __future__ import annotations

from collections.abc import Mapping

FIELDS: Mapping[str, str] = {
    "password": "The password.",
    "UserChange.password": "The new password; null: it stays.",
    "UserChange.role": "The new role; null: it stays.",
    "must_change_password": "Whether the password was generated: until it is changed "
    "(/me/password) all else is refused.",
    "old_password": "The password until now.",
    "new_password": "The password from now on.",
    "ticket": "A secret that logs its holder in at the other station, once.",
    "lasts_s": "For how many seconds the ticket is good.",
    "created_ms": "When it was made.",
    "sessions": "How many login sessions of the user are open.",
    "token": "The secret to send as Authorization: Bearer; it is shown this once.",
    "token_id": "Id of the API token, which is no secret.",
    "scopes": "Parts of the API that the token is for; empty: all that its role may.",
    "days": "For how many days the token is good; null: until it is removed.",
    "Token.expires_ms": "When the token ends; null: it does not.",
}
