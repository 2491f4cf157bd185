"""Opens a data folder's database: the file in it, or the server that its note names."""

from __future__ import annotations

from contextlib import ExitStack
from pathlib import Path

from base_station.storage.db.database import Database
from base_station.storage.db.server_address import NOTE, ServerAddress, noted_server
from base_station.storage.db.server_store import ServerStore
from base_station.storage.db.store import Store
from base_station.storage.db.table_copy import copy_kept, copy_tables_of, has_users
from shared.errors import StoreError


def open_database(path: Path) -> Database:
    """The database of the folder whose file ``path`` is, or would be.  Raises StoreError."""
    server = noted_server(path)
    return Store(path) if server is None else ServerStore(server)


def open_live_server(server: ServerAddress, path: Path) -> tuple[ServerStore, bool]:
    """Open a live station's database on a server.  Returns True too if it was new: then users,
    people and all else that no log has were copied from the file ``path``.  Raises StoreError.
    """
    noted = noted_server(path)
    store = ServerStore(server, is_station=True)
    with ExitStack() as undo:
        undo.callback(store.close)
        is_new = not has_users(store)
        if is_new and noted is not None and noted.url != server.url:
            raise StoreError(
                f"{store.name} is empty, and the tables of {path.parent} are on {noted.url}: bring "
                f"them over (pg_dump, pg_restore), or remove {path.with_name(NOTE)}"
            )
        is_copied = is_new and noted is None and path.exists()
        if is_copied:
            with Store(path) as file:
                copy_kept(file, store)
        undo.pop_all()
    return store, is_copied


def require_noted_server(path: Path, server: ServerAddress | None) -> None:
    """Raises StoreError where the folder's tables are elsewhere than the settings have them."""
    noted = noted_server(path)
    if noted is None or server is not None:
        return
    raise StoreError(
        f"the tables of {path.parent} are on {noted.url}, and the settings name no database: give "
        f"its address again; or bring the tables into a file: 'muster base backup' makes a folder "
        f"that has one; or remove {path.with_name(NOTE)} to go on without them"
    )


def copy_to_file(path: Path, target: Path) -> bool:
    """Copy a server's tables into a new file, which every command reads; False where the folder's
    database is a file itself.  Raises StoreError.
    """
    server = noted_server(path)
    if server is None:
        return False
    target.unlink(missing_ok=True)
    with ServerStore(server) as store, Store(target) as copy:
        copy_tables_of(store, copy)
    return True
