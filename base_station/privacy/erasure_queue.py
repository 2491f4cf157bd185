"""Queue of requested erasures: done one after the other, and continued after a restart.

To rewrite a long log takes minutes, so no request stays open for it: each erasure and its progress
are kept in a file beside the log until it is done.  Interrupted at any instant, an erasure is done
again with the same result (``ErasureService``).  An erasure that the other one of two stations has
done is a job like any other.
"""

from __future__ import annotations

import logging
import secrets
from collections.abc import Callable
from dataclasses import replace
from enum import StrEnum
from functools import reduce
from pathlib import Path
from typing import Any

import msgspec

from base_station.privacy.erasure_progress import ErasureProgress, ErasureResult, Progress
from base_station.privacy.erasure_service import BY_OTHER_STATION, PERSON, ErasureService
from base_station.storage.job_queue import JobList, JobQueue
from shared.coded_text import (
    NO_CODE,
    Term,
    TextCode,
    code_of_text,
    coded,
    text_of_error,
    with_code,
    with_codes,
)
from shared.errors import MusterError, UserError
from shared.worker import UNTIL_WOKEN

_log = logging.getLogger(__name__)
_OTHER_HAS_IT = coded(
    "erasure-other-has-it",
    "The other station of the pair has all of it until this one is started and the two are linked",
)
_AGAIN_S = 10.0  # after a failure of disk or store, or while there is an obstacle


class ErasureState(StrEnum):
    WAITING = "waiting"
    WORKING = "working"
    DONE = "done"
    FAILED = "failed"

    @property
    def is_over(self) -> bool:
        return self in (ErasureState.DONE, ErasureState.FAILED)


class ErasureJob(msgspec.Struct):
    """One erasure: its subject, the user who requested it, and its progress.  Without names."""

    forgetting_id: str
    by: str
    kind: str  # "person" or "incident"
    subject_id: str
    state: ErasureState = ErasureState.WAITING
    problem: str = ""  # a sentence for a person
    share: float = 0.0  # of the log that was looked through
    records: int = 0  # of the log that changed or went
    files: int = 0  # that were written anew or removed
    damaged: tuple[str, ...] = ()  # parts of the log, and their results
    kept: tuple[str, ...] = ()  # records that stay, as sentences
    damaged_codes: tuple[TextCode, ...] = ()  # of ``damaged``, in their order
    kept_codes: tuple[TextCode, ...] = ()  # of ``kept``, in their order
    began: bool = False  # once before, perhaps by an earlier run of the program
    problem_code: TextCode = NO_CODE
    from_peer: bool = msgspec.field(default=False, name="told")  # the other station has erased it


Obstacle = Callable[[ErasureJob], str]  # why it has to wait, as a sentence; empty: it need not


class _ClosedError(Exception):  # it is no error
    """Stop of the station: the erasure continues when it runs again."""


class ErasureQueue:
    """Queue; its thread runs while the context is entered.  Any thread may call its methods."""

    def __init__(
        self,
        service: ErasureService,
        jobs_file: Path,
        obstacle: Obstacle,
        on_done: Callable[[ErasureJob], None],
    ) -> None:
        """``jobs_file`` keeps the jobs.  ``on_done`` is called in the queue's thread after an
        erasure.
        """
        self._service = service
        self._jobs = JobQueue(
            jobs_file, ErasureJob, "forgetting", self._work_on_first, "erasures are not done"
        )
        self._obstacle = obstacle
        self._on_done = on_done
        self._last_obstacle = ""  # as in the log

    def __enter__(self) -> ErasureQueue:
        self._jobs.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._jobs.close()

    def add(self, by: str, kind: str, subject_id: str, *, from_peer: bool = False) -> ErasureJob:
        """Add an erasure; it is on the disk when this returns.

        A repeated request gives the job that waits already; with ``from_peer`` that job is marked
        as ordered by the other station.  Raises StoreError where the disk does not take it.
        """
        added = self._jobs.add(_find_or_create(by, kind, subject_id, from_peer=from_peer))
        if from_peer and not added.from_peer:
            self._jobs.note_each(
                lambda one: one.forgetting_id == added.forgetting_id, from_peer=True
            )
            self._jobs.wake()
        return added

    def all(self) -> tuple[ErasureJob, ...]:
        """The newest finished erasures, and those that wait or are under way."""
        return self._jobs.all()

    def own_waiting(self) -> tuple[ErasureJob, ...]:
        """Unfinished erasures that were requested here; a following station hands them to the
        leading one.
        """
        return tuple(one for one in self.all() if not (one.state.is_over or one.from_peer))

    def problems(self) -> tuple[str, ...]:
        """Sentences for the console about unfinished erasures."""
        return tuple(_problem_of(one) for one in self.all() if not one.state.is_over)

    def _work_on_first(self, jobs: list[ErasureJob]) -> float:
        """Work on the first job that need not wait; return the pause after it."""
        for job in jobs:
            problem = self._obstacle(job)
            if not problem:
                return 0.0 if self._work(job) else _AGAIN_S
            self._note(job, **_problem(problem))
        return _AGAIN_S if jobs else UNTIL_WOKEN

    def _work(self, job: ErasureJob) -> bool:
        """Work on a job; returns False where it has to be tried again later."""
        progress = _progress_before(job)
        self._note(job, state=ErasureState.WORKING, began=True, **_problem(""))
        problem = ""
        try:
            _erase(
                self._service,
                job,
                lambda share: self._save_progress(job, share, progress),
                progress,
            )
        except _ClosedError:
            return False
        except UserError as error:
            problem = text_of_error(error)
            if not job.from_peer:  # else nothing was left to be done
                self._note(job, state=ErasureState.FAILED, **_problem(problem))
                return True
        except (MusterError, OSError) as error:
            if str(error) != self._last_obstacle:
                _log.warning("forgetting waits, and is tried again: %s", error)
                self._last_obstacle = str(error)
            again = coded(
                "erasure-again", "it is tried again: {reason}", reason=text_of_error(error)
            )
            self._note(job, **_problem(again), **_counts(progress))
            return False
        self._last_obstacle = ""
        self._on_done(msgspec.structs.replace(job))
        problem = problem or _left(progress)
        self._note(
            job, state=ErasureState.DONE, share=1.0, **_problem(problem), **_counts(progress)
        )
        return True

    def _save_progress(self, job: ErasureJob, share: float, progress: ErasureProgress) -> None:
        """Save the progress before more is erased, so that the audit counts all of it."""
        more = (progress.files, progress.damaged) != (job.files, job.damaged)
        self._jobs.note(job, save=more, share=share, **_counts(progress))
        if self._jobs.is_closing:
            raise _ClosedError

    def _note(self, job: ErasureJob, **now: object) -> None:
        self._jobs.note(job, save=True, **now)


