"""Queue of requested recordings, pulled in turn, and continued after a restart."""

from __future__ import annotations

import secrets
from collections.abc import Collection
from pathlib import Path
from typing import Any

import msgspec

from base_station.storage.job_queue import JobQueue
from base_station.unit_sync.recordings.transfer import Ask, Transfer, TransferRequest, TransferState
from base_station.views.text_code import text_code_view_or_none
from base_station.views.wire import RecordingView
from shared.clock import Clock
from shared.coded_text import NO_CODE, TextCode, code_of_text, coded, text_of_error
from shared.errors import MusterError, StoreError, UserError
from shared.file_faults import making_fault
from shared.own_files import make_folder
from shared.worker import UNTIL_WOKEN

_LIST = "wanted.json"
_MOST = 20  # under way at once
_REST_S = 0.5  # when no unit answers
_STOPPED = coded("recording-stopped", "stopped by a person")
_DELETED = coded("recording-deleted", "deleted: its wearer is forgotten")


class Pull(msgspec.Struct):
    """A requested transfer, with its user and its progress."""

    fetch_id: str
    by: str
    wanted: TransferRequest
    state: TransferState = TransferState.WAITING
    problem: str = ""
    total_bytes: int = 0
    done_bytes: int = 0
    problem_code: TextCode = NO_CODE


class TransferQueue:
    """Pulls while it is entered; any thread may call the rest."""

    def __init__(self, ask: Ask, folder: Path, clock: Clock) -> None:
        self._ask = ask
        self._folder = folder
        self._clock = clock
        self._transfers = JobQueue(
            folder / _LIST, Pull, "recordings", self._work, "recordings are not pulled"
        )
        self._running: dict[str, Transfer] = {}

    def __enter__(self) -> TransferQueue:
        self._transfers.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._transfers.close()
        for fetch in self._running.values():
            fetch.close()

    def add(self, by: str, wanted: TransferRequest) -> Pull:
        """Pull it, and go on until it is there.

        Raises UserError where that makes no sense, StoreError where the disk takes nothing.
        """
        if wanted.to_ns <= wanted.from_ns:
            raise UserError(
                coded(
                    "recording-window", "the window ends before it begins; turn the two times round"
                )
            )
        try:
            make_folder(self._folder)
        except OSError as error:
            raise StoreError(making_fault(self._folder, error)) from error
        return self._transfers.add(lambda under_way: _new_pull(by, wanted, under_way))

    def stop(self, fetch_id: str) -> bool:
        """Stop a pull; received data is kept.  False where there is no such pull under way."""
        for pull in self._transfers.under_way():
            if pull.fetch_id == fetch_id:
                return self._transfers.note(
                    pull, save=True, state=TransferState.FAILED, **_problem(_STOPPED)
                )
        return False

    def forget(self, unit_ids: Collection[str]) -> None:
        """Mark all transfers of these units as deleted, and end them: a wearer is forgotten."""
        self._transfers.note_each(
            lambda pull: pull.wanted.unit_id in unit_ids,
            state=TransferState.FAILED,
            **_problem(_DELETED),
        )
        self._transfers.wake()

    def transfers(self) -> tuple[Pull, ...]:
        """Return the pulls under way and the last finished ones."""
        return self._transfers.all()

    def views(self) -> tuple[RecordingView, ...]:
        """As consoles see them."""
        return tuple(
            RecordingView(
                one.fetch_id,
                one.wanted.unit_id,
                one.state.value,
                one.problem,
                one.done_bytes,
                one.total_bytes,
                text_code_view_or_none(one.problem_code),
            )
            for one in self.transfers()
        )

    def _work(self, pulls: list[Pull]) -> float:
        """Ask each unit once; return the pause until the next round."""
        self._close_ended({pull.fetch_id for pull in pulls})
        answered = False
        for pull in pulls:
            if self._transfers.is_closing:
                break
            answered |= self._step_transfer(pull)
        if not pulls:
            return UNTIL_WOKEN
        return 0.0 if answered else _REST_S

    def _step_transfer(self, pull: Pull) -> bool:
        """Send one query to one unit; True if it replied."""
        try:
            fetch = self._running.get(pull.fetch_id)
            if pull.state.is_over:  # since this round began
                return False
            if fetch is None:
                fetch = Transfer(self._ask, self._folder, pull.wanted, self._clock)
                self._running[pull.fetch_id] = fetch
        except MusterError as error:  # another program pulls from this unit
            self._transfers.note(pull, save=False, **_problem(text_of_error(error)))
            return False
        fetch.step()
        self._transfers.note(
            pull,
            save=fetch.state.is_over,
            state=fetch.state,
            **_problem(fetch.problem),
            total_bytes=fetch.total_bytes,
            done_bytes=fetch.done_bytes,
        )
        return fetch.state is not TransferState.WAITING

    def _close_ended(self, under_way: set[str]) -> None:
        for fetch_id in self._running.keys() - under_way:
            self._running.pop(fetch_id).close()


def _problem(text: str) -> dict[str, Any]:
    """Fields of a pull for a sentence about it; empty: there is none."""
    return {"problem": str(text), "problem_code": code_of_text(text)}


def _new_pull(by: str, wanted: TransferRequest, under_way: list[Pull]) -> Pull:
    if any(one.wanted.unit_id == wanted.unit_id for one in under_way):
        raise UserError(
            coded(
                "recording-under-way",
                "a recording of {unit} is being pulled already; wait for it, or stop it",
                unit=wanted.unit_id,
            )
        )
    if len(under_way) >= _MOST:
        raise UserError(
            coded(
                "recordings-too-many",
                "{most} recordings are being pulled; wait for one, or stop one",
                most=_MOST,
            )
        )
    return Pull(secrets.token_hex(4), by, wanted)
