"""No link leads out of a station's or unit's folder: otherwise root would write to, empty or give
away a file that somebody with access to the folder has chosen.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest
from typer.main import get_command
from typer.testing import CliRunner

from base_station import cli as base_cli
from base_station.app.first_login import ensure_administrator
from base_station.app.pki_cli import app as pki_cli
from base_station.privacy.pending_erasure import PendingErasure
from base_station.security.pki.folder import PkiFolder
from base_station.storage.db.accounts import Accounts
from base_station.storage.db.store import Store
from edge.storage.black_box.station_time import write_clock_offset
from edge.storage.data_folder import UnitDataFolder as UnitFolder
from shared.clock import ManualClock
from shared.errors import MusterError
from shared.out_file import whole
from tests.rig.quick_hash import QUICK_HASH
from tests.unit.shared import test_own_files as writes

VICTIM = "of somebody else"

# ---- every command


def names_of(group: Any, before: str = "") -> Iterator[str]:
    for name, command in group.commands.items():
        called = f"{before} {name}".strip()
        if hasattr(command, "commands"):
            yield from names_of(command, called)
        else:
            yield called


COMMANDS: dict[str, tuple[str, ...]] = {
    "serve": ("--listen", "tcp/127.0.0.1:1", "--http", "127.0.0.1:0"),  # it never gets there
    "rebuild": (),
    "backup": ("COPY",),
    "forget": ("Ada",),
    "import": ("i1",),
    "users list": (),
    "users add": ("bob",),
    "users password": ("mia",),
    "users remove": ("mia",),
    "unit-tokens list": ("FF-01",),
    "unit-tokens add": ("FF-01", "--user", "mia"),
    "unit-tokens remove": ("FF-01", "token"),
    "foxglove live": (),
    "log recover": (),
    "log list": (),
    "search": ("mill",),
    "archive copy": ("ARCHIVE",),
    "fetch-recording": ("FF-01", "--from", "2026-03-01T10:00"),
}
WITHOUT_FOLDER = {
    # They read a given folder or file, and write nothing of it.
    *("replay", "assess", "smooth", "report", "export", "rehearse", "rerun", "foxglove replay"),
    *("archive list", "archive verify", "archive fetch"),  # they read the archive alone
    "foxglove layout",  # it reads the log alone, and writes to the given path
    "dispatch",  # it passes it to a running station
    "compile",  # into the program's own folder
}
PKI_COMMANDS: dict[str, tuple[str, ...]] = {
    "init": ("--host", "10.0.0.1"),
    "enroll": ("FF-09", "--out", "OUT"),
    "renew": ("FF-01", "--out", "OUT"),
    "renew-station": (),
    "enroll-station": ("two", "--host", "10.0.0.2", "--out", "OUT"),
    "join": ("FILE",),
    "revoke": ("FF-01",),
    "show": (),
}
FOLDERS = ("log", "checkpoints", "recordings", "apart", "log.part", "pki")
FILES = (
    *("lock", "station.sqlite", "forgetting.json", "first-login.txt.partial", "of-anybody"),
    *("log/000009-20260301T100000Z.mcap", "log/000001-20260301T100000Z.mcap.recovering"),
    *("checkpoints/saving.part", "recordings/FF-01/1/raw.mcap.part", "pki/registry.json"),
    *("pki/lock", "pki/station.key.partial", "pki/authority.key"),
)


def test_every_command_is_checked_here() -> None:
    assert {*names_of(get_command(base_cli.app))} == {*COMMANDS, *WITHOUT_FOLDER}
    assert {*names_of(get_command(pki_cli))} == {*PKI_COMMANDS}


@pytest.fixture(scope="module")
def station(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with all files of a station."""
    data = tmp_path_factory.mktemp("served") / "station"
    writes.write_log(data)
    PkiFolder(data).create("Fire", ["10.0.0.1"], ["tls/10.0.0.1:7447"])
    PkiFolder(data).enroll("FF-01")
    made = ["enroll-station", "two", "--host", "10.0.0.2", "--out", str(data.parent / "FILE")]
    assert CliRunner().invoke(pki_cli, [*made, "--data", str(data)]).exit_code == 0
    with Store(data / "station.sqlite"):
        pass
    return data


class Outside:
    """A file and a folder outside, and their state before."""

    def __init__(self, folder: Path) -> None:
        self.file, self.folder = folder / "victim", folder / "victims"
        self.file.write_text(VICTIM)
        self.file.chmod(0o644)
        self.folder.mkdir()
        self.note()

    def note(self) -> None:
        self._before = self._state()

    def _state(self) -> object:
        return [
            (path.name, path.stat().st_uid, path.stat().st_mode)
            for path in (self.file, self.folder, *self.folder.rglob("*"))
        ], self.file.read_bytes()

    def require_untouched(self, by: object) -> None:
        assert self._state() == self._before, by


@pytest.fixture
def outside(tmp_path: Path) -> Outside:
    return Outside(tmp_path)


