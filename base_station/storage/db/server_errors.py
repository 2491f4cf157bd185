"""Refusals of a PostgreSQL server in words: the fault and advice.

https://www.postgresql.org/docs/current/errcodes-appendix.html has the codes.
"""

from __future__ import annotations

from typing import NamedTuple

from sqlalchemy.exc import DBAPIError, InterfaceError, OperationalError, SQLAlchemyError

from shared.coded_text import code_of_text, coded, text_of_error
from shared.errors import DatabaseAwayError, DiskFullError, StoreError


class _Remedy(NamedTuple):
    codes: tuple[str, ...]  # SQLSTATE, or how it begins
    remedy: str
    kind: type[StoreError] = StoreError


_REMEDIES = (
    _Remedy(("53100",), "free the disk of the database server", DiskFullError),
    _Remedy(
        ("25006",),
        "the database can only be read: see whether the server is a replica, or set read-only",
    ),
    _Remedy(("42501",), "give the station's database user the right to make and change tables"),
    _Remedy(("55P03",), "another program holds a lock in the database; see which one, and end it"),
    _Remedy(("57014",), "the database server ended the statement: see its statement_timeout"),
)
# Connection lost or refused (08, 57P), no connection left (53300): it may be there in a moment.
_AWAY = ("08", "57P", "53300")


def store_error(error: SQLAlchemyError, what: str) -> StoreError:
    """``what`` was tried.  The reason never has a password: libpq reports none."""
    cause = getattr(error, "orig", None) or error
    code = str(getattr(cause, "sqlstate", None) or "")
    reason = str(cause).strip().partition("\n")[0] or type(cause).__name__
    if is_away(error):
        return DatabaseAwayError(_unreachable(reason))
    for one in _REMEDIES:
        if code.startswith(one.codes):
            return one.kind(f"{what}: {reason}; {one.remedy}")
    return StoreError(f"{what}: {reason}")


def is_about_certificate(refusal: StoreError) -> bool:
    """True where the text says what to do about TLS, and nothing else is wrong."""
    return code_of_text(text_of_error(refusal)).code not in ("", "database-unreachable")


def _unreachable(reason: str) -> str:
    """Text for a person.  libpq gives no code for what it finds wrong in a certificate."""
    if "does not match host name" in reason:
        return coded(
            "database-certificate-name",
            "the database server has a certificate for another name ({reason}): write the name "
            "that it is for in the address, or give the server one for its name",
            reason=reason,
        )
    if "certificate verify failed" in reason:
        return coded(
            "database-certificate-refused",
            "the certificate of the database server is not accepted ({reason}): it has expired, "
            "is not valid yet, or is of another authority than that of sslrootcert in the "
            "address; see its dates (openssl x509 -noout -dates -issuer) and this machine's clock",
            reason=reason,
        )
    if "root certificate file" in reason:
        return coded(
            "database-authority-unread",
            "the authority of the database server's certificate cannot be read ({reason}): give "
            "its certificate, as PEM, in sslrootcert in the address",
            reason=reason,
        )
    if "does not support SSL" in reason:
        return coded(
            "database-unencrypted",
            "the database server has no certificate ({reason}): turn on ssl at the server",
            reason=reason,
        )
    return coded(
        "database-unreachable", "the database server does not answer ({reason})", reason=reason
    )


def is_away(error: SQLAlchemyError) -> bool:
    """True where the server could not be reached, or ended the connection."""
    if not isinstance(error, DBAPIError):
        return False
    code = str(getattr(error.orig, "sqlstate", None) or "")
    if code:
        return code.startswith(_AWAY)
    return isinstance(error, OperationalError | InterfaceError)
