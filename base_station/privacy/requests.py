"""Requests to forget that a command hands to the station that runs on the folder.

Whoever can write in the folder has all of it already, so a file there is proof enough, as it is
for ``muster base users``.  One request at a time: a file of it, and one of the station's answer.
"""

from __future__ import annotations

import logging
import secrets
import time
from collections.abc import Callable
from pathlib import Path

import msgspec

from base_station.privacy.erasure_progress import ErasureResult, Progress
from base_station.privacy.erasure_queue import ErasureJob, ErasureState
from base_station.storage.data_folder import DataFolder
from base_station.storage.job_queue import JobList
from base_station.storage.private_files import write_atomically
from shared.errors import MusterError, UserError

_log = logging.getLogger(__name__)
ANSWERED_WITHIN_S = 60.0  # the station looks every few seconds
_LOOK_EVERY_S = 0.2
_REQUEST, _ANSWER = "forgetting-request.json", "forgetting-answer.json"

Accept = Callable[[str, str], ErasureJob]  # kind and id; UserError: why it is refused


class ErasureRequest(msgspec.Struct, frozen=True):
    """Request of a command to erase a person's data; it has no name in it."""

    request_id: str
    kind: str  # "person" or "incident"
    subject_id: str


class ErasureAnswer(msgspec.Struct, frozen=True):
    """The station's."""

    request_id: str
    forgetting_id: str = ""
    refusal: str = ""  # a sentence; empty: it is accepted


class ErasureRequests:
    """The station's side."""

    def __init__(self, folder: DataFolder, accept: Accept) -> None:
        self._request = folder.path / _REQUEST
        self._answer = folder.path / _ANSWER
        self._accept = accept

    def look(self) -> None:
        """Answer the request that there is, if there is one."""
        try:
            asked = msgspec.json.decode(self._request.read_bytes(), type=ErasureRequest)
        except FileNotFoundError:
            return
        except msgspec.DecodeError:
            _log.warning("%s is no request to forget; it is removed", self._request)
            self._request.unlink()
            return
        try:
            accepted = self._accept(asked.kind, asked.subject_id)
            answer = ErasureAnswer(asked.request_id, accepted.forgetting_id)
        except MusterError as error:
            answer = ErasureAnswer(asked.request_id, refusal=str(error))
        write_atomically(self._answer, msgspec.json.encode(answer))
        self._request.unlink(missing_ok=True)


def request_erasure(
    folder: DataFolder, kind: str, subject_id: str, on_progress: Progress
) -> ErasureResult:
    """Have the station that runs on the folder forget, and wait until it has.

    Raises UserError with the station's reason, or where it does not answer.
    """
    request, answer = folder.path / _REQUEST, folder.path / _ANSWER
    asked = ErasureRequest(secrets.token_hex(8), kind, subject_id)
    write_atomically(request, msgspec.json.encode(asked))
    end_s = time.monotonic() + ANSWERED_WITHIN_S
    while (came := _answer_to(asked, answer)) is None:
        if time.monotonic() > end_s:
            request.unlink(missing_ok=True)
            raise UserError("the station that runs on this folder does not answer; try again")
        time.sleep(_LOOK_EVERY_S)
    answer.unlink(missing_ok=True)
    if came.refusal:
        raise UserError(came.refusal)
    try:
        return _done(folder, came.forgetting_id, on_progress)
    except KeyboardInterrupt as ended:
        raise UserError(
            "the station goes on with it; its health page says how far it is"
        ) from ended


def _answer_to(asked: ErasureRequest, path: Path) -> ErasureAnswer | None:
    try:
        answer = msgspec.json.decode(path.read_bytes(), type=ErasureAnswer)
    except (FileNotFoundError, msgspec.DecodeError):
        return None
    return answer if answer.request_id == asked.request_id else None


def _done(folder: DataFolder, forgetting_id: str, on_progress: Progress) -> ErasureResult:
    while True:
        jobs = JobList(folder.erasure_jobs, ErasureJob).all()
        job = next((one for one in jobs if one.forgetting_id == forgetting_id), None)
        if job is not None:
            on_progress(job.share)
            if job.state is ErasureState.FAILED:
                raise UserError(job.problem)
            if job.state is ErasureState.DONE:
                what = f"{job.kind} {job.subject_id}"
                return ErasureResult(what, job.records, job.files, job.damaged, job.kept)
        time.sleep(_LOOK_EVERY_S)