def planted(station: Path, outside: Outside, among: set[str]) -> Iterator[str]:
    """Plant a link at each place in turn, and restore the file afterwards."""
    for place in sorted(among):
        path = station / place
        hidden = path.with_name(f"hidden-{path.name}")
        made = [one for one in path.relative_to(station).parents if not (station / one).exists()]
        path.parent.mkdir(parents=True, exist_ok=True)
        if path.exists():
            path.rename(hidden)
        path.symlink_to(outside.folder if place in FOLDERS else outside.file)
        yield place
        path.unlink()
        if hidden.exists():
            hidden.rename(path)
        for one in made:
            (station / one).rmdir()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("command", "arguments"),
    [
        *((f"base {name}", arguments) for name, arguments in COMMANDS.items()),
        *((f"pki {name}", arguments) for name, arguments in PKI_COMMANDS.items()),
    ],
)
def test_command_reports_the_link_and_stops(
    station: Path,
    outside: Outside,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    command: str,
    arguments: tuple[str, ...],
) -> None:
    monkeypatch.setattr("shared.log.set_up_logging", lambda *_: None)
    of, _, name = command.partition(" ")
    paths = {"FILE": station.parent / "FILE", "COPY": tmp_path / "COPY", "OUT": tmp_path / "OUT"}
    paths["ARCHIVE"] = tmp_path / "ARCHIVE"
    reported = [str(paths.get(one, one)) for one in arguments]
    flags = [*name.split(), *reported, "--data", str(station)]
    refused, mask = set(), os.umask(0o022)
    everywhere = {*FOLDERS, *FILES}
    of_pki = {place for place in everywhere if place.startswith("pki")}
    among = everywhere if of == "base" else of_pki
    for place in planted(station, outside, among):
        app = base_cli.app if of == "base" else pki_cli
        result = CliRunner().invoke(app, flags, input="something long enough\n")
        outside.require_untouched((place, result.output))
        if result.exception is not None and "is a link" in str(result.exception):
            assert isinstance(result.exception, MusterError), result.exception
            refused.add(place)
        assert (tmp_path / "COPY").exists() is False
        (tmp_path / "OUT").unlink(missing_ok=True)
    os.umask(mask)  # which a command may have set for its process
    assert refused == among


# ---- every write, with links planted after the command's check


def save_unit(data: Path) -> None:
    UnitFolder(data / "FF-01").close()


def note_time(data: Path) -> None:
    write_clock_offset(data, 1)


def write_out(data: Path) -> None:
    with whole(data / "out.csv") as making:
        making.write_text("1,2")


def make_login(data: Path) -> None:
    (data / "db").mkdir(exist_ok=True)
    with Store(data / "db" / "station.sqlite") as store:
        ensure_administrator(Accounts(store, ManualClock(), QUICK_HASH), data / "first-login.txt")


def note_erasure(data: Path) -> None:
    PendingErasure(data / "forgetting-begun.json")


def make_pki(data: Path) -> None:
    folder = PkiFolder(data)
    if not folder.exists():
        folder.create("Fire", ["10.0.0.1"], ["tls/10.0.0.1:7447"])
    folder.renew_station()


ACTS: tuple[Callable[[Path], None], ...] = (
    writes.write_log,
    writes.mend_log,
    writes.rewrite_log,
    writes.cut_log,
    writes.hold,
    writes.save_state,
    writes.fill_database,
    writes.pull_recording,
    writes.make_backup,
    *(save_unit, note_time, write_out, make_login, make_pki),
)
_opened: list[Path] | None = None  # opened for writing, while a command is watched


def _watch(event: str, args: tuple[Any, ...]) -> None:
    if _opened is None:
        return
    if event == "open" and isinstance(args[0], str | Path):
        if args[2] & (os.O_WRONLY | os.O_RDWR | os.O_CREAT):
            _opened.append(Path(args[0]))
    elif event == "sqlite3.connect":
        _opened.append(Path(str(args[0])))


sys.addaudithook(_watch)


def written_by(act: Callable[[Path], None], data: Path) -> set[Path]:
    """Names of the files of its folder that a command opens for writing."""
    global _opened  # noqa: PLW0603  # an audit hook cannot be taken away
    _opened = []
    try:
        act(data)
    finally:
        opened, _opened = _opened, None
    return {path.relative_to(data) for path in opened if path.is_relative_to(data)}


@pytest.mark.slow
@pytest.mark.parametrize("act", ACTS)
def test_no_write_follows_a_link(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, act: Callable[[Path], None]
) -> None:
    for module in (
        "shared.folder_lock",
        "base_station.security.pki.folder",
        "base_station.app.backup",
        "base_station.storage.data_folder",
    ):
        monkeypatch.setattr(f"{module}.refuse_links", lambda *_: None)
    (tmp_path / "clean").mkdir()
    if os.geteuid() == 0:
        os.chown(tmp_path / "clean", writes.STATION, writes.STATION)
    places = written_by(act, tmp_path / "clean")
    assert places, "it writes nothing that is seen"
    for number, place in enumerate(sorted(places)):
        for kind in ("symlink", "hardlink") if os.geteuid() == 0 else ("symlink",):
            here = tmp_path / f"{number}-{kind}"
            here.mkdir()
            outside = Outside(here)
            path = here / "station" / place
            path.parent.mkdir(parents=True)
            (path.symlink_to if kind == "symlink" else path.hardlink_to)(outside.file)
            if os.geteuid() == 0:
                for one in (here / "station", *path.relative_to(here / "station").parents):
                    os.chown(here / "station" / one, writes.STATION, writes.STATION)
            outside.note()
            with suppress(MusterError, OSError, AssertionError, ValueError):  # it found a link
                act(here / "station")
            outside.require_untouched(f"{act.__name__} at {place}")
