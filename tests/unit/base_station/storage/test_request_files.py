"""Requests of a command to the station on the same folder, and its answers, as files."""

from __future__ import annotations

import threading
from pathlib import Path

import pytest

from base_station.storage import request_files
from base_station.storage.request_files import FolderAnswer, FolderRequest, RequestFiles
from shared.errors import UserError
from tests.rig.waiting import until


class Question(FolderRequest, frozen=True):
    text: str


class Reply(FolderAnswer, frozen=True):
    length: int = 0


def answered(question: Question) -> Reply:
    if not question.text:
        return Reply(question.request_id, refusal="the text is empty")
    return Reply(question.request_id, length=len(question.text))


@pytest.fixture
def files(tmp_path: Path) -> RequestFiles[Question, Reply]:
    return RequestFiles(tmp_path, "length", Question, Reply)


def ask(files: RequestFiles[Question, Reply], text: str) -> list[Reply | str]:
    """Ask in a thread, answer in this one."""
    came: list[Reply | str] = []

    def run() -> None:
        try:
            came.append(files.ask(Question("q1", text)))
        except UserError as error:
            came.append(str(error))

    waiting = threading.Thread(target=run)
    waiting.start()

    def is_answered() -> bool:
        files.answer_pending(answered)
        return not waiting.is_alive()

    until(is_answered, "an answer")
    return came


def test_request_is_answered_and_no_file_is_left(
    files: RequestFiles[Question, Reply], tmp_path: Path
) -> None:
    assert ask(files, "Oak Street") == [Reply("q1", length=10)]
    assert not list(tmp_path.iterdir())


def test_refusal_is_raised_with_the_reason_of_the_station(
    files: RequestFiles[Question, Reply],
) -> None:
    assert ask(files, "") == ["the text is empty"]


def test_answer_to_an_earlier_request_is_not_taken(
    files: RequestFiles[Question, Reply], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "length-answer.json").write_text('{"request_id": "q0", "length": 3}')
    monkeypatch.setattr(request_files, "ANSWERED_WITHIN_S", 0.0)
    with pytest.raises(UserError, match="does not answer"):
        files.ask(Question("q1", "Oak Street"))
    assert not (tmp_path / "length-request.json").exists()


def test_invalid_request_is_removed(files: RequestFiles[Question, Reply], tmp_path: Path) -> None:
    (tmp_path / "length-request.json").write_text("{")
    files.answer_pending(answered)
    files.answer_pending(answered)
    assert not list(tmp_path.iterdir())
