"""``muster base report`` on a log alone, a damaged or open one, and one with erased people."""

from __future__ import annotations

import re
import shutil
import sys
from html.parser import HTMLParser
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from base_station.app import folder_commands as station_app
from base_station.cli import app
from base_station.replay.processes.log_process import LogProcess
from base_station.replay.processes.server import ReplayProcesses
from base_station.report.floor_pictures import COLOURS
from base_station.report.process import ReportProcess
from base_station.storage.data_folder import DataFolder
from base_station.storage.db.models import IncidentRow
from base_station.storage.db.records import Records
from base_station.storage.db.store import Store
from shared.channels import OPERATOR, POSITION
from shared.clock import SystemClock
from shared.codec import decode
from shared.errors import StoreError, UserError
from shared.mcap_log import segment_paths
from shared.messages import STATION_ID, OperatorAction
from shared.messages.station import SetAnchor, SetPlan
from tests.rig.full_disk import files_of_at_most
from tests.rig.imported_files import exif_time, write_photo
from tests.rig.reported_incident import HOSTILE, incident_records, write_log
from tests.rig.station_script import Record


class _Page(HTMLParser):
    """Tags, texts and headings of a page."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.tags: list[str] = []
        self.words: list[str] = []
        self.feed(page)

    def handle_starttag(self, tag: str, attrs: object) -> None:
        self.tags.append(tag)

    def handle_data(self, data: str) -> None:
        self.words.append(data)

    @property
    def text(self) -> str:
        return " ".join(self.words)


@pytest.fixture(scope="module")
def given(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("given")
    write_log(folder, incident_records())
    return folder


@pytest.fixture(scope="module")
def written(given: Path, tmp_path_factory: pytest.TempPathFactory) -> bytes:
    return _page(given, tmp_path_factory.mktemp("out") / "report.html")


def report(data: Path, *options: str) -> Result:
    return CliRunner().invoke(app, ["report", "i1", "--data", str(data), *options])


def _page(data: Path, out: Path, *options: str) -> bytes:
    result = report(data, "--html", str(out), *options)
    assert result.exit_code == 0, result.output
    assert [one.name for one in out.parent.iterdir() if one.name.startswith(".part")] == []
    return out.read_bytes()


def section(written: bytes, heading: str) -> str:
    """Text of a section, in which each blank is one."""
    found = re.search(rf"<h2>{re.escape(heading)}</h2>(.*?)</section>", written.decode(), re.DOTALL)
    assert found is not None, heading
    return " ".join(_Page(found[1]).text.split())


def test_report_contains_events_and_their_users(written: bytes) -> None:
    summary = _Page(written.decode()).text
    assert "Incident report: Mill Lane 4" in summary
    assert "2023-11-14 22:18:20 by chief" in summary
    assert "Dispatch 2026-7: Kitchen fire; units E12; call" in summary
    timeline = section(written, "Timeline")
    for words in (
        "22:13:20 Incident Incident opened: Mill Lane 4, from dispatch 2026-7 chief",
        "22:14:01 Order Roll call (PAR) to everyone chief",
        "Alarm Mayday from Carl Berg (mayday)",
        "22:16:56 Order Evacuate to everyone: North exit chief",
        f"22:17:11 Order Evacuate (sent again) to {HOSTILE}",
        "22:17:41 Order All clear chief",
        "Alarm acknowledged: Mayday from Carl Berg chief",
        "Alarm resolved: Mayday from Carl Berg; found and helped; brought out chief",
        "Incident closed",
    ):
        assert words in timeline


def test_roll_calls_and_orders_list_answers(written: bytes) -> None:
    par = section(written, "Roll calls (PAR)")
    assert "Anna Vos (FF-01) (own unit, after 8 s)" in par
    assert "Carl Berg (FF-03) (by radio, entered by chief after 15 s)" in par
    assert par.endswith(f"{HOSTILE} (FF-02)")
    orders = section(written, "Orders")
    assert "Carl Berg (FF-03) (own unit, after 7 s)" in orders
    sent_again = orders.index("Evacuate (sent again)")
    first, again = orders[:sent_again], orders[sent_again:]
    assert "Anna Vos (FF-01) (not received)" in first
    assert f"{HOSTILE} (FF-02) (own unit, after 20 s)" in first, "its answers count for the first"
    assert f"{HOSTILE} (FF-02) (own unit, after 5 s)" in again
    assert "All clear chief 3 Carl Berg (FF-03) (own unit" in again


def test_people_are_listed_with_distance_heat_and_radio_gaps(written: bytes) -> None:
    people = section(written, "People")
    assert re.search(r"Carl Berg, blue FF-03 22:13:20 to 22:18:20 \d+ m 3 min", people)
    assert "180 °C at 22:15:51 17%" in people
    assert "Radio gaps: 22:15:00 to 22:15:41" in people


def test_a_radio_gap_is_dashed_and_every_floor_has_its_plan(written: bytes) -> None:
    text = written.decode()
    plans = text[text.index("<h2>Plan by floor") : text.index("<h2>People")]
    assert plans.count("<svg") == 2
    dashed = re.findall(r'<path d="[^"]+" stroke="(#\w+)"[^>]+stroke-dasharray', plans)
    assert set(dashed) == {COLOURS[1]}  # of the second person alone
    assert "No plan" not in plans


def test_alarms_are_explained_by_their_measurements(written: bytes) -> None:
    text = written.decode()
    traces = text[text.index("<h2>Alarms explained") : text.index("<h2>Quality")]
    assert traces.count("<svg") == 4
    heat = traces[traces.index("(heat)") : traces.index("(mayday)")]
    assert heat.count("stroke-dasharray") == 3  # caution, warning and critical


def test_settings_list_differences_from_the_defaults(written: bytes) -> None:
    settings = section(written, "Versions and settings")
    assert f"Made by Muster {version('muster')}" in settings
    assert "no-motion.alarm_s 25 30 changed" in settings
    assert settings.count("changed") == 1


def test_a_hostile_name_is_text_and_the_page_loads_nothing(written: bytes) -> None:
    text = written.decode()
    assert HOSTILE not in text
    assert "script" not in _Page(text).tags
    assert not re.search(r"""(src|href)\s*=|url\(|@import""", text)
    assert HOSTILE in _Page(text).text


def test_the_same_log_gives_the_same_bytes(given: Path, written: bytes, tmp_path: Path) -> None:
    assert _page(given, tmp_path / "again.html") == written


def test_photographs_are_pictures_in_html_and_pdf(given: Path, tmp_path: Path) -> None:
    data, taken_s = tmp_path / "station", 1_700_000_100
    shutil.copytree(given, data)
    station_app.rebuild(data, lambda _: None)
    for seconds in (0, 30):
        photo = write_photo(
            tmp_path / f"door-{seconds}.jpg", (52.0, 4.0), exif_time(taken_s + seconds), "+00:00"
        )
        brought = CliRunner().invoke(app, ["import", "i1", str(photo), "--data", str(data)])
        assert brought.exit_code == 0, brought.output
    first, *_ = sorted((data / "imports" / "i1").glob("*.original"))
    first.write_bytes(first.read_bytes()[:-10])
    pdf = tmp_path / "report.pdf"
    options = () if find_spec("weasyprint") is None else ("--pdf", str(pdf))
    written = _page(data, tmp_path / "report.html", *options)
    text = section(written, "Photographs")
    assert "Brought in" in text
    assert "52.000000° N, 4.000000° E" in text
    assert text.count("The file is damaged, so there is no picture") == 1
    assert re.findall(r'src="([^,"]+),', written.decode()) == ["data:image/jpeg;base64"]
    assert _page(data, tmp_path / "again.html") == written
    if options:
        assert b"/DCTDecode" in pdf.read_bytes(), "the JPEG itself is in it"


def test_an_open_incident_ends_with_the_record(tmp_path: Path) -> None:
    write_log(tmp_path / "given", incident_records(is_closed=False))
    written = _page(tmp_path / "given", tmp_path / "report.html")
    assert "The incident is still open" in _Page(written.decode()).text
    assert "5 min 00 s" in _Page(written.decode()).text


def _is_of_the_site(record: Record) -> bool:
    _, key, payload = record
    if key != OPERATOR.key(STATION_ID):
        return False
    done = decode(OPERATOR, payload)
    return isinstance(done, OperatorAction) and isinstance(done.action, SetPlan | SetAnchor)


def test_missing_plan_anchor_and_positions_are_reported(tmp_path: Path) -> None:
    kept = [
        one
        for one in incident_records()
        if not _is_of_the_site(one) and POSITION.suffix not in one[1]
    ]
    write_log(tmp_path / "given", kept)
    written = _page(tmp_path / "given", tmp_path / "report.html")
    plan = section(written, "Plan by floor")
    assert "No plan of the building was set" in plan
    assert "no place on the Earth" in plan
    assert "No position was recorded." in plan
    assert "Carl Berg, blue FF-03 22:13:20 to 22:18:20 unknown unknown" in section(
        written, "People"
    )


def test_a_damaged_log_is_reported_as_far_as_it_can_be_read(tmp_path: Path) -> None:
    folder = tmp_path / "given"
    write_log(folder, incident_records())
    first, second, third, *_ = segment_paths(folder / "log")
    second.unlink()
    content = bytearray(third.read_bytes())
    middle = len(content) // 3
    content[middle : middle + 64] = bytes(64)
    third.write_bytes(content)
    written = _page(folder, tmp_path / "report.html")
    record = section(written, "Gaps in the record")
    assert "segment 2 of the log is missing" in record
    assert third.name in record
    assert first.name not in record
    assert "Evacuate to everyone: North exit" in section(written, "Timeline")


def test_erased_person_is_not_named(tmp_path: Path) -> None:
    write_log(tmp_path, incident_records())
    station_app.rebuild(tmp_path, lambda _: None)
    station_app.forget(tmp_path, "p3", lambda _: None, lambda _: None)
    written = _page(tmp_path, tmp_path / "report.html")
    assert b"Carl" not in written
    assert b"Berg" not in written
    assert b"Anna Vos" in written


def test_a_full_disk_leaves_no_part_of_a_report(tmp_path: Path) -> None:
    station = tmp_path / "station"
    write_log(station, incident_records())
    station_app.rebuild(station, lambda _: None)
    out = tmp_path / "out"
    out.mkdir()
    with files_of_at_most(40_000):
        result = report(station, "--html", str(out / "report.html"))
    assert isinstance(result.exception, UserError)
    assert "cannot write" in str(result.exception)
    assert list(out.iterdir()) == []


def test_the_pdf_is_the_same_for_the_same_log_too(given: Path, tmp_path: Path) -> None:
    for name in ("one", "other"):
        _page(given, tmp_path / f"{name}.html", "--pdf", str(tmp_path / f"{name}.pdf"))
    pdf = (tmp_path / "one.pdf").read_bytes()
    assert pdf.startswith(b"%PDF")
    assert pdf == (tmp_path / "other.pdf").read_bytes()


def test_missing_pdf_library_is_reported_before_the_start(
    given: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "weasyprint", None)
    result = report(
        given, "--html", str(tmp_path / "r.html"), "--pdf", str(tmp_path / "report.pdf")
    )
    assert isinstance(result.exception, UserError)
    assert "requirements-report.lock" in str(result.exception)
    assert list(tmp_path.iterdir()) == []


def test_positions_are_assessed_on_request(given: Path, tmp_path: Path) -> None:
    assert "Not worked out" in section(_page(given, tmp_path / "a.html"), "Quality of positions")
    judged = section(_page(given, tmp_path / "b.html", "--assess"), "Quality of positions")
    assert re.search(r"Anna Vos \(FF-01\) \d+% \d+% \d+%", judged)


def test_separate_process_makes_the_same_report(written: bytes, tmp_path: Path) -> None:
    write_log(tmp_path, incident_records())
    station_app.rebuild(tmp_path, lambda _: None)
    folder, prepared, damage = DataFolder(tmp_path), list[bool](), list[str]()
    with Store(folder.database) as store, ReplayProcesses() as processes:
        incident = Records(store, SystemClock()).require_incident("i1")
        log_process = LogProcess(
            processes=processes,
            log=str(folder.log),
            database=str(folder.database),
            prepare=lambda: prepared.append(True),
            note_damage=damage.append,
            known_segments=tuple,
        )
        reports = ReportProcess(log_process)
        assert reports.make(incident, as_pdf=False) == written
        assert reports.make(incident, as_pdf=True).startswith(b"%PDF")
        missing = IncidentRow(incident_id="i9", name="", opened_ns=1, closed_ns=2)
        with pytest.raises(StoreError, match="no incident i9"):
            reports.make(missing, as_pdf=False)
    assert (len(prepared), damage) == (3, [])
