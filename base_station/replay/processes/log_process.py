"""One question about the log, answered by a process of its own: the live station does not wait."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import TypeVar

from base_station.replay.processes import frame_channel, jobs, wire
from base_station.replay.processes.server import ReplayProcesses
from base_station.storage.db.models import IncidentRow
from base_station.storage.missing_segments import KnownSegment
from shared.coded_text import Measure, coded
from shared.errors import StoreError

Answer = TypeVar("Answer")


@dataclass(frozen=True)
class LogProcess:
    """The log of a station, and how a process is started on it.  From any thread."""

    processes: ReplayProcesses
    log: str
    database: str
    prepare: Callable[[], object]  # brings recorded data to the disk
    note_damage: Callable[[str], None]  # of the log
    known_segments: Callable[[], Iterable[KnownSegment]]  # of the log, by the database
    # Copy in an archive of an incident whose log is not here; None: it is.
    instead_of_log: Callable[[IncidentRow], jobs.ArchivedLog | None] = lambda _: None
    # Between two station times: parts of the log that an archive has, and this station has not.
    archived_parts: Callable[[int, int], tuple[jobs.ArchivedPart, ...]] = lambda _from, _until: ()

    def ask(
        self,
        job: jobs.Job,
        read: Callable[[bytes], Answer | wire.Damage | wire.Failure],
        timeout_s: float | None = None,
    ) -> Answer:
        """The last message of the process, which ``read`` decodes.

        Raises StoreError with the reason where there is none, or none within ``timeout_s``.
        """
        self.prepare()
        line = self.processes.start(job)
        try:
            return self._last_message(line, read, timeout_s)
        finally:
            line.hang_up()
            line.close()

    def _last_message(
        self,
        line: frame_channel.FrameChannel,
        read: Callable[[bytes], Answer | wire.Damage | wire.Failure],
        timeout_s: float | None,
    ) -> Answer:
        while timeout_s is None or line.has_message(timeout_s):
            encoded = line.receive()
            if encoded is None:
                raise StoreError(
                    coded("log-process-ended", "the process that read the log has ended; ask again")
                )
            message = read(encoded)
            if isinstance(message, wire.Failure):
                raise message.error()
            if not isinstance(message, wire.Damage):
                return message
            self.note_damage(message.what)
        raise StoreError(
            coded(
                "log-took-too-long",
                "the log was not read within {longest_s}; ask for a shorter span",
                longest_s=Measure(timeout_s, f"{timeout_s:.0f} s"),
            )
        )
