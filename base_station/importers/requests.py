"""Actions on imports that a command hands to the station that runs on the folder.

The command puts the file in its place itself; the station has to log that it belongs to the
incident.  One request at a time: a file of it, and one of the station's answer.  A user who can
write in the folder has all of it already, so a file there is proof enough.
"""

from __future__ import annotations

import logging
import secrets
import time
from collections.abc import Callable

import msgspec

from base_station.storage.data_folder import DataFolder
from base_station.storage.private_files import write_atomically
from shared.errors import MusterError, UserError
from shared.messages.station import ImportFile, RemoveImport

_log = logging.getLogger(__name__)
ANSWERED_WITHIN_S = 60.0  # the station looks every few seconds
_LOOK_EVERY_S = 0.2
_REQUEST, _ANSWER = "import-request.json", "import-answer.json"
ImportAction = ImportFile | RemoveImport


class ImportRequest(msgspec.Struct, frozen=True):
    """One of the two actions."""

    request_id: str
    brought: ImportFile | None = None
    removed: RemoveImport | None = None


class ImportReply(msgspec.Struct, frozen=True):
    """The station's."""

    request_id: str
    refusal: str  # a sentence; empty: it is in the log


class ImportRequests:
    """The station's side."""

    def __init__(self, folder: DataFolder, act: Callable[[ImportAction], object]) -> None:
        """``act`` logs an action, or raises MusterError."""
        self._request, self._answer = folder.path / _REQUEST, folder.path / _ANSWER
        self._act = act

    def look(self) -> None:
        """Answer the request that there is, if there is one."""
        try:
            asked = msgspec.json.decode(self._request.read_bytes(), type=ImportRequest)
        except FileNotFoundError:
            return
        except msgspec.DecodeError:
            _log.warning("%s is no request to import; it is removed", self._request)
            self._request.unlink()
            return
        refusal = ""
        try:
            action = asked.brought or asked.removed
            if action is not None:
                self._act(action)
        except MusterError as error:
            refusal = str(error)
        write_atomically(self._answer, msgspec.json.encode(ImportReply(asked.request_id, refusal)))
        self._request.unlink(missing_ok=True)


def request_action(folder: DataFolder, action: ImportAction) -> None:
    """Have the station that runs on the folder log it.

    Raises UserError with the station's reason, or where it does not answer.
    """
    request, answer = folder.path / _REQUEST, folder.path / _ANSWER
    request_id = secrets.token_hex(8)
    asked = (
        ImportRequest(request_id, brought=action)
        if isinstance(action, ImportFile)
        else ImportRequest(request_id, removed=action)
    )
    write_atomically(request, msgspec.json.encode(asked))
    end_s = time.monotonic() + ANSWERED_WITHIN_S
    while True:
        try:
            reply = msgspec.json.decode(answer.read_bytes(), type=ImportReply)
        except (FileNotFoundError, msgspec.DecodeError):
            reply = None
        if reply is not None and reply.request_id == request_id:
            break
        if time.monotonic() > end_s:
            request.unlink(missing_ok=True)
            raise UserError("the station that runs on this folder does not answer; try again")
        time.sleep(_LOOK_EVERY_S)
    answer.unlink(missing_ok=True)
    if reply.refusal:
        raise UserError(reply.refusal)