def erase_now(
    service: ErasureService,
    jobs_file: Path,
    by: str,
    kind: str,
    subject_id: str,
    on_progress: Progress,
) -> ErasureResult:
    """Erase without a queue; if interrupted, a queue or a call with the same file continues it.

    Raises UserError where the subject is unknown, or a person interrupts it.
    """
    jobs = JobList(jobs_file, ErasureJob)
    began = any((one.kind, one.subject_id) == (kind, subject_id) for one in jobs.under_way())
    if kind == PERSON and not began:  # only ids are kept: another text may be a name
        service.require_person(subject_id)
    added = jobs.add(_find_or_create(by, kind, subject_id, from_peer=False))
    (job,) = (one for one in jobs.under_way() if one.forgetting_id == added.forgetting_id)
    progress = _progress_before(job)
    jobs.note(job, save=True, state=ErasureState.WORKING, began=True)
    try:
        done = _erase(service, job, on_progress, progress)
    except UserError as error:
        jobs.note(job, save=True, state=ErasureState.FAILED, **_problem(text_of_error(error)))
        raise
    except KeyboardInterrupt as ended:
        raise UserError(
            "a part of it is forgotten: the same command, or the station when it is started, "
            "goes on with the rest"
        ) from ended
    finally:
        jobs.note(job, save=True, **_counts(progress))
    if service.is_of_pair():  # done again by a station that can order it of the other one
        jobs.note(job, save=True, state=ErasureState.WAITING, share=0.0, **_problem(""))
        return replace(done, kept=(*done.kept, _OTHER_HAS_IT))
    jobs.note(job, save=True, state=ErasureState.DONE, share=1.0)
    return done


def request_again(jobs_file: Path, kind: str, subject_id: str) -> None:
    """Request an erasure whose order is in no log any more, in the file of a station's queue."""
    jobs = JobList(jobs_file, ErasureJob)
    jobs.add(_find_or_create(BY_OTHER_STATION, kind, subject_id, from_peer=False))


def _problem(text: str) -> dict[str, Any]:
    """Fields of a job for a sentence about it; empty: there is none."""
    return {"problem": str(text), "problem_code": code_of_text(text)}


def _left(progress: ErasureProgress) -> str:
    """Sentences about what is damaged and what stays, as one text; empty: there are none."""
    sentences = (*progress.damaged, *progress.kept)
    return reduce(_followed, sentences) if sentences else ""


def _followed(before: str, last: str) -> str:
    return coded("erasure-left", "{before}. {last}", before=before, last=last)


def _problem_of(job: ErasureJob) -> str:
    kind = Term(job.kind, job.kind)
    if not job.problem:
        return coded(
            "erasure-under-way",
            "The log is being written anew to forget a {kind} ({share_fraction:.0%}), as {by} "
            "wished",
            kind=kind,
            share_fraction=job.share,
            by=job.by,
        )
    return coded(
        "erasure-waits",
        "The log is being written anew to forget a {kind} ({share_fraction:.0%}), as {by} "
        "wished: {reason}",
        kind=kind,
        share_fraction=job.share,
        by=job.by,
        reason=with_code(job.problem, job.problem_code),
    )


def _find_or_create(
    by: str, kind: str, subject_id: str, *, from_peer: bool
) -> Callable[[list[ErasureJob]], ErasureJob]:
    def among(under_way: list[ErasureJob]) -> ErasureJob:
        same = (one for one in under_way if (one.kind, one.subject_id) == (kind, subject_id))
        return next(
            same, ErasureJob(secrets.token_hex(4), by, kind, subject_id, from_peer=from_peer)
        )

    return among


def _erase(
    service: ErasureService, job: ErasureJob, on_progress: Progress, progress: ErasureProgress
) -> ErasureResult:
    erase = service.erase_person if job.kind == PERSON else service.erase_incident
    return erase(job.by, job.subject_id, on_progress, progress, from_peer=job.from_peer)


def _progress_before(job: ErasureJob) -> ErasureProgress:
    """Counts of the attempts before."""
    damaged = with_codes(job.damaged, job.damaged_codes)
    kept = with_codes(job.kept, job.kept_codes)
    return ErasureProgress(job.records, job.files, job.began, damaged, kept)


def _counts(progress: ErasureProgress) -> dict[str, object]:
    return {
        "records": progress.records,
        "files": progress.files,
        "damaged": tuple(map(str, progress.damaged)),
        "damaged_codes": tuple(map(code_of_text, progress.damaged)),
        "kept": tuple(map(str, progress.kept)),
        "kept_codes": tuple(map(code_of_text, progress.kept)),
    }
