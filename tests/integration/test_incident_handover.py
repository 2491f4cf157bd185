"""A handed-over incident is complete: with imported files, and optionally with the radio."""

from __future__ import annotations

import re
from collections.abc import Callable
from contextlib import ExitStack, closing
from pathlib import Path

import pytest
from mcap.reader import make_reader
from typer.testing import CliRunner

from base_station.app.archive_sources import open_archived_log
from base_station.app.offline_log import OfflineLog, named_incident, open_offline_log
from base_station.archive.store import open_store
from base_station.cli import app
from base_station.radio.packets import Packet, payload_of
from base_station.radio.radio_log import RadioLog
from base_station.storage.db.records import Records
from base_station.storage.db.store import Store
from base_station.storage.imports import import_id_of
from shared.clock import NS_PER_MS, NS_PER_S, SystemClock
from shared.mcap_log import SegmentWriter, audio_topic
from tests.rig.imported_files import exif_time, line, write_gpx, write_photo
from tests.rig.walked_folder import new_folder

TAC = "Tac-1"
PACKETS = 300  # of 20 ms
Opened = Callable[[Path, ExitStack], OfflineLog]


@pytest.fixture(scope="module")
def data(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A closed incident with a track and a photograph that came later, and some audio."""
    folder = new_folder(tmp_path_factory.mktemp("station"), "i1", 60)
    with Store(folder / "station.sqlite") as store:
        opened_ns = Records(store, SystemClock()).require_incident("i1").opened_ns
    opened_s = opened_ns // NS_PER_S
    given = tmp_path_factory.mktemp("given")
    track = write_gpx(given / "drone.gpx", "Drone", line(opened_s, 30))
    photo = write_photo(given / "door.jpg", (52.0, 4.0), exif_time(opened_s + 20), "+00:00")
    muster("import", "i1", track, photo, "--data", folder)
    with closing(SegmentWriter(folder / "radio" / TAC)) as log:
        for number in range(PACKETS):
            t_ns = opened_ns + number * 20 * NS_PER_MS
            packet = Packet(t_ns, bytes((0x78, number % 251)) + bytes(60))
            log.write(t_ns, audio_topic(TAC), payload_of(packet))
    return folder


def muster(*arguments: str | Path) -> str:
    result = CliRunner().invoke(app, list(map(str, arguments)))
    assert result.exit_code == 0, (result.output, result.exception)
    return result.output


def from_file(file: Path, closing_all: ExitStack) -> OfflineLog:
    incident_id, path = named_incident(str(file), file)
    return opened_offline(path, incident_id, closing_all)


def from_archive(place: Path, closing_all: ExitStack) -> OfflineLog:
    return open_archived_log(open_store(str(place)), "i1", closing_all, lambda _: None)


def from_folder(folder: Path, closing_all: ExitStack) -> OfflineLog:
    return opened_offline(folder, "i1", closing_all)


def opened_offline(path: Path, incident_id: str, closing_all: ExitStack) -> OfflineLog:
    return open_offline_log(
        path, incident_id, closing_all, lambda _: None, lambda _: None, in_place=False
    )


@pytest.mark.parametrize(
    ("command", "name", "opened"),
    [
        (("export", "i1"), "whole.mcap", from_file),
        (("archive", "copy"), "archive", from_archive),
        (("backup",), "backup", from_folder),
    ],
    ids=["file", "archive", "backup"],
)
@pytest.mark.parametrize("radio", [("--radio",), ()], ids=["with audio", "without"])
def test_handed_over_incident_contains_imported_files_and_radio(
    data: Path,
    tmp_path: Path,
    command: tuple[str, ...],
    name: str,
    opened: Opened,
    radio: tuple[str, ...],
) -> None:
    muster(*command, tmp_path / name, "--data", data, *radio)
    with ExitStack() as closing_all:
        found = opened(tmp_path / name, closing_all)
        records = Records(found.store, SystemClock())
        incident = records.require_incident("i1")
        rows = records.imports_of("i1")
        assert [row.file_name for row in rows] == ["drone.gpx", "door.jpg"]
        for row in rows:
            content = found.imports.content("i1", row.import_id)
            original = found.imports.original("i1", row.import_id)
            assert content is not None
            assert original is not None
            assert import_id_of(original) == (row.import_id, row.sha256), "byte for byte"
            assert (content.format, len(content.tracks)) == (row.format, 1)
        window = incident.opened_ns, incident.opened_ns + 6 * NS_PER_S
        assert found.radio.channels() == ((TAC,) if radio else ())
        if radio:
            here = RadioLog(data / "radio").audio(TAC, *window)
            assert found.radio.audio(TAC, *window) == here
        before = list(from_folder(data, closing_all).log.records(*window))
        assert list(found.log.records(*window)) == before


def test_standard_reader_finds_the_audio_and_the_files(data: Path, tmp_path: Path) -> None:
    file = tmp_path / "whole.mcap"
    muster("export", "i1", file, "--data", data, "--radio")
    with file.open("rb") as stream:
        reader = make_reader(stream, validate_crcs=True)
        times = [one.log_time for _, _, one in reader.iter_messages()]
        spoken = list(reader.iter_messages([audio_topic(TAC)]))
        attached = list(reader.iter_attachments())
    assert times == sorted(times)
    assert {schema.name for schema, _, _ in spoken if schema} == {"foxglove.CompressedAudio"}
    assert len(spoken) == PACKETS
    originals = (data / "imports" / "i1").glob("*.original")
    assert {one.data for one in attached if one.name.endswith(".original")} == {
        path.read_bytes() for path in originals
    }


def test_the_report_names_the_files_and_the_moment_of_a_photograph(
    data: Path, tmp_path: Path
) -> None:
    page = tmp_path / "report.html"
    muster("report", "i1", "--data", data, "--html", page)
    text = page.read_text("utf-8")
    rows = text[text.index("<h2>Brought in") : text.index("<h2>Quality")]
    drone, door = (rows[rows.index(name) :] for name in ("drone.gpx", "door.jpg"))
    assert re.search(r">(\d\d:\d\d:\d\d) to (?!\1)\d\d:\d\d:\d\d<", drone[: drone.index("</tr>")])
    assert re.search(r">\d\d:\d\d:\d\d<", door[: door.index("</tr>")])


def test_audio_that_the_station_has_deleted_goes_from_the_backup_too(
    data: Path, tmp_path: Path
) -> None:
    backup = tmp_path / "backup"
    muster("backup", backup, "--data", data, "--radio")
    assert RadioLog(backup / "radio").channels() == (TAC,)
    moved = (data / "radio").rename(tmp_path / "deleted")
    try:
        muster("backup", backup, "--data", data)
        assert RadioLog(backup / "radio").channels() == ()
    finally:
        moved.rename(data / "radio")


def test_audio_of_another_station_is_erased_with_the_incident_that_it_was_brought_into(
    data: Path, tmp_path: Path
) -> None:
    """A file that was brought in is evidence: erasing a person leaves it, and says so."""
    file = tmp_path / "whole.mcap"
    muster("export", "i1", file, "--data", data, "--radio")
    here = new_folder(tmp_path / "here", "i7", 60)
    before, brought_in = contents_of(here), file.read_bytes()
    pieces = [one for one in pieces_of(brought_in) if one not in before]
    assert len(pieces) > 10
    muster("import", "i7", file, "--data", here)
    assert brought_in in contents_of(here)
    printed = forget(here, "ada0")
    assert "take out those that have the person" in printed
    assert brought_in in contents_of(here)
    printed = forget(here, "i7")
    assert "take out" not in printed
    left = contents_of(here)
    assert not [one for one in pieces if one in left]


def forget(folder: Path, subject: str) -> str:
    flags = ["forget", subject, "--data", str(folder)]
    result = CliRunner().invoke(app, flags, input=f"{subject}\n")
    assert result.exit_code == 0, (result.output, result.exception)
    return " ".join(result.output.split())


def contents_of(folder: Path) -> bytes:
    return b"".join(path.read_bytes() for path in folder.rglob("*") if path.is_file())


def pieces_of(content: bytes, size: int = 64) -> list[bytes]:
    """Pieces out of all of it, those of one value left out."""
    pieces = (content[at : at + size] for at in range(0, len(content) - size, 997))
    return [one for one in pieces if len({*one}) > size // 4]
