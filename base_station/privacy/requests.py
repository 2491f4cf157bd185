"""Erasures that a command requests from the station that runs on the folder."""

from __future__ import annotations

import secrets
import time
from collections.abc import Callable

from base_station.privacy.erasure_progress import ErasureResult, Progress
from base_station.privacy.erasure_queue import ErasureJob, ErasureState
from base_station.storage.data_folder import DataFolder
from base_station.storage.job_queue import JobList
from base_station.storage.request_files import FolderAnswer, FolderRequest, RequestFiles
from shared.errors import MusterError, UserError

_POLL_INTERVAL_S = 0.2

Accept = Callable[[str, str], ErasureJob]  # kind and id; UserError: why it is refused


class ErasureRequest(FolderRequest, frozen=True):
    """Request of a command to erase a person's data; it has no name in it."""

    kind: str  # "person" or "incident"
    subject_id: str


class ErasureAnswer(FolderAnswer, frozen=True):
    """Id of the accepted erasure, or the reason of the refusal."""

    forgetting_id: str = ""


class ErasureRequests:
    """The station's side."""

    def __init__(self, folder: DataFolder, accept: Accept) -> None:
        self._files = _files_in(folder)
        self._accept = accept

    def answer_pending(self) -> None:
        """Accept or refuse the request that there is, if there is one."""
        self._files.answer_pending(self._answer)

    def _answer(self, asked: ErasureRequest) -> ErasureAnswer:
        try:
            accepted = self._accept(asked.kind, asked.subject_id)
        except MusterError as error:
            return ErasureAnswer(asked.request_id, refusal=str(error))
        return ErasureAnswer(asked.request_id, forgetting_id=accepted.forgetting_id)


def request_erasure(
    folder: DataFolder, kind: str, subject_id: str, on_progress: Progress
) -> ErasureResult:
    """Have the station that runs on the folder erase, and wait until it has.

    Raises UserError with the station's reason, or where it does not answer.
    """
    asked = ErasureRequest(secrets.token_hex(8), kind, subject_id)
    answer = _files_in(folder).ask(asked)
    try:
        return _done(folder, answer.forgetting_id, on_progress)
    except KeyboardInterrupt as ended:
        raise UserError(
            "the station goes on with it; its health page says how far it is"
        ) from ended


def _files_in(folder: DataFolder) -> RequestFiles[ErasureRequest, ErasureAnswer]:
    return RequestFiles(folder.path, "forgetting", ErasureRequest, ErasureAnswer)


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
        time.sleep(_POLL_INTERVAL_S)
