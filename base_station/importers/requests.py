"""Actions on imports that a command requests from the station that runs on the folder.

The command puts the file in its place itself; the station has to log that it belongs to the
incident.
"""

from __future__ import annotations

import secrets
from collections.abc import Callable

from base_station.storage.data_folder import DataFolder
from base_station.storage.request_files import FolderAnswer, FolderRequest, RequestFiles
from shared.errors import MusterError
from shared.messages.station import ImportFile, RemoveImport

ImportAction = ImportFile | RemoveImport


class ImportRequest(FolderRequest, frozen=True):
    """Request for one of the two actions."""

    brought: ImportFile | None = None
    removed: RemoveImport | None = None


class ImportRequests:
    """The station's side."""

    def __init__(self, folder: DataFolder, act: Callable[[ImportAction], object]) -> None:
        """``act`` logs an action, or raises MusterError."""
        self._files = _files_in(folder)
        self._act = act

    def answer_pending(self) -> None:
        """Carry out the request if there is one."""
        self._files.answer_pending(self._answer)

    def _answer(self, asked: ImportRequest) -> FolderAnswer:
        try:
            action = asked.brought or asked.removed
            if action is not None:
                self._act(action)
        except MusterError as error:
            return FolderAnswer(asked.request_id, refusal=str(error))
        return FolderAnswer(asked.request_id)


def request_action(folder: DataFolder, action: ImportAction) -> None:
    """Ask the station that runs on the folder to log the action.

    Raises UserError with the station's reason, or if it does not answer.
    """
    request_id = secrets.token_hex(8)
    _files_in(folder).ask(
        ImportRequest(request_id, brought=action)
        if isinstance(action, ImportFile)
        else ImportRequest(request_id, removed=action)
    )


def _files_in(folder: DataFolder) -> RequestFiles[ImportRequest, FolderAnswer]:
    return RequestFiles(folder.path, "import", ImportRequest, FolderAnswer)
