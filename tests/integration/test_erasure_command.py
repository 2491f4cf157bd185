"""``muster base forget`` beside a station that runs on the folder."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from base_station.privacy.requests import ErasureRequests
from base_station.storage.data_folder import DataFolder
from tests.rig.served_station import prepare
from tests.rig.station_command import Browser, Command


def forget(tmp_path: Path, data: Path, what: str, *, confirmed: str) -> tuple[int, str]:
    """Its exit code and what it said."""
    flags = ("forget", what, "--data", str(data))
    with Command(tmp_path / "forget.txt", *flags, stdin=f"{confirmed}\n") as command:
        return command.wait(), command.output()


def test_running_station_erases_the_wearer_of_a_unit(
    serve: Callable[..., Command], data: Path, tmp_path: Path
) -> None:
    with Browser(serve().wait_ready(), data) as browser:
        incident_id = prepare(browser)
        browser.call("GET", f"/incidents/{incident_id}")  # the command reads the database itself
        code, reported = forget(tmp_path, data, "Ada", confirmed="Ada")
        assert (code, "the incident Kitchen is open; close it first" in reported) == (2, True), (
            reported
        )
        browser.call("POST", f"/incidents/{incident_id}/close")
        browser.call("GET", f"/incidents/{incident_id}")
        code, reported = forget(tmp_path, data, "Ada", confirmed="Bea")
        assert (code, "nothing was deleted" in reported) == (2, True), reported
        assert browser.call("GET", "/people") != []

        code, reported = forget(tmp_path, data, "Ada", confirmed="Ada")
        assert code == 0, reported
        assert "forgotten: person" in reported
        assert browser.call("GET", "/people") == []
        (unit,) = browser.call("GET", "/units")
        assert unit["person_id"] is None
        entries = {(one["by"], one["action"]) for one in browser.call("GET", "/audit")}
    assert {("muster base forget", "Unassign"), ("muster base forget", "ForgotPerson")} <= entries


def test_invalid_request_is_answered_and_removed(tmp_path: Path) -> None:
    """Whatever wrote it: the station looks at it once."""
    folder = DataFolder(tmp_path)
    request = tmp_path / "forgetting-request.json"
    request.write_bytes(b"{")

    def accept(kind: str, subject_id: str) -> None:
        raise AssertionError((kind, subject_id))

    requests = ErasureRequests(folder, accept)  # type: ignore[arg-type]
    requests.answer_pending()
    assert not request.exists()
    requests.answer_pending()
