"""Address of the PostgreSQL server that has a station's tables, and its note in the data folder.

The commands that work on the folder read the note to find its database.  Neither has a password:
that comes from a file of its own, or from the environment as libpq reads it (``PGPASSWORD``,
``PGPASSFILE``).
"""

from __future__ import annotations

import urllib.parse
from pathlib import Path

import msgspec

from base_station.storage.private_files import write_atomically
from shared.errors import ConfigError, StoreError
from shared.host_names import is_loopback
from shared.own_files import read_own

SCHEME = "postgresql+psycopg"
NOTE = "database-server.json"
_EXAMPLE = f"{SCHEME}://muster@db.example/muster"


class ServerAddress(msgspec.Struct, frozen=True):
    """Raises ConfigError where the URL is none of a PostgreSQL database, or has a password."""

    url: str
    password_file: str = ""  # its first line is the password; empty: the environment's

    def __post_init__(self) -> None:
        parts = urllib.parse.urlsplit(self.url)
        if parts.password is not None or "password" in urllib.parse.parse_qs(parts.query):
            raise ConfigError(
                "database has a password in it, which all who may read the settings see: give it "
                "in database_password_file, or as PGPASSWORD in the environment"
            )
        if parts.scheme != SCHEME or not parts.path.strip("/"):
            raise ConfigError(f"database {self.url!r} is no database: write it as {_EXAMPLE}")

    @property
    def is_on_this_machine(self) -> bool:
        """True if nothing that is asked of it leaves this machine."""
        parts = urllib.parse.urlsplit(self.url)
        host = parts.hostname or urllib.parse.parse_qs(parts.query).get("host", [""])[0]
        return not host or host.startswith("/") or is_loopback(host)

    def password(self) -> str | None:
        """None: libpq finds it in the environment, or there is none.  Raises StoreError."""
        if not self.password_file:
            return None
        try:
            text = Path(self.password_file).read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            raise StoreError(f"the database's password cannot be read: {error}") from error
        return text.partition("\n")[0].rstrip("\r")


def noted_server(database: Path) -> ServerAddress | None:
    """The server that the note beside a data folder's database file names; None: there is no note,
    and the file is the database.  Raises StoreError where it cannot be read.
    """
    note = database.with_name(NOTE)
    try:
        with read_own(note) as file:
            return msgspec.json.decode(file.read(), type=ServerAddress)
    except FileNotFoundError:
        return None
    except (OSError, msgspec.DecodeError, ConfigError) as error:
        raise StoreError(
            f"{note} cannot be read ({error}): it has the database's address; start the station "
            "with its settings, which writes it again"
        ) from error


def note_server(database: Path, server: ServerAddress | None) -> None:
    """Write the note, or remove it.  Raises StoreError where the disk does not take it."""
    note = database.with_name(NOTE)
    if server is None:
        note.unlink(missing_ok=True)
    elif not note.exists() or noted_server(database) != server:
        write_atomically(note, msgspec.json.encode(server))
