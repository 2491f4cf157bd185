"""Secrets of a station that other users of the machine could read.  Their files are closed to them
when the station starts, and named until it ends, as another user may have read them.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from base_station.security.pki.folder import PkiFolder
from base_station.storage.data_folder import DataFolder
from shared.coded_text import Term, coded
from shared.secret_files import ALL_BUT_OWNER, OTHERS, close_to_others

_ADVICE = {
    "authority.key": Term(
        "authority_key",
        "with it any unit can be enrolled: if strangers use this machine, make a new authority and "
        "enrol all units anew",
    ),
    "station.key": Term(
        "station_key",
        "with it a machine can pose as this station: if strangers use this one, make a new "
        "authority and enrol all units anew",
    ),
    "first-login.txt": Term("first_login", "give the administrator another password"),
}
_OTHERWISE = Term("key", "if strangers use this machine, make another key")
_DATABASE = Term(
    "database_password",
    "if strangers use this machine, give the database's user another password",
)
_ACCOUNTS = Term("database", "if strangers use this machine, give every user another password")


class ExposedSecrets:
    def __init__(
        self, folder: DataFolder, console_key: Path | None, database_password: Path | None = None
    ) -> None:
        """Close the files.  ``console_key`` and the file of the ``database_password`` may be shared
        with other programs of their group.
        """
        self._problems = tuple(_sentences(folder, console_key, database_password))

    def problems(self) -> tuple[str, ...]:
        """Sentences about problems, for the console."""
        return self._problems


def _sentences(
    folder: DataFolder, console_key: Path | None, database_password: Path | None
) -> Iterator[str]:
    pki = PkiFolder(folder.path).path
    for path in (*sorted(pki.glob("*.key")), folder.first_login, folder.database):
        remedy = _ACCOUNTS if path == folder.database else _ADVICE.get(path.name, _OTHERWISE)
        yield from _closed(path, ALL_BUT_OWNER, remedy)
    if console_key is not None and console_key.parent.resolve() != pki.resolve():
        yield from _closed(console_key, OTHERS, _OTHERWISE)
    if database_password is not None:
        yield from _closed(database_password, OTHERS, _DATABASE)


def _closed(path: Path, whom: int, remedy: Term) -> Iterator[str]:
    try:
        mode = close_to_others(path, whom)
    except FileNotFoundError:
        return
    except OSError as error:
        yield coded(
            "secret-open",
            "{path} can be read or changed by others, and that cannot be taken away ({error}): "
            "give it to the station's user with mode 0600; {remedy}",
            path=str(path),
            error=error.strerror or "",
            remedy=remedy,
        )
        return
    if mode:
        yield coded(
            "secret-was-open",
            "{path} could be read or changed by others (mode {mode}) and has been closed to "
            "them; {remedy}",
            path=str(path),
            mode=f"{mode:04o}",
            remedy=remedy,
        )
