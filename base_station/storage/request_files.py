"""Requests of a command to the station that runs on the same folder, and its answers, as files.

Write access to the folder is the authorisation, as it is for ``muster base users``.  There is one
request of a kind at a time: a file with it, and a file with the answer.
"""

from __future__ import annotations

import logging
import time
from collections.abc import Callable
from pathlib import Path
from typing import Generic, TypeVar

import msgspec

from base_station.storage.private_files import write_atomically
from shared.errors import UserError

_log = logging.getLogger(__name__)
ANSWERED_WITHIN_S = 60.0  # the station looks every few seconds
_POLL_INTERVAL_S = 0.2


class FolderRequest(msgspec.Struct, frozen=True):
    """Request with an id; each kind adds its fields."""

    request_id: str


class FolderAnswer(msgspec.Struct, frozen=True):
    """The station's answer to a request; each kind may add its fields."""

    request_id: str
    refusal: str = ""  # a sentence; empty: it is accepted


RequestT = TypeVar("RequestT", bound=FolderRequest)
AnswerT = TypeVar("AnswerT", bound=FolderAnswer)


class RequestFiles(Generic[RequestT, AnswerT]):
    """Files of the requests of one kind, for a command and for the station."""

    def __init__(
        self, folder: Path, kind: str, request: type[RequestT], answer: type[AnswerT]
    ) -> None:
        """``kind``: first part of the names of the files."""
        self._request_file = folder / f"{kind}-request.json"
        self._answer_file = folder / f"{kind}-answer.json"
        self._request, self._answer = request, answer

    def answer_pending(self, answer: Callable[[RequestT], AnswerT]) -> None:
        """Answer the waiting request, if there is one; called by the station."""
        try:
            asked = msgspec.json.decode(self._request_file.read_bytes(), type=self._request)
        except FileNotFoundError:
            return
        except msgspec.DecodeError:
            _log.warning("%s is no request to the station; it is removed", self._request_file)
            self._request_file.unlink()
            return
        write_atomically(self._answer_file, msgspec.json.encode(answer(asked)))
        self._request_file.unlink(missing_ok=True)

    def ask(self, request: RequestT) -> AnswerT:
        """Return the answer of the station that runs on the folder; called by the command.

        Raises UserError with the station's reason, or where it does not answer.
        """
        write_atomically(self._request_file, msgspec.json.encode(request))
        end_s = time.monotonic() + ANSWERED_WITHIN_S
        while (answer := self._answer_to(request)) is None:
            if time.monotonic() > end_s:
                self._request_file.unlink(missing_ok=True)
                raise UserError("the station that runs on this folder does not answer; try again")
            time.sleep(_POLL_INTERVAL_S)
        self._answer_file.unlink(missing_ok=True)
        if answer.refusal:
            raise UserError(answer.refusal)
        return answer

    def _answer_to(self, request: RequestT) -> AnswerT | None:
        try:
            answer = msgspec.json.decode(self._answer_file.read_bytes(), type=self._answer)
        except (FileNotFoundError, msgspec.DecodeError):
            return None
        return answer if answer.request_id == request.request_id else None
